"""What an export of an MJCF copies of its source, and what reading it does not lose for that."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from ...finding import Finding
from ...model.elements import Robot
from ...model.mechanism import NativeElement
from ..common.drive_choice import AUTO
from .options import Options
from .read_extras import REFERENCE
from .read_native_table import KINDS, PARTS

_PREFIX = {"camera": "cam", "material": "mat", "body": "mocap", "geom": "geom"}
"""Prefix of the fields of MuJoCo's model of parts."""

_OF_PART = ("", "link")
"""First words of the sections of parts, of which unnamed ones are under their link."""

_UNREAD = {
    "tendon": ("tendon",),
    "actuator": ("actuator", "gain", "activation"),
    "equality": ("coupling", *(f"equality-{kind}" for kind in ("tendon", "flex", "flexvert"))),
    "sensor": ("sensor",),
    "contact": ("contact-pair",),
    "custom": ("custom",),
    "keyframe": ("keyframe",),
    "": ("camera-mode", "mocap"),
}
"""Codes of what the reader leaves out, and an export copies, by section."""


def list_native(robot: Robot) -> Sequence[NativeElement]:
    """Return the elements of MJCF of a robot; those of another format are not for this one."""
    return robot.native if robot.format == "mjcf" else ()


def has_copies(robot: Robot, section: str) -> bool:
    """Tell whether an export copies the elements of a section."""
    return any(element.section == section for element in list_native(robot))


def has_copied_actuators(robot: Robot, options: Options) -> bool:
    """Tell whether an export copies the actuators of its source."""
    return options.actuators in AUTO and has_copies(robot, "actuator")


def list_copied(robot: Robot) -> set[str]:
    """Return the kinds of MuJoCo's model that copied elements of a robot are of."""
    native = list_native(robot)
    kinds = {KINDS[one.section][0] for one in native if one.section in KINDS}
    parts = (one for one in native if one.section.partition(" ")[0] in _OF_PART)
    return kinds | {_PREFIX[one.tag] for one in parts if one.tag in _PREFIX and _has_fields(one)}


def _has_fields(one: NativeElement) -> bool:
    """Tell whether the attributes of a part are values; of geoms, data of users are not."""
    return one.tag != "geom" or not one.attributes.keys().isdisjoint(PARTS["geom"][0])


def has_copied_home(robot: Robot, options: Options) -> bool:
    """Tell whether an export copies the key ``home`` of its source."""
    if options.pose or options.state or options.srdf is not None:
        return False
    return any(e.section == "keyframe" and e.name == "home" for e in list_native(robot))


def get_described_home(robot: Robot, options: Options) -> Mapping[str, float]:
    """Return the joint positions of a key ``home`` that the export writes itself, by name."""
    if has_copies(robot, "keyframe") or options.pose or options.state or options.srdf is not None:
        return {}
    return next((one.positions for one in robot.configurations if one.name == "home"), {})


def list_uncopied(robot: Robot, unread: Iterable[Finding]) -> Iterator[Finding]:
    """Yield what the reader left out and an export does not copy."""
    codes = {
        f"unread-{code}"
        for section, codes in _UNREAD.items()
        if not section or has_copies(robot, section)
        for code in codes
    }
    if robot.format == "mjcf":
        codes |= {"unread-setting", "unread-display", "unread-force-range"}
    yield from (finding for finding in unread if finding.code not in codes)


def get_start(robot: Robot) -> Mapping[str, float]:
    """Return the positions [rad or m] at which joints start, by name; zero for others."""
    return next((c.positions for c in robot.configurations if c.name == REFERENCE), {})
