"""Comparison of the worlds of two robots, and what of the robots depends on them."""

from __future__ import annotations

from collections.abc import Collection

from ..model.elements import Robot
from ..model.native import find_world
from ..model.settings import Content, Setting
from ..model.world_settings import BY_FORMAT, describe_setting, list_changed, list_decided
from .difference import Comparison
from .pair import Pair
from .settings import compare_settings, measure_content
from .uncompared import SETTINGS, Uncompared


def compare_worlds(pair: Pair, comparison: Comparison) -> None:
    """Compare gravity, medium and solver of the worlds of two robots, as far as both have them."""
    robots = pair.a.robot, pair.b.robot
    rows, reason = _choose_world_rows(*robots)
    if reason:
        comparison.skipped["world"] = reason
    settings = robots[0].world, robots[1].world
    names = robots[0].name, robots[1].name
    compare_settings(pair, comparison, "world", "robot", names, rows, settings, robots)
    compared = {row.name for row in rows}
    for robot, other in (robots, robots[::-1]):
        record_decided(robot, other, comparison, compared)


def _choose_world_rows(a: Robot, b: Robot) -> tuple[list[Setting], str]:
    """Return the settings of worlds that are compared; with a reason if that is none.

    MuJoCo has a value for each in every MJCF, Gazebo in every world. Between formats, gravity is
    compared if each other file writes it, or one writes another than that of the Earth, which is
    what simulators use for a file without one.
    """
    if a.format == b.format:
        without = [one for one in (a, b) if one.format == "sdf" and find_world(one) is None]
        reason = "in the row of simulator data" if a.format == "urdf" else ""
        reason = "a file has no <world>" if without else reason
        return ([] if reason else [*BY_FORMAT[a.format]]), reason
    written = [one.format == "mjcf" or "gravity" in one.world for one in (a, b)]
    if all(written) or not (_has_gravity_of_earth(a) and _has_gravity_of_earth(b)):
        rows = BY_FORMAT["mjcf" if "mjcf" in (a.format, b.format) else a.format]
        return [row for row in rows if row.name == "gravity"], ""
    return [], "gravity is not written in every file"


def _has_gravity_of_earth(robot: Robot) -> bool:
    """Tell whether the gravity around a robot is that of the Earth, or not written."""
    value = robot.world.get("gravity")
    return value is None or measure_content(value.content, (0.0, 0.0, -9.8)) <= _OF_EARTH


def record_decided(
    robot: Robot, other: Robot, comparison: Comparison, compared: Collection[str] = ()
) -> None:
    """Record the rows that a setting of the world decides and that is not that of the other robot.

    Rows compare what is written of a robot; a simulator does something else with it in this world.
    ``compared`` are the names of the settings that both robots have.
    """
    for row, value in list_changed(robot):
        content: Content = value.content
        why = "which the other format does not have"
        if row.name in compared:
            there = other.world.get(row.name)
            shared = row.default if there is None else there.content
            if measure_content(content, shared) <= _SAME:
                continue
            content = _drop_shared(content, shared) if row.kind == "text" else content
            why = "which is not that of the other file"
        elif robot.format == other.format:
            why = "and the other file has no world"
        for part in str(content).split() if row.kind == "text" else [content]:
            shown = f"{describe_setting(row, part)} ({value.place})"
            for name in list_decided(row, part):
                comparison.record_uncompared(Uncompared(name, SETTINGS, shown, why))


def _drop_shared(content: Content, other: Content) -> str:
    """Return the words of a value that another world does not have."""
    return " ".join(word for word in str(content).split() if word not in str(other).split())


_OF_EARTH = 0.04
"""Largest difference of gravity on the ground from 9.8 m/s²: it is 9.764 (Huascarán) to 9.834 m/s²
(Arctic Ocean); source: Hirt et al. 2013, doi:10.1002/grl.50838."""

_SAME = 1e-9
"""Largest difference of equal settings; chosen, above rounding errors."""
