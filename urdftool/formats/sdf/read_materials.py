"""Materials of SDF: colors, images, and scripts of Ogre with an image."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable
from itertools import dropwhile, islice, pairwise
from pathlib import Path

from ...errors import UrdftoolError
from ...model.appearance import find_script
from ...model.elements import Material, Robot
from ...model.gazebo_colors import COLORS
from ...model.provenance import Written
from ...source.document import Element
from ...workspace import Workspace
from .read_values import read_numbers

_LARGEST = 1 << 20
"""Size of a script [bytes] above which it is not read; chosen, no source."""

_OF_GAZEBO = "file://media/"
"""Start of the URIs of the scripts that Gazebo Classic installs."""


def read_material(robot: Robot, holder: Element) -> tuple[Material | None, str]:
    """Return the material of a visual, and the name of its script if that is not known."""
    element = holder.find_child("material")
    if element is None:
        return None, ""
    name, color = find_script(holder), _read_color(element)
    image = _find_albedo(element)
    if name in COLORS:
        known = COLORS[name]
        rgba = color or (*known.diffuse, known.alpha)
        return Material(Written(element.place), name, rgba, image), ""
    if name and image is None:
        image = _find_image(robot, element, name)
    if color is None and image is None:
        return None, name
    return Material(Written(element.place), "", color, image), "" if image else name


def _read_color(element: Element) -> tuple[float, float, float, float] | None:
    diffuse = element.find_child("diffuse") or element.find_child("ambient")
    if diffuse is None:
        return None
    values = [*map(float, diffuse.text.split()), 1.0][:4]
    r, g, b, a = values if len(values) == 4 else read_numbers(diffuse, 4)
    return r, g, b, a


def _find_albedo(element: Element) -> str | None:
    pbr = element.find_child("pbr")
    maps = [] if pbr is None else [e.text.strip() for e in pbr.walk() if e.tag == "albedo_map"]
    return maps[0] if maps else None


def _find_image(robot: Robot, element: Element, name: str) -> str | None:
    """Return the image of a material in the scripts next to the model; None for none.

    Each URI is a script, or a folder of scripts or images.
    """
    script = element.find_child("script")
    uris = [] if script is None else [e.text.strip() for e in script.list_children("uri")]
    folders = [uri for uri in uris if not uri.startswith(_OF_GAZEBO)]
    if robot.source is None:
        return None
    workspace = robot.source.packages.workspace
    for text in _read_scripts(
        workspace, [path for uri in folders if (path := _resolve(robot, uri))]
    ):
        words: Iterable[str] = iter(text.split())
        if ("material", name) in pairwise(words):
            image = next(islice(dropwhile(lambda word: word != "texture", words), 1, 2), "")
            for folder in folders if image else ():
                uri = f"{folder.rstrip('/')}/{posixpath.basename(image)}"
                path = _resolve(robot, uri)
                if path is not None and workspace.is_file(path):
                    return uri
    return None


def _read_scripts(workspace: Workspace, paths: Iterable[Path]) -> Iterable[str]:
    """Yield the texts of scripts, and of those in folders."""
    for path in paths:
        is_folder = workspace.is_folder(path)
        for file in sorted(workspace.list_matches(path, "*.material")) if is_folder else [path]:
            try:
                if file.suffix == ".material":
                    yield workspace.read_bytes(file, _LARGEST).decode("utf-8", "replace")
            except (OSError, UrdftoolError):
                continue  # a file that may not be read is not a script


def _resolve(robot: Robot, uri: str) -> Path | None:
    try:
        return None if robot.source is None else robot.source.resolve(uri)
    except UrdftoolError:
        return None
