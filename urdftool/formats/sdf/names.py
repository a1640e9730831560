"""Names that SDF allows: links, joints and frames of a model share one namespace.

If a joint and a link share a name, the joint keeps it and the link becomes ``NAME_link``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain

from ...model.elements import Robot
from ..common.naming import get_first_free, list_numbered_names


@dataclass
class Names:
    """New names by kind and old name; names that are not listed are unchanged."""

    renamed: dict[tuple[str, str], str] = field(default_factory=dict)

    def link(self, name: str) -> str:
        """Return the exported name of a link, or of the frame that replaces it."""
        return self.renamed.get(("link", name), name)

    def get_joint(self, name: str) -> str:
        """Return the exported name of a joint, or of the frame that replaces it."""
        return self.renamed.get(("joint", name), name)


def make_names(robot: Robot, *, anchored: bool) -> Names:
    """Rename invalid and duplicate names.

    Args:
        robot: The robot.
        anchored: Whether its root link is the world, whose name is kept.
    """
    names = Names()
    links = [link.name for link in robot.links]
    joints = [joint.name for joint in robot.joints]
    if anchored:
        links.remove("world")
    taken = {remove_reserved(name) for name in joints} | set(links) | {"world"}
    used: set[str] = set()
    for kind, olds in (("joint", joints), ("link", links)):
        for old in olds:
            new = remove_reserved(old) or "unnamed"
            if new == "world":
                new = f"world_{kind}"
            if new in used:
                new = get_first_free(_list_variants(new, kind), used | taken)
            used.add(new)
            if new != old:
                names.renamed[kind, old] = new
    return names


def remove_reserved(name: str) -> str:
    """Return a name without what SDF reserves: ``::`` separators, ``__x__`` and blank names."""
    name = name.replace("::", "_") if name.strip() else ""
    if name.startswith("__") and name.endswith("__"):
        name = name.strip("_") or "unnamed"
    return name


def _list_variants(name: str, kind: str) -> Iterator[str]:
    base = name if name.endswith(f"_{kind}") else f"{name}_{kind}"
    return chain((base,) if base != name else (), list_numbered_names(base))


def get_model_name(robot: Robot) -> str:
    """Return the name of the model."""
    name = remove_reserved(robot.name.strip()) or "robot"
    return "world_model" if name == "world" else name
