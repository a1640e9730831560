"""What an export of an MJCF copies of its source, and what reading it does not lose for that."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from ...finding import Finding
from ...model.elements import Robot
from ...model.mechanism import Frame, NativeElement
from ..common.drive_choice import AUTO
from .options import Options
from .read_native_table import KINDS, OBJECTS

_PREFIX = {"camera": "cam", "material": "mat", "body": "mocap"}
"""Prefix of the fields of MuJoCo's model of parts."""

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
    return kinds | {_PREFIX[one.tag] for one in native if one.tag in _PREFIX and not one.section}


def has_copied_home(robot: Robot, options: Options) -> bool:
    """Tell whether an export copies the key ``home`` of its source."""
    if options.pose or options.state or options.srdf is not None:
        return False
    return any(e.section == "keyframe" and e.name == "home" for e in list_native(robot))


def list_uncopied(robot: Robot, unread: Iterable[Finding]) -> Iterator[Finding]:
    """Yield what the reader left out and an export does not copy."""
    codes = {
        f"unread-{code}"
        for section, codes in _UNREAD.items()
        if not section or has_copies(robot, section)
        for code in codes
    }
    if robot.format == "mjcf":
        codes |= {"unread-setting", "unread-display"}
    yield from (finding for finding in unread if finding.code not in codes)


def list_sites(robot: Robot) -> Iterator[Frame]:
    """Yield the frames that become sites: named ones, and those of bodies with copied sensors."""
    measured = {
        element.attributes.get(name)
        for element in list_native(robot)
        for name, kind in OBJECTS.items()
        if element.section == "sensor" and element.attributes.get(kind) == "xbody"
    }
    for frame in robot.frames:
        if frame.kind != "body":
            yield frame
        elif frame.link in measured:
            yield replace(frame, name=_name_site(frame.link), kind="site")


def refer_to_sites(robot: Robot) -> Iterator[NativeElement]:
    """Yield the elements of a robot, with sensors that refer to the sites of :func:`list_sites`."""
    moved = {frame.link for frame in robot.frames if frame.kind == "body"}
    for element in robot.native:
        changed: dict[str, str] = {}
        for name, kind in OBJECTS.items():
            link = element.attributes.get(name, "")
            is_frame = element.section == "sensor" and element.attributes.get(kind) == "xbody"
            if is_frame and link in moved:
                changed |= {kind: "site", name: _name_site(link)}
        yield replace(element, attributes=element.attributes | changed) if changed else element


def _name_site(link: str) -> str:
    return f"{link}_body_frame"
