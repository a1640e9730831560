"""Rules on values in ``<gazebo>`` blocks."""

from __future__ import annotations

import re
from collections.abc import Iterator, Set

from ...model.block_elements import find_owner
from ...model.elements import GazeboExtension, Robot
from ...model.read import number
from ...model.sdf_schema import (
    describe_kind,
    find_requirement,
    find_requirement_of_attribute,
    walk_values,
)
from ...model.settings import (
    BAD_ELEMENT,
    BAD_KEYWORD,
    describe_rejected,
    get_text,
    is_opposite,
    list_rows,
)
from ...source.description import Description
from ...source.document import Element
from ...source.location import Place
from ..fix import (
    FixContext,
    Proposal,
    escape_attribute,
    find_element,
    insert_after,
    safe,
    set_attribute,
    set_text,
    unsafe,
)
from ..rule import ERROR, INFO, SAFE, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from .contact import get_contact_role
from .keywords import KEYWORDS, NUMBERS
from .lumped_model import find_kept_links, is_joint_kept
from .lumping import get_lumped_body, is_lumped

APPLIES_TO = ("gazebo",)

_NUMBER = "gz, gazebo-classic (a number)"
_FLAG = "gz, gazebo-classic (true or false)"
_VECTOR = "gz, gazebo-classic (a direction)"
_LEADING = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?(?:inf|nan)", re.IGNORECASE)


@rule(
    ERROR,
    effects={
        _NUMBER: (
            "abort with an uncaught 'stod' exception if the text does not begin with a number; "
            "read the leading number in other cases (sdformat 12.3)"
        ),
        _FLAG: "read another word as false; of turnGravityOff as true (sdformat 12.3)",
        _VECTOR: "reject the whole model (sdformat 12.3: Error 9)",
        "urdfdom, mujoco, pybullet, pinocchio, drake": "ignore <gazebo>",
    },
)
def bad_extension_number(robot: Robot) -> Iterator[Problem]:
    """A value that Gazebo reads as a number is not a number.

    sdformat converts mu1, kp and similar values with a function that throws if the text does not
    begin with a number. The exception is not caught, so the simulator aborts. Of ``10.0d`` it reads
    10 and ignores the rest; this case is a warning, as is a flag such as ``selfCollide`` that is
    neither true nor false. The direction ``fdir1`` requires three numbers.
    """
    for block in robot.gazebo:
        for child in block.element.children:
            if child.tag not in NUMBERS:
                continue
            written = child.get("value")
            text = (child.text if written is None else written).strip()
            if is_unexpanded(text):
                continue
            number = _LEADING.match(text)
            if number is not None and number.end() == len(text):
                continue
            fact = describe_rejected(find_owner(robot, child), child.tag, text, "a finite number")
            if number is None:
                text = f"{fact}, so Gazebo aborts"
                yield Problem(block.element, text, at=child, effects=(_NUMBER,))
            else:
                yield Problem(
                    block.element,
                    f"{fact}; Gazebo reads only {number[0]}",
                    at=child,
                    severity=WARNING,
                    effects=(_NUMBER,),
                    data={"write": number[0]},
                )
    for one in robot.rejected_settings:
        if one.code != BAD_KEYWORD or one.tag in NUMBERS or is_unexpanded(one.text):
            continue
        if one.required == describe_kind("flag"):
            text = f"{one.fact}; Gazebo reads it as {'true' if is_opposite(one.tag) else 'false'}"
            yield Problem(one.element, text, severity=WARNING, effects=(_FLAG,))
        else:
            text = f"{one.fact}, so Gazebo rejects the model"
            yield Problem(one.element, text, effects=(_VECTOR,))


@bad_extension_number.full
def report_bad_extension_values(robot: Robot) -> Iterator[Problem]:
    """Report each value of a tag that the model rejects, with the ``kind`` of its value."""
    for one in robot.rejected_settings:
        if one.code == BAD_KEYWORD and one.kind in ("link", "joint"):
            part = (robot.link if one.kind == "link" else robot.joint).get(one.name)
            if part is None:
                continue  # an export dropped it
            data = {"kind": list_rows(one.tag)[0].kind}
            yield Problem(part, one.fact, at=one.element, data=data)


def _describe(robot: Robot, element: Element, required: str) -> str:
    return describe_rejected(find_owner(robot, element), element.tag, get_text(element), required)


