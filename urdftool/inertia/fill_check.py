"""Proof that an edited source is the same robot but for the inertia that was to change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from ..errors import UrdftoolError
from ..model.elements import Robot
from ..model.pose import pose_of
from ..model.read import read_robot
from ..source.description import is_xacro
from ..source.document import Document, Element, parse
from ..source.location import SourceFile
from .fill import Filling
from .review import NAMES
from .tensor import MassProperties, is_possible, rotate, tensor_from_six


def check_filling(robot: Robot, filling: Filling, edited: Mapping[str, bytes]) -> str:
    """What is wrong with an edited source; empty where nothing is.

    Included files are only parsed again; where just the description itself is edited it is expanded
    again, and each element is compared.

    Args:
        robot: The robot as it was read.
        filling: What was to change.
        edited: The new bytes of each edited file.
    """
    assert robot.source is not None
    main = robot.source.files[0]
    try:
        for path, data in edited.items():
            parse(SourceFile(path, data))
        if set(edited) != {main.path}:
            return ""
        root = _read(robot, SourceFile(main.path, edited[main.path])).root
    except UrdftoolError as error:
        return f"the edited text cannot be read: {error}"
    names = {wanted.link.name for wanted in filling.written}
    before = list(_outside(robot.source.document.root, names))
    after = list(_outside(root, names))
    if before != after:
        changed = next(
            (a for a, b in zip(after, before, strict=False) if a != b), after[-1:] or "its end"
        )
        return f"more than inertia would change: {changed}"
    links = read_robot(root).link
    for wanted in filling.written:
        link = links.get(wanted.link.name)
        if link is None or not _has(link.inertial, wanted.result, exact=not wanted.item.missing):
            return f"link '{wanted.link.name}' would not have the inertia that was computed"
    return ""


def _read(robot: Robot, file: SourceFile) -> Document:
    description = robot.source
    assert description is not None
    if not is_xacro(file):
        return parse(file)
    from ..source.expand import expand_xacro

    return expand_xacro(file, description.arguments, description.packages).document()


def _outside(
    root: Element, names: set[str]
) -> Iterator[tuple[str, tuple[tuple[str, str], ...], str]]:
    """Every element but the inertials of the named links."""
    todo = [root]
    while todo:
        element = todo.pop()
        yield element.tag, tuple(sorted(element.attributes.items())), element.text
        children = element.children
        if element.tag == "link" and element.get("name") in names:
            children = [child for child in children if child.tag != "inertial"]
        todo.extend(reversed(children))


def _has(inertial: object, meant: MassProperties, *, exact: bool) -> bool:
    mass = getattr(inertial, "mass", None)
    inertia = getattr(inertial, "inertia", None)
    if mass is None or inertia is None:
        return False
    pose = pose_of(getattr(inertial, "origin", None))
    tensor = tensor_from_six(*(getattr(inertia, name) for name in NAMES))
    turned = rotate(tensor, np.array(pose.rotation, dtype=np.float64))
    if not is_possible(turned, triangle_tolerance=1e-6):
        return False
    if not exact:
        return True
    size = float(np.abs(meant.inertia).max())
    return bool(
        np.isclose(mass, meant.mass, rtol=1e-9)
        and np.allclose(turned, meant.inertia, rtol=0, atol=1e-9 * size)
    )
