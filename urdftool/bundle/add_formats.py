"""SDF, MJCF and SRDF in a bundle, next to its URDF."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from ..errors import OutputError, SourceError
from ..formats.mjcf.options import Options as MjcfOptions
from ..formats.registry import ExportOptions, format_named
from ..formats.sdf.options import Options as SdfOptions
from ..model.elements import Robot
from ..model.load import make_robot
from ..source.description import read_description
from .description import expand_description
from .make import Bundle, add_manifest
from .manifest import compute_digest

FORMATS = ("urdf", "sdf", "mjcf")
"""Formats of a bundle; URDF is always in it."""


def add_srdf(bundle: Bundle, robot: Robot, path: Path) -> None:
    """Add an SRDF to a bundle; xacro is expanded.

    Raises:
        SourceError: It cannot be read or expanded, or is not an SRDF.
    """
    finder = None if robot.source is None else robot.source.packages.make_finder_for(path)
    description = read_description(path, finder=finder)
    if description.document.root.tag != "robot":
        raise SourceError("is not an SRDF: its root element is not <robot>", path=path)
    name = Path(bundle.description).with_suffix(".srdf").as_posix()
    bundle.files[name] = expand_description(description, name).data
    bundle.sources.append(path.absolute())
    bundle.manifest.options["srdf"] = path.name
    add_manifest(bundle)


def add_formats(
    bundle: Bundle,
    formats: Sequence[str],
    *,
    force: bool = False,
    srdf: Path | None = None,
    original: Robot | None = None,
) -> None:
    """Add the robot of a bundle in other formats; the losses of the exports become notes.

    Args:
        bundle: The bundle.
        formats: Names in ``FORMATS``.
        force: Whether to continue past errors if a robot remains.
        srdf: An SRDF, for the contact exclusions and the home position of MJCF.
        original: The robot in another format, of which the URDF was made. It is exported to that
            format, in which nothing is lost, in place of the URDF.

    Raises:
        Refused: The robot has defects that prevent an export.
        OutputError: A file of an export has the name of another file.
    """
    others = [name for name in dict.fromkeys(formats) if name != "urdf"]
    if not others:
        return
    with TemporaryDirectory(prefix="urdftool-") as name:
        staged = Path(os.path.realpath(name))
        for inner, content in bundle.files.items():
            place = staged / inner
            place.parent.mkdir(parents=True, exist_ok=True)
            if isinstance(content, bytes):
                place.write_bytes(content)
            else:
                place.symlink_to(os.path.abspath(content))
        robot = make_robot(read_description(staged / bundle.description))
        assert robot.source is not None
        for content in bundle.files.values():
            if isinstance(content, Path):
                robot.source.packages.access.allow(content)
        for file in robot.source.files:
            file.path = bundle.description
        for other in others:
            has_it = original is not None and original.format == other
            source = original if has_it and original is not None else robot
            _add_format(bundle, source, staged, other, force, srdf)
    bundle.manifest.options["format"] = ["urdf", *others]
    add_manifest(bundle)


def _add_format(
    bundle: Bundle, robot: Robot, staged: Path, name: str, force: bool, srdf: Path | None
) -> None:
    stem = Path(bundle.description).stem
    options: ExportOptions
    if name == "sdf":
        options = SdfOptions(folder=stem, file=f"{stem}.sdf", uri="relative", force=force)
    else:
        options = MjcfOptions(file=f"{stem}.xml", mesh_dir="assets", force=force, srdf=srdf)
    written = format_named(name).write(robot, options)
    for inner, content in written.files.items():
        if isinstance(content, Path) and content.is_relative_to(staged):
            content = bundle.files[content.relative_to(staged).as_posix()]
        known = bundle.files.setdefault(inner, content)
        if known is not content and compute_digest(known) != compute_digest(content):
            raise OutputError(f"{name.upper()} has another file of this name", path=inner)
    bundle.notes += written.losses
