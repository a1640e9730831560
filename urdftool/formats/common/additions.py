"""Values of joints, sensors and contacts that an export adds to its source.

The proof compares the file with the source and the choices of the export. A row whose values the
export added is not called equal to the source.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ...compare.check import Check
from ...model.elements import Robot

DYNAMICS = ("armature", "damping", "friction")
"""Properties of a joint that options of the export set."""


def announce_additions(checks: Sequence[Check], source: Robot, planned: Robot) -> None:
    """Announce in each row what the export adds to the source."""
    rows = {
        "limits": _list_added_efforts(source, planned),
        "joint physics": (
            *list_added_dynamics(source, planned),
            *_list_added_stops(source, planned),
        ),
        "sensors": _list_added_sensors(source, planned),
        "surface": _list_added_contact(source, planned),
        "actuators": list_added_actuators(source, planned),
        "contact pairs": _list_added_exclusions(source, planned),
        "configurations": _list_added_configurations(source, planned),
    }
    for check in checks:
        check.announced += rows.get(check.name, ())


def list_added_dynamics(source: Robot, planned: Robot) -> Iterator[str]:
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
    if added:
        yield f"effort limits added: {len(added)} ({_name_some(added)})"


def list_added_actuators(source: Robot, planned: Robot) -> Iterator[str]:
    """Yield a text with the actuators of joints for which a description gives no gains."""
    known = {actuator.joint for actuator in source.joint_actuators}
    added = [a.joint for a in planned.joint_actuators if a.joint not in known]
    if added:
        yield f"added: {len(added)} with kinds and gains of the export ({_name_some(added)})"


def _list_added_exclusions(source: Robot, planned: Robot) -> Iterator[str]:
    known = {frozenset((pair.link, pair.other)) for pair in source.exclusions}
    added = [
        f"{pair.link} and {pair.other}"
        for pair in planned.exclusions
        if frozenset((pair.link, pair.other)) not in known
    ]
    if added:
        yield f"added: {len(added)} ({_name_some(added)})"


def _list_added_configurations(source: Robot, planned: Robot) -> Iterator[str]:
    known = {configuration.name for configuration in source.configurations}
    added = [one.name for one in planned.configurations if one.name not in known]
    if added:
        yield f"added: {len(added)} ({_name_some(added)})"


def _name_some(names: Sequence[str]) -> str:
    return f"'{names[0]}'" + (" and so on" if len(names) > 1 else "")


def _list_added_sensors(source: Robot, planned: Robot) -> Iterator[str]:
    known = {sensor.name for sensor in source.mounted_sensors}
    added = [
        sensor.name
        for sensor in planned.mounted_sensors
        if not any(sensor.name == name or sensor.name.startswith(f"{name}_") for name in known)
    ]  # one sensor of the source may be several: imu_gyro, imu_accelerometer
    if added:
        yield f"added: {len(added)} ({_name_some(added)})"


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
