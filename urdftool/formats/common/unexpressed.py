"""Losses of parts that neither writer expresses: closed loops, actuators, frames, sensors."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import NamedTuple

from ...diagnostic import Severity
from ...model.appearance import APPEARANCE, find_unknown_script
from ...model.blocks import list_unread_elements
from ...model.elements import BALL_TYPES, Joint, Link, Material, Mesh, Robot, Visual
from ...model.materials import find_shown_material
from ...model.mechanism import ContactExclusion
from ...model.native import LOOP, OTHER_TAGS
from ...model.part import Part
from ...model.read_settings import list_settings
from ...model.settings import LOST_SETTINGS, LUMPING_TAGS, SPRING, TUNING, Setting, Settings
from ...model.urdf_schema import BLOCKS, VOCABULARY
from ...model.world_settings import describe_setting, list_changed, list_decided
from ...source.document import Element
from ...source.location import Place
from ..written import Written


class Reason(NamedTuple):
    """Why a format does not have a setting, and the severity of its loss."""

    text: str
    severity: Severity


class _Kind(NamedTuple):
    """Parts of one kind.

    Attributes:
        code: Code of the loss after ``lossy-``.
        what: Name of the kind, for one part.
        parts: The parts and their names.
        severity: ``INFO`` if the robot moves the same without them.
        settings: Names of the settings that are lost with a part.
    """

    code: str
    what: str
    parts: list[tuple[Part, str]]
    severity: Severity = Severity.WARNING
    settings: tuple[str, ...] = ()


_OF_URDF = (*VOCABULARY["robot"].children, *BLOCKS)
"""Elements below ``<robot>`` that the model holds, or that each writer reports itself."""

_IN_BLOCKS = ("closure", "camera", "sensor", "plugin", "light")
"""Codes of parts that a URDF has in its blocks."""


def report_unexpressed(robot: Robot, written: Written, *, expressed: Container[str] = ()) -> None:
    """Report what the reader left out, and each part that the writers do not express.

    Those in blocks of a URDF are elements, which the writers report themselves.

    Args:
        robot: The source.
        written: The export, which receives the losses.
        expressed: Codes after ``lossy-`` of the kinds that the writer expresses.
    """
    written.unread = robot.unread
    written.losses += robot.unread
    if "setting" not in expressed:
        report_unwritten_settings(robot, written, lambda row: row.path)
    _report_kinds((kind for kind in _list_kinds(robot) if kind.code not in expressed), written)
    report_other_elements(robot, written, expressed=expressed)


def report_other_elements(
    robot: Robot, written: Written, *, expressed: Container[str] = ()
) -> None:
    """Report what else a URDF has next to its links and joints, once for each tag."""
    found: dict[str, list[Element]] = {}
    for element in () if robot.xml is None else robot.xml.children:
        if element.tag not in _OF_URDF and element.tag not in expressed:
            found.setdefault(element.tag, []).append(element)
    for tag, elements in found.items():
        count = f", {len(elements)} times" if len(elements) > 1 else ""
        text, place = f"<{tag}> in <robot>{count} is dropped", elements[0].place
        written.report_loss("other-element", text, place, kind="robot", name=robot.name)


def report_world_settings(robot: Robot, written: Written) -> None:
    """Report the settings of the world of a robot that are not the defaults of its format."""
    _report_kinds(_list_world_kinds(robot), written)


def _report_kinds(kinds: Iterable[_Kind], written: Written) -> None:
    for code, what, parts, severity, settings in kinds:
        data = {LOST_SETTINGS: settings} if settings else {}
        for part, name in parts:
            if part.xml is not None and code in _IN_BLOCKS:
                continue
            message = f"{what} '{name}' is dropped" if name else f"an unnamed {what} is dropped"
            written.report_loss(
                code, message, part.place, kind=what, name=name, severity=severity, data=data
            )


def report_unwritten_settings(
    robot: Robot,
    written: Written,
    has_counterpart: Callable[[Setting], object],
    reasons: Mapping[str, Reason] = MappingProxyType({}),
) -> None:
    """Report the settings that a format does not have, unless they are those of SDF without them.

    Settings of one element are one loss, whose data names them.

    Args:
        robot: The source.
        written: The export, which receives the losses.
        has_counterpart: Tells whether the format has a setting.
        reasons: Why the format does not have settings, by the names of their rows.
    """
    for kind, name, rows, settings in list_settings(robot):
        found: dict[tuple[Place, str, bool], list[str]] = {}
        for row in rows:
            value = settings.get(row.name)
            if value is None or value.content == row.default or has_counterpart(row):
                continue
            if _EXPRESSED_TAGS.isdisjoint(row.tags):
                tag, tunes = value.tag if value.xml else "", row.name in TUNING
                found.setdefault((value.place, tag, tunes), []).append(row.name)
        for (place, tag, tunes), lost in found.items():
            usual = Reason("", Severity.INFO if tunes else Severity.WARNING)
            reason = reasons.get(lost[0], usual)
            what = " and ".join(lost).replace("_", " ")
            what += f" (<{tag}>)" if tag else ""
            text = f"{what} of {kind} '{name}' {'are' if len(lost) > 1 else 'is'} not written"
            text += f": {reason.text}" if reason.text else ""
            data, severity = {LOST_SETTINGS: lost}, reason.severity
            written.report_loss(
                "setting", text, place, kind=kind, name=name, severity=severity, data=data
            )


def report_moved_frames(robot: Robot, written: Written) -> None:
    """Report the links whose frames the source has elsewhere than at their joints."""
    for frame in robot.frames:
        if frame.kind == "body":
            written.report_loss(
                "link-frame",
                f"the frame of link '{frame.link}' is at its joint, not where the source has it",
                frame.place,
                kind="link",
                name=frame.link,
                severity=Severity.INFO,
            )


def report_resistance(joint: Joint, rows: Iterable[Setting], written: Written) -> None:
    """Report values of ``RESISTANCE`` that a format has of joints with one axis only.

    Args:
        joint: A joint of another type.
        rows: Rows of these values.
        written: The export, which receives the loss.
    """
    lost = [row.name for row in rows if joint.get_resistance(row.name)]
    if lost and joint.dynamics is not None:
        verb, them = ("are", "them") if len(lost) > 1 else ("is", "it")
        text = (
            f"{', '.join(lost)} of joint '{joint.name}' {verb} dropped: the format has {them} of "
        )
        text += "joints with one axis"
        data, place = {LOST_SETTINGS: lost}, joint.dynamics.place
        written.report_loss(
            "joint-resistance", text, place, kind="joint", name=joint.name, data=data
        )


def report_blocks(
    robot: Robot, written: Written, reasons: Mapping[str, str] = MappingProxyType({})
) -> None:
    """Report what ``<gazebo>`` blocks of a URDF have in addition to settings and other parts.

    Args:
        robot: The source.
        written: The export, which receives the losses.
        reasons: Why the format does not have elements, by tag.
    """
    for block, element in list_unread_elements(robot):
        name, tag = block.reference or "", element.tag
        if not name or name in robot.link or name in robot.joint:
            known = any(tag in tags for tags in OTHER_TAGS.values())
            why = reasons.get(tag, "") if known else "the element is unknown"
            severity = Severity.WARNING if known else Severity.INFO
            _report_element(f"<{tag}>", name, why, element.place, severity, written)
    known_places: set[Place] = set()
    for rest in robot.native if robot.format == "urdf" else ():
        kind, _, name = rest.section.partition(" ")
        if rest.tag in OTHER_TAGS.get(kind, ()) or rest.tag == LOOP:
            continue
        severity = Severity.INFO if rest.tag == "visual" else Severity.WARNING
        for path, place in rest.list_leaves():
            if place not in known_places and path != "laser_retro":  # which is a setting
                known_places.add(place)
                _report_element(f"{path} of <{rest.tag}>", name, "", place, severity, written)


def _report_element(
    what: str, name: str, why: str, place: Place, severity: Severity, written: Written
) -> None:
    text = f"{what}{f' of {name!r}' if name else ''} is not written{f': {why}' if why else ''}"
    written.report_loss("gazebo", text, place, kind="gazebo", name=name, severity=severity)


_EXPRESSED_TAGS = LUMPING_TAGS | {"static"}
"""Tags of settings that are in the structure of the robot: which joints are kept, and its base."""


def list_link_exclusions(robot: Robot, written: Written) -> Iterator[ContactExclusion]:
    """Yield the contact exclusions of two links, and report those with the world's scenery."""
    for pair in robot.exclusions:
        if {pair.link, pair.other} <= robot.link.keys():
            yield pair
            continue
        text = f"the excluded contact of '{pair.link}' and '{pair.other}' is dropped: it is one of "
        text += "a link with the scenery"
        name = pair.link if pair.link in robot.link else pair.other
        written.report_loss("exclusion", text, pair.place, kind="link", name=name)


