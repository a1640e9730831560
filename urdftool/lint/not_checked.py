"""Detection of files that are not robot descriptions or cannot be checked."""

from __future__ import annotations

import os
from collections.abc import Mapping

from ..diagnostic import Severity
from ..errors import PackageNotFound, SourceError, UrdftoolError
from ..finding import Finding, Group
from ..source.description import Description
from ..source.description_formats import find_by_head
from ..source.document import Element
from ..source.location import Place, SourceFile
from ..source.packages import shorten_path
from ..source.well_formed import WIDE
from ..workspace import Workspace

_MESHES = (".stl", ".dae", ".obj", ".ply", ".glb", ".gltf", ".3ds", ".step", ".stp")
_HEAD = 1024
"""Bytes at the start of a file in which a zero byte shows that it is no text. Chosen, no source."""


def refuse_other_files(file: SourceFile) -> None:
    """Check that a file can be a robot description.

    Raises:
        SourceError: It is a mesh, a binary file or a package manifest.
    """
    name = os.path.basename(file.path).lower()
    if name.endswith(_MESHES):
        raise SourceError(
            "is a mesh, not a robot description; lint the URDF or xacro that uses it",
            path=file.path,
        )
    if name == "package.xml":
        raise SourceError(
            "is a package manifest, not a robot description; lint the URDF or xacro files of the "
            "package",
            path=file.path,
        )
    text = tuple(start for start, _ in WIDE)  # has zero bytes
    is_xml = file.data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")
    if is_xml or file.data.startswith(text) or find_by_head(file.data):
        return
    if b"\0" in file.data[:_HEAD]:
        raise SourceError("is a binary file, not a robot description", path=file.path)


def refuse_srdf(description: Description) -> None:
    """Check that a description is not an SRDF, which is checked with its robot.

    Raises:
        SourceError: It is an SRDF.
    """
    root = description.document.root
    if description.path.endswith(".srdf") and root.tag == "robot" and not root.find_child("link"):
        raise SourceError(
            "is an SRDF, which is checked together with its robot: lint the URDF or xacro",
            path=description.path,
        )


def refuse_other_roots(description: Description) -> None:
    """Check that readers find a complete robot in an XML file.

    Raises:
        SourceError: The root is not ``<robot>``, or xacro tags have no declared namespace and
            are not expanded.
    """
    root = description.document.root
    if root.tag != "robot":
        from ..rules.xml.document import describe_root

        raise SourceError(describe_root(root), at=root.place, rule="wrong-root")
    if description.expansion is None and "xmlns:xacro" not in root.attributes:
        tags = [element for element in root.walk() if element.tag.startswith("xacro:")]
        if tags:
            count = f"{len(tags)} tags" if len(tags) > 1 else "a tag"
            raise SourceError(
                f"the file has {count} of xacro but does not declare its namespace, so nothing is "
                'expanded. Write xmlns:xacro="http://www.ros.org/wiki/xacro" on <robot>',
                at=_get_first_element(tags).place,
                rule="missing-xmlns",
            )


def _get_first_element(elements: list[Element]) -> Element:
    return min(elements, key=lambda element: element.start)


def convert_error(
    failure: UrdftoolError,
    severities: Mapping[str, Severity | None],
    *,
    unchecked: bool,
    rule: str = "",
) -> Finding:
    """Return an error of reading a description as a finding.

    If the robot was not checked at all, the finding is an error in any configuration. Descriptions
    of a repository that are not checked for the same reason, such as a texture that none of them
    finds, are one finding.
    """
    place = failure.at or Place(SourceFile(failure.path or "", b""), 0, 0)
    effects = {} if rule else _get_effects(failure.rule or "not-well-formed", failure)
    rule = rule or failure.rule or "not-well-formed"
    severity = None if unchecked else severities.get(rule)
    return Finding(
        rule,
        severity or Severity.ERROR,
        failure.message,
        place,
        "file",
        effects=effects,
        hint="; ".join(failure.notes),
        unchecked=unchecked,
        group=Group("repository", "", failure.message) if unchecked else None,
        data={"case": failure.case, **failure.data} if failure.case else failure.data,
    )


def group_by_missing_folder(files: Workspace, failure: UrdftoolError) -> Group | None:
    """Return the group of models whose files are missing with their folder; None for others.

    The folder was forgotten, or is downloaded.
    """
    missing = failure.data.get("missing")
    if missing is not None and failure.at is not None and "/" in missing:
        folder = os.path.normpath(
            os.path.join(os.path.dirname(failure.at.file.path), missing, "..")
        )
        if not files.exists(folder):
            sentence = (
                f"folder '{shorten_path(folder)}' does not exist, but {{count}} models need files "
                f"in it, first '{os.path.basename(missing)}'"
            )
            return Group("repository", sentence, ("folder", folder))
    return None


def _get_effects(name: str, failure: UrdftoolError) -> dict[str, str]:
    """Return the effects of a failure on readers, from the documentation of its rule.

    A missing package is an effect on xacro only; no other reader gets that far.
    """
    from ..rules import get_rule
    from ..rules.rule import select_holding

    rule = get_rule(name)
    keys = select_holding(rule.effects, failure.case)
    if isinstance(failure, PackageNotFound):
        keys = [key for key in rule.effects if key.partition(" (")[0] == "xacro"]
    return rule.select_effects(keys)
