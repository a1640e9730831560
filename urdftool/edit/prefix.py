"""A prefix for all names of a robot, also in the files around it."""

from __future__ import annotations

from collections.abc import Collection

from ..errors import ModelError
from ..model.elements import Robot
from ..model.world import WORLD
from ..source.document import Element
from .around import check_no_computed_names, rename_in_files
from .draft import Draft
from .references import Names, list_names_in_text, list_others, rename


def add_prefix(draft: Draft, prefix: str, *, keep: Collection[str] = ()) -> None:
    """Put a prefix before names of links, joints, materials, transmissions and hardware.

    The names of ``keep`` stay, such as those of hardware components.

    Raises:
        ModelError: The prefix cannot be in a name, or a name is computed.
    """
    if not prefix or any(letter in prefix for letter in "<>&\"'$/ \t\n"):
        raise ModelError(f"'{prefix}' cannot be a prefix of names", path=draft.file.path)
    check_no_computed_names(draft)
    names = make_names(draft.robot, prefix, keep=keep)
    rename(draft, names)
    rename_in_files(draft, names.every, {"link": names.links, "joint": names.joints})
    root = draft.robot.tree.roots[0].name
    draft.declare("root", root, root)
    declare_names(draft, names)
    list_names_in_text(draft, names.every, "it is not changed")


def make_names(robot: Robot, prefix: str, *, keep: Collection[str] = ()) -> Names:
    """Return the names of a robot with a prefix, but for those that are kept."""
    others = [e.get("name") or "" for e in list_others(robot.element)]
    return Names(
        {name: prefix + name for name in robot.link if name not in keep},
        {name: prefix + name for name in robot.joint},
        {name: prefix + name for name in map(_get_name, _list_materials(robot)) if name},
        {name: prefix + name for name in others if name and name not in keep},
    )


def list_fixing_names(robot: Robot) -> frozenset[str]:
    """Return the name by which a root fixes its robot to the world of Gazebo; empty for others."""
    root = robot.tree.root
    return frozenset((WORLD,)) if root is not None and root.name == WORLD else frozenset()


def _get_name(element: Element) -> str:
    return element.get("name") or ""


def _list_materials(robot: Robot) -> list[Element]:
    return [element for element in robot.element.walk() if element.tag == "material"]


def declare_names(draft: Draft, names: Names) -> None:
    """Add the changed names of links and joints to the correspondence."""
    for kind, known in (("link", names.links), ("joint", names.joints), ("part", names.others)):
        for old, new in known.items():
            if old != new:
                draft.declare(kind, old, new)