def _report_appearance(robot: Robot, written: Written) -> None:
    """Report what visuals have in addition to a color and an image, once a robot."""
    lost: dict[str, None] = {}
    visuals = []
    for link in robot.links:
        for visual in link.visuals:
            dropped = [row.name for row in APPEARANCE if _is_dropped(row, visual.appearance)]
            lost |= dict.fromkeys(dropped)
            visuals += [visual] if dropped else []
    if not visuals:
        return
    names = ", ".join(name.replace("_", " ") for name in lost)
    count = f"{len(visuals)} visuals" if len(visuals) > 1 else "a visual"
    text = f"{names} of {count} {'are' if len(lost) > 1 else 'is'} dropped"
    written.report_loss(
        "appearance",
        text,
        visuals[0].place,
        kind="robot",
        name=robot.name,
        severity=Severity.INFO,
        data={LOST_SETTINGS: list(lost)},
    )


def _is_dropped(row: Setting, shown: Settings) -> bool:
    """Tell whether a value is neither that of SDF without it nor in the color of a visual."""
    value, diffuse = shown.get(row.name), shown.get("diffuse")
    if value is None or value.content == row.default or row.name == "diffuse":
        return False
    if row.name == "transparency":
        return diffuse is None
    if row.name == "ambient" and diffuse is not None:
        return diffuse.content != value.content
    return row.name != "metalness" or bool(value.content)  # no metal is what others show


