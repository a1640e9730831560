"""Values of joints, sensors and contacts that an export adds to its source.

The proof compares the file with the source and the choices of the export. A row whose values the
export added is not called equal to the source.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence

from ...compare.check import Check
from ...model.elements import Robot
from ...model.settings import RESISTANCE

ROUNDING = 1e-9
"""Largest difference of positions [rad or m] that are equal; chosen, above rounding errors."""

_Parts = Sequence[tuple[Hashable, str]]
"""Keys and names of parts."""

DYNAMICS = tuple(sorted(row.name for row in RESISTANCE))
"""Properties of a joint that options of the export set."""


def announce_additions(checks: Sequence[Check], source: Robot, planned: Robot) -> None:
    """Announce in each row what the export adds to the source."""
    sides = source, planned
    drives = [[(one.joint, one.joint) for one in robot.joint_actuators] for robot in sides]
    states = [[(one.name, one.name) for one in robot.configurations] for robot in sides]
    pairs = [
        [
            (frozenset((pair.link, pair.other)), f"{pair.link} and {pair.other}")
            for pair in robot.exclusions
        ]
        for robot in sides
    ]
    rows = {
        "limits": _list_added_efforts(*sides),
        "joint physics": (*_list_added_dynamics(*sides), *_list_added_stops(*sides)),
        "sensors": _list_added_sensors(*sides),
        "surface": _list_added_contact(*sides),
        "actuators": (
            *_compare_keys(drives, " with kinds and gains of the export"),
            *_list_changed_drives(*sides),
        ),
        "contact pairs": _compare_keys(pairs),
        "configurations": (*_compare_keys(states), *_list_changed_states(*sides)),
    }
    for check in checks:
        check.announced += rows.get(check.name, ())


def _compare_keys(sides: Sequence[_Parts], remark: str = "") -> Iterator[str]:
    """Yield a text with the parts of an export whose keys its source does not have."""
    source, planned = sides
    known = {key for key, _ in source}
    return _describe("added", [name for key, name in planned if key not in known], remark)


def _describe(what: str, names: Sequence[str], remark: str = "") -> Iterator[str]:
    """Yield a text with the number of parts and the first name, if there are any."""
    if names:
        more = " and so on" if len(names) > 1 else ""
        yield f"{what}: {len(names)}{remark} ('{names[0]}'{more})"


def _collect_kinds(robot: Robot) -> dict[str, list[str]]:
    """Return the kinds of the actuators of each joint."""
    found: dict[str, list[str]] = {}
    for actuator in robot.joint_actuators:
        found.setdefault(actuator.joint, []).append(actuator.mode)
    return found


def _list_changed_drives(source: Robot, planned: Robot) -> Iterator[str]:
    """Yield texts with the joints whose actuators are fewer, or of another kind, in the export."""
    one, two = _collect_kinds(source), _collect_kinds(planned)
    both = [joint for joint in one if joint in two]
    yield from _describe("several are one", [j for j in both if len(one[j]) > len(two[j])])
    kinds = [j for j in both if len(one[j]) == len(two[j]) and one[j] != two[j]]
    yield from _describe("of another kind", kinds)


def _list_changed_states(source: Robot, planned: Robot) -> Iterator[str]:
    """Yield a text with the configurations of the source that an option or the export changes."""
    known = {one.name: one.positions for one in source.configurations}
    changed = [
        state.name
        for state in planned.configurations
        if any(
            abs(state.positions[joint] - value) > ROUNDING
            for joint, value in known.get(state.name, {}).items()
            if joint in state.positions
        )
    ]
    return _describe("changed", changed)


def _list_added_dynamics(source: Robot, planned: Robot) -> Iterator[str]:
    """Yield a text for each property of joints that an export sets, with its largest value."""
    for name in DYNAMICS:
        values = {
            joint.name: value
            for joint in planned.joints
            if (before := source.joint.get(joint.name)) is not None
            and (value := joint.get_resistance(name)) != before.get_resistance(name)
        }
        if values:
            largest = max(values, key=lambda joint: abs(values[joint]))
            yield (
                f"{name} added or changed at {len(values)} of {len(planned.joints)} joints "
                f"(largest: {values[largest]:g}, of '{largest}')"
            )


def _list_added_stops(source: Robot, planned: Robot) -> Iterator[str]:
    added = [
        joint.name
        for joint in planned.joints
        if "limit_solref" in joint.settings
        and joint.name in source.joint
        and "limit_solref" not in source.joint[joint.name].settings
    ]
    if added:
        yield f"stiffness of stops added at {len(added)} of {len(planned.joints)} joints"


def _list_added_efforts(source: Robot, planned: Robot) -> Iterator[str]:
    known = {joint.name for joint in source.joints if joint.get_magnitude("effort") is not None}
    added = [
        joint.name
        for joint in planned.joints
        if joint.name in source.joint.keys() - known and joint.get_magnitude("effort") is not None
    ]
    return _describe("effort limits added", added)


def _list_added_sensors(source: Robot, planned: Robot) -> Iterator[str]:
    known = {sensor.name for sensor in source.mounted_sensors}
    added = [
        sensor.name
        for sensor in planned.mounted_sensors
        if not any(sensor.name == name or sensor.name.startswith(f"{name}_") for name in known)
    ]  # one sensor of the source may be several: imu_gyro, imu_accelerometer
    return _describe("added", added)


def _list_added_contact(source: Robot, planned: Robot) -> Iterator[str]:
    changed = [
        link.name
        for link in planned.links
        if link.name in source.link
        and any(
            new.surface.keys() - old.surface.keys()
            for new, old in zip(link.collisions, source.link[link.name].collisions, strict=False)
        )
    ]
    if changed:
        names = ", ".join(f"'{name}'" for name in changed)
        yield f"contact parameters added to {names}"
