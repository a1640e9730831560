"""Names of visuals and collisions, which in SDF are unique in a link."""

from __future__ import annotations

from collections.abc import Sequence

from ...model.elements import Collision, Link, Visual

SHAPE_SUFFIX = {"visual": "_visual", "collision": "_collision"}


def shape_names(members: list[Link]) -> dict[int, str]:
    """The name of each visual and collision by identity: its own, or made of the link's.

    Those are LINK_visual, LINK_visual_1 and so on; they are unique in a link for each kind.
    """
    names: dict[int, str] = {}
    for kind, suffix in SHAPE_SUFFIX.items():
        used: set[str] = set()
        for member in members:
            shapes: Sequence[Visual | Collision] = (
                member.visuals if kind == "visual" else member.collisions
            )
            for index, shape in enumerate(shapes):
                base = (shape.name or "").replace("::", "_")
                if not base:
                    base = f"{member.name.replace('::', '_')}{suffix}" + (
                        f"_{index}" if index else ""
                    )
                name, number = base, 1
                while name in used:
                    name, number = f"{base}_{number}", number + 1
                used.add(name)
                names[id(shape)] = name
    return names