def report_looks(robot: Robot, written: Written) -> None:
    """Report scripts of Gazebo that color visuals, and what of visuals is not a color or image."""
    _report_appearance(robot, written)
    for link in robot.links:
        scripts: set[str] = set()
        for visual in link.visuals:
            shown = find_shown_material(robot, link, visual)
            script = find_unknown_script(link, visual)
            if script and script not in scripts:
                _report_script(written, link, script, visual, shown)
            scripts.add(script)


def _report_script(
    written: Written, link: Link, script: str, visual: Visual, shown: Material | None
) -> None:
    """Report a material whose color is unknown, and what is written for it."""
    kept = "the visual has no color"
    if shown is not None:
        kept = "the color of the visual's own material is kept"
    elif isinstance(visual.geometry, Mesh):
        kept = "only colors in the mesh file are kept"
    severity = Severity.WARNING if shown is None else Severity.INFO
    place = visual.place if visual.material is None else visual.material.place
    text = f"material '{script}' of link '{link.name}' is a script of Gazebo; {kept}"
    written.report_loss("material", text, place, kind="link", name=link.name, severity=severity)


def _list_world_kinds(robot: Robot) -> Iterator[_Kind]:
    """Yield the settings of the world: those that decide what a robot does, and others."""
    changed = list(list_changed(robot))
    for moves, severity in ((True, Severity.WARNING), (False, Severity.INFO)):
        parts: list[tuple[Part, str]] = [
            (value, describe_setting(row, value.content))
            for row, value in changed
            if bool(list_decided(row, value.content)) is moves
        ]
        yield _Kind("world-setting", "setting of the world", parts, severity)


def _list_kinds(robot: Robot) -> Iterator[_Kind]:
    yield _Kind("closure", "closed loop", [(part, part.name) for part in robot.closures])
    yield _Kind("joint-actuator", "actuator", [(p, p.name) for p in robot.joint_actuators])
    yield _Kind(
        "exclusion",
        "contact exclusion",
        [(part, f"{part.link} – {part.other}") for part in robot.exclusions],
    )
    info = Severity.INFO
    yield _Kind("frame", "frame", [(part, part.name) for part in robot.frames], info)
    configurations = [(part, part.name) for part in robot.configurations]
    yield _Kind("configuration", "configuration", [*configurations], info)
    yield _Kind("camera", "camera", [(part, part.name) for part in robot.cameras], info)
    yield _Kind("light", "light", [(part, part.name) for part in robot.lights], info)
    yield _Kind("sensor", "sensor", [(part, part.name) for part in robot.mounted_sensors], info)
    plugins = [(part, part.name or part.library) for part in robot.mounted_plugins]
    yield _Kind("plugin", "plugin", [*plugins], info)
    yield from _list_world_kinds(robot)
    yield _Kind("base", "free base", [(b, "") for b in (robot.base,) if b and b.is_free], info)
    balls = [(j.limit, j.name) for j in robot.joints if j.type in BALL_TYPES and j.limit]
    yield _Kind("ball-limit", "limit of ball joint", [*balls])
    rotors = [(j.dynamics, j.name) for j in robot.joints if j.dynamics and j.dynamics.armature]
    yield _Kind("joint-armature", "armature of joint", [*rotors], settings=("armature",))
    springs = [(j.settings["spring_stiffness"], j.name) for j in robot.joints if j.spring]
    yield _Kind("joint-spring", "spring of joint", [*springs], settings=SPRING)
