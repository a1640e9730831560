"""Compared properties, with their tolerances."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from ..errors import ConfigError
from ..model.settings import RESISTANCE
from ..suggestions import suggest_name


class Row(NamedTuple):
    """A compared property."""

    name: str
    what: str
    tolerance: float


NATIVE = "other elements"
"""Row of the elements that only one format has."""

BLOCKS = "simulator data"
"""Row of the blocks of two URDF."""

LOOPS = "loops"
"""Row of the connections that close loops."""

ROWS = (
    Row("base", "whether the base is fixed", 0.0),
    Row("tree", "types, parents and mimic of joints [rad, m]", 1e-6),
    Row("frames", "origins of joints, poses of links [m, rad]", 1e-5),
    Row("axes", "directions and positions of joint axes [rad, m]", 1e-5),
    Row("limits", "position, effort and velocity, relative above 1", 1e-5),
    Row(
        "joint physics",
        f"{', '.join(row.name for row in RESISTANCE)}, springs, stops, relative above 1",
        1e-6,
    ),
    Row("surface", "friction and contact of equal collisions, relative above 1", 1e-6),
    Row("link flags", "gravity, self-collision, decay of motion, wind", 1e-6),
    Row("world", "gravity, wind and medium; solver of two MJCF", 1e-6),
    Row("mass", "mass, relative", 1e-4),
    Row("center of mass", "position in the link [m]", 1e-5),
    Row("inertia", "tensor, relative to its trace", 1e-3),
    Row("collisions", "types, sizes and poses [m]", 1e-5),
    Row("visuals", "types, sizes and poses [m]", 1e-5),
    Row("colors", "colors of equal visuals", 1 / 255),
    Row("looks", "ambient, specular, glow, transparency, of URDF and SDF", 1e-6),
    Row("textures", "images of equal visuals", 0.0),
    Row("sensors", "sensors and cameras: link, pose, rate, parameters", 0.0),
    Row("actuators", "drives of joints: kind, gear, gains, ranges", 0.0),
    Row("contact pairs", "links without contact, in two files of one format", 0.0),
    Row(LOOPS, "connections that close loops, of one format, or URDF and SDF", 0.0),
    Row("configurations", "named joint positions, of two files of one format", 0.0),
    Row("plugins", "plugins of URDF and SDF: class and parameters", 0.0),
    Row(BLOCKS, "<gazebo>, <transmission> and other elements of two URDF", 0.0),
    Row(NATIVE, "what only one format has: tendons, lights, what is copied", 1e-6),
    Row("mass matrix", "at 5 configurations, relative to the largest element", 1e-4),
    Row("gravity", "joint forces at 5 configurations, relative to the largest", 1e-4),
)
"""Every property, in the order of the table."""

GLOBAL_ROWS = ("mass matrix", "gravity")
"""Properties of the whole robot, which follow from those of its parts."""

EQUIPMENT_ROWS = (
    *("sensors", "actuators", "contact pairs", LOOPS, "configurations", "plugins"),
    *(BLOCKS, NATIVE, "world"),
)
"""Properties that are compared in two files of one format."""

NOT_COMPARED = ("other models of a file", "names of visuals and collisions")
"""Parts of a description that are not compared."""


DECLARED_TOLERANCE = 1e-6
"""Largest tolerance of a robot that was computed from the other; the digits that most tools write.

Chosen for edited descriptions, whose numbers are those of the first robot.
"""


def narrow_tolerances(
    rows: Iterable[Row], tolerance: float = DECLARED_TOLERANCE
) -> tuple[Row, ...]:
    """Return rows with at most a tolerance."""
    return tuple(row._replace(tolerance=min(row.tolerance, tolerance)) for row in rows)


def limit_tolerances(rows: Iterable[Row], declared: float = 0.0) -> tuple[Row, ...]:
    """Return rows with at most ``DECLARED_TOLERANCE``, or with a declared one.

    Args:
        rows: The rows; those whose values must be equal stay.
        declared: Tolerance of rounded numbers; 0 if they are not rounded.
    """
    if declared:
        return tuple(row._replace(tolerance=declared if row.tolerance else 0.0) for row in rows)
    return narrow_tolerances(rows)


def select_rows(names: str, tolerance: float | None) -> tuple[Row, ...]:
    """Return the rows with the given names, separated by commas; all for an empty text.

    Args:
        names: Names, of which a unique beginning suffices.
        tolerance: Tolerance of every row in place of its own, except where the values must be
            equal.

    Raises:
        ConfigError: There is no such row.
    """
    known = [row.name for row in ROWS]
    chosen: set[str] = set()
    for word in (word.strip() for word in names.split(",") if word.strip()):
        matches = [name for name in known if name == word] or [
            name for name in known if name.startswith(word)
        ]
        if len(matches) != 1:
            hint = suggest_name(word, known, 0.6) or f"; choose of {', '.join(known)}"
            raise ConfigError(f"row '{word}' does not exist{hint}")
        chosen.add(matches[0])
    rows = [row for row in ROWS if not chosen or row.name in chosen]
    if tolerance is None:
        return tuple(rows)
    return tuple(row._replace(tolerance=tolerance if row.tolerance else 0.0) for row in rows)
