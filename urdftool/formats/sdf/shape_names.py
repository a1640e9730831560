"""Names of visuals and collisions, which in SDF are unique in a link."""

from __future__ import annotations

from ...model.elements import Link

SHAPE_SUFFIX = {"visual": "_visual", "collision": "_collision"}


def shape_names(members: list[Link]) -> dict[int, str]:
    """The name of each visual and collision by identity: its own, or LINK_visual, LINK_visual_1, …

    The names are unique in a link for each kind.
    """
    names: dict[int, str] = {}
    for kind, suffix in SHAPE_SUFFIX.items():
        used: set[str] = set()
        for member in members:
            for index, shape in enumerate(
                member.visuals if kind == "visual" else member.collisions
            ):
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
