"""How a mesh file is named."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Robot
from ...source.description import Description
from ..rule import ERROR, WARNING, Problem, rule
from .uses import MeshUse, mesh_uses


@rule(WARNING, effects={"every reader": "finds the file on one machine only"})
def absolute_path(robot: Robot, description: Description) -> Iterator[Problem]:
    r"""A mesh is named by a path from the root of a disk.

    ``/home/…``, ``C:\…`` or ``file:///…`` is right on the machine it was written on. What xacro
    makes of ``file://$(find NAME)`` is not meant: that is found anew on every machine. Where the
    file is not on this machine either, it is an error.
    """
    told: set[str] = set()
    for use in mesh_uses(robot, description):
        if not use.is_absolute or use.uri in told or "$" in use.written:
            continue
        told.add(use.uri)
        name = use.uri.replace("\\", "/").rstrip("/").rpartition("/")[2]
        yield Problem(
            use.link,
            f"mesh '{use.uri}' is a path of one machine{'' if use.exists else ', and not there'}; "
            f"write package://PACKAGE/meshes/{name}",
            at=use.mesh.element.attribute_place("filename"),
            severity=None if use.exists else ERROR,
        )


@rule(ERROR, effects={"every reader": "may or may not find the file"})
def malformed_uri(robot: Robot, description: Description) -> Iterator[Problem]:
    r"""The name of a mesh file is no proper URI or path.

    Backslashes, ``package:/`` with one slash, no name at all: one loader mends it and the next
    does not. Blanks, ``%20`` and doubled slashes pass where the name is used as a path, and fail
    where it is taken for the URI it is; where the file is found here, they are a warning.
    """
    told: set[str] = set()
    for use in mesh_uses(robot, description):
        if use.uri in told:
            continue
        told.add(use.uri)
        wrong = malformation(use)
        if wrong:
            element = use.mesh.element
            passes = use.exists and "\\" not in use.uri
            yield Problem(
                use.link,
                wrong,
                at=element.attribute_place("filename"),
                severity=WARNING if passes else ERROR,
            )


def malformation(use: MeshUse) -> str:
    """What is wrong with how a mesh is named, with what would be right; empty if nothing is."""
    uri = use.uri
    scheme, separator, rest = uri.partition("://")
    if "filename" not in use.mesh.element.attributes or "${" in uri or "$(" in uri:
        return ""
    if not uri.strip():
        return f"a mesh of link '{use.link.name}' has an empty filename; name the file"
    if re.match(r"(package|model|file):(?!//)", uri):
        name, _, path = uri.partition(":")
        return f"mesh '{uri}' lacks a slash; write '{name}://{path.lstrip('/')}'"
    if separator and scheme in ("package", "model") and not rest.strip("/").partition("/")[2]:
        return f"mesh '{uri}' names no file; write {scheme}://PACKAGE/meshes/FILE"
    if "\\" in uri and not use.is_absolute:
        return f"mesh '{uri}' has backslashes; write '{uri.replace(chr(92), '/')}'"
    if uri != uri.strip():
        return f"mesh '{uri}' begins or ends with a blank; take it away"
    if separator and scheme in ("package", "model") and "//" in rest:
        right = re.sub("/{2,}", "/", rest)
        return f"mesh '{uri}' has a doubled slash; write '{scheme}://{right}'"
    if separator and (" " in uri or "%20" in uri):
        return f"mesh '{uri}' has a blank in it, which no URI may have; rename the file"
    return ""