@bad_extension_number.fix(SAFE)
def write_leading_number(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the leading number, which Gazebo reads."""
    element = find_element(problem)
    number = problem.data.get("write", "")
    if not number or element is None:
        return None
    if "value" in element.attributes:
        return safe(f"write {number}", set_attribute(element, "value", number))
    return safe(f"write {number}", set_text(element, number))


@rule(
    INFO,
    effects={
        "gz, gazebo-classic": "take 1, the default of SDF, for the other",
    },
    group="robot",
)
def half_friction(robot: Robot) -> Iterator[Problem]:
    """Only one of ``mu1`` and ``mu2`` is written.

    They are the friction coefficients in two directions of the surface. The default of the missing
    one is 1, so the friction depends on the direction.
    """
    for name, blocks in robot.extensions.items():
        if not name or name not in robot.link or not robot.link[name].collisions:
            continue
        if any(child.tag in ("mu", "Mu1", "Mu2") for b in blocks for child in b.element.children):
            continue  # one is misspelled
        found = {word: block for block in blocks for word in _MU if block.element.find_child(word)}
        if len(found) == 1:
            word, block = next(iter(found.items()))
            other = "mu2" if word == "mu1" else "mu1"
            yield Problem(
                block.element,
                f"link '{name}' has {word} but no {other}, which defaults to 1; write both",
                at=block.element.find_child(word),
                alike=word,
                data={"written": word, "missing": other},
            )


@half_friction.fix(UNSAFE)
def write_other_friction(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the same friction in the other direction."""
    element = find_element(problem)
    if element is None or element.tag not in ("mu1", "mu2"):
        return None
    other = "mu2" if element.tag == "mu1" else "mu1"
    text = escape_attribute((element.get("value") or element.text).strip())
    line = f'<{other} value="{text}"/>' if element.get("value") else f"<{other}>{text}</{other}>"
    return unsafe(f"write {line}", insert_after(element, line))


_MU = ("mu1", "mu2")
_HOLDS = re.compile(
    r"finger|grip|jaw|(^|_)pad(_|\d|$)|thumb|hand|wheel|foot|feet|sole|track|tire", re.I
)


def _is_alike(block: GazeboExtension) -> bool:
    """Tell whether a block has equal friction in both directions."""
    one, other = (number(block.get_value(word)) for word in _MU)
    return one is not None and one == other


def _is_gripping(robot: Robot, name: str | None) -> bool:
    """Tell whether a link grips, by its name or shape: a finger, a wheel or a foot."""
    link = robot.link.get(name or "")
    return link is not None and bool(_HOLDS.search(link.name) or get_contact_role(robot, link))


@rule(
    INFO,
    default=False,
    effects={"gz, gazebo-classic": "take it as written"},
    group="robot",
)
def implausible_friction(robot: Robot, *, highest: float = 10.0) -> Iterator[Problem]:
    """A friction coefficient or contact stiffness is implausible.

    Rubber on concrete has a friction coefficient of 1. One above ``highest`` is usually a wrong
    number. A contact with a stiffness ``kp`` of 0 does not support the link. Both coefficients of a
    block are one finding. Fingers, wheels and feet with the same high coefficient in both
    directions are not reported.
    """
    reported: set[tuple[str, float]] = set()
    for block in robot.gazebo:
        found: dict[bool, tuple[str, list[Element], list[str]]] = {}
        meant = _is_gripping(robot, block.reference) and _is_alike(block)
        for child in block.element.children:
            if child.tag not in ("mu1", "mu2", "kp"):
                continue
            value = number((child.get("value") or child.text).strip())
            if value is None or (child.tag, value) in reported:
                continue
            if child.tag != "kp" and value > highest and meant:
                continue
            reported.add((child.tag, value))
            effect = ""
            if child.tag == "kp" and value == 0:
                effect, why = ", so contacts do not support the link", "the default is 1e12"
            elif child.tag != "kp" and value > highest:
                why = "rubber on concrete has about 1"
            else:
                continue
            _, children, wrongs = found.setdefault(child.tag == "kp", (why, [], []))
            of = f" of '{block.reference}'" if block.reference and not children else ""
            wrong = f"{child.tag}{of} is {value:g}{effect}"
            children.append(child)
            wrongs.append(wrong)
        for why, children, wrongs in found.values():
            yield Problem(
                block.element,
                f"{' and '.join(wrongs)}; {why}",
                at=children[0],
                alike=tuple(child.tag for child in children),
            )


_REJECTED = "gz, gazebo-classic (another type, or outside of the range)"
_TYPE = "gz, gazebo-classic (type of a joint that closes a loop)"
_CUT = "gz, gazebo-classic (more than the value)"


@rule(
    ERROR,
    formats=URDF_AND_SDF,
    effects={
        _REJECTED: "reject the whole model (sdformat 12.3: Error 9)",
        _TYPE: "reject the whole model (sdformat 12.3: Error 5)",
        _CUT: "take the beginning, without a message (sdformat 12.3)",
    },
)
def invalid_sdf_value(robot: Robot, description: Description) -> Iterator[Problem]:
    """An element of SDF has a text that is not a value of its type, or outside of its range.

    SDF gives each element a type: ``<update_rate>`` is a number, ``<always_on>`` true or false,
    ``<diffuse>`` three or four numbers from 0 to 1. libsdformat rejects the whole model if one
    value has another type, also in a ``<sensor>`` or ``<visual>`` of a ``<gazebo>`` block. Of
    ``10 Hz`` it reads 10 and ignores the rest; this case is a warning. Blocks of links and joints
    that Gazebo does not keep are not checked.
    """
    if robot.format == "sdf":
        for parent, element in walk_values("", description.document.root):
            yield from _check(robot, parent, element)
    for one in robot.rejected_settings:
        if one.code == BAD_ELEMENT and one.tag == "joint type" and not is_unexpanded(one.text):
            text = f"{one.fact}, so Gazebo rejects the model"
            yield Problem(one.element, text, effects=(_TYPE,))
    kept = find_kept_links(robot) or set()
    for block in robot.gazebo if kept else ():
        if not _is_read(robot, block, kept):
            continue
        is_lumped_link = block.reference in robot.link and is_lumped(robot, block.reference)
        for parent, element in iterate_sdf_elements(robot, block):
            if not (
                is_lumped_link and (parent, element.tag) == ("sensor", "pose")
            ):  # sdformat computes another
                yield from _check(robot, parent, element)


def _is_read(robot: Robot, block: GazeboExtension, kept: Set[str]) -> bool:
    """Tell whether the part of a block is in the model that sdformat makes."""
    name = block.reference
    if name in robot.link:
        return get_lumped_body(robot, name) in kept
    return name not in robot.joint or is_joint_kept(robot, robot.joint[name], kept)


def iterate_sdf_elements(robot: Robot, block: GazeboExtension) -> Iterator[tuple[str, Element]]:
    """Yield the elements of SDF in a block, each after the tag of the element that holds it.

    Keywords, parameters of plugins and blocks that refer to no part of the robot are left out.
    """
    name = block.reference
    parent = "link" if name in robot.link else "joint" if name in robot.joint else "model"
    if not name or parent != "model":
        for child in block.element.children:
            if child.tag not in KEYWORDS or child.children:
                yield from walk_values(parent, child)


def _check(robot: Robot, parent: str, element: Element) -> Iterator[Problem]:
    """Check the text of an element and its attributes."""
    text = element.text.strip()
    required = find_requirement(parent, element)
    if required and not is_unexpanded(text):
        fact = _describe(robot, element, required.text)
        yield from _report(element, element, fact, required.effect)
    for name, value in element.attributes.items():
        required = find_requirement_of_attribute(element, name)
        if required and not is_unexpanded(value):
            what = f"{name} of <{element.tag}>"
            fact = describe_rejected(find_owner(robot, element), what, value, required.text)
            yield from _report(element, element.locate_attribute(name), fact, required.effect)


@invalid_sdf_value.full
def report_invalid_values(robot: Robot) -> Iterator[Problem]:
    """Report each value of an SDF element in a block that libsdformat does not take whole.

    ``Problem.data`` has ``is_loop``: whether it places a joint that closes a loop.
    """
    for block in robot.gazebo:
        name = block.reference or ""
        part = robot.link.get(name) or robot.joint.get(name)
        for above, element in iterate_sdf_elements(robot, block):
            if needed := find_requirement(above, element):
                yield Problem(
                    block.element if part is None else part,
                    _describe(robot, element, needed.text),
                    at=element,
                    data={"is_loop": _is_loop_placement(block.element, element)},
                )


def _is_loop_placement(block: Element, element: Element) -> bool:
    """Tell whether an element is the pose or the axis of a joint in a block."""
    above = element.parent
    if element.tag == "xyz" and above is not None and above.tag == "axis":
        above = above.parent
    elif element.tag != "pose":
        return False
    return above is not None and above.tag == "joint" and above.parent is block


def _report(element: Element, at: Element | Place, fact: str, effect: str) -> Iterator[Problem]:
    if effect == "reject":
        yield Problem(element, f"{fact}, so Gazebo rejects the model", at=at, effects=(_REJECTED,))
    elif effect == "beginning":
        text = f"{fact}; Gazebo reads its beginning"
        yield Problem(element, text, at=at, severity=WARNING, effects=(_CUT,))
