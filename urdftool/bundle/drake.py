"""Edits after which Drake loads a URDF that other readers load, with the same meaning.

What Drake refuses was found by loading small robots in Drake 1.51: the cases of
``tests/bundle/test_drake.py``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import count

from ..diagnostic import Severity
from ..finding import Finding
from ..model.numbers import number
from ..source.document import Element
from ..source.edit import Edit, Source, apply, parse_source, remove_element, set_attribute
from ..source.location import SourceFile

THICKNESS = "1e-6"
"""Size [m] that replaces 0 in boxes and cylinders. Chosen, no source: not visible, above 0."""

_DEGREES = {"revolute": 1, "continuous": 1, "prismatic": 1, "planar": 3, "fixed": 0}
"""Degrees of freedom of the types of joints between which Drake checks a mimic."""

Change = tuple[Edit, Finding]


def change_for_drake(file: SourceFile) -> tuple[SourceFile, list[Finding]]:
    """Return a URDF that Drake loads, and a finding for each change."""
    findings: list[Finding] = []
    for finders in _PASSES:
        source = parse_source(file)
        changes = [change for find in finders for change in find(source)]
        findings += [finding for _, finding in changes]
        file = SourceFile(file.path, apply(source.file, [edit for edit, _ in changes]))
    return file, findings


def _report(element: Element, text: str) -> Finding:
    """Return the finding of a change."""
    return Finding("adapted-for-drake", Severity.WARNING, text, element.place, element.tag)


def _change_materials(source: Source) -> Iterator[Change]:
    """Yield changes after which each material is defined once, before it is used.

    The first definition of a name counts, on the robot before those of visuals, as in urdfdom.
    """
    root = source.document.root
    on_robot = list(root.list_children("material"))
    in_visuals = [e for e in root.walk() if e.tag == "material" and e.parent is not root]
    defined: dict[str, Element] = {}
    for material in (*on_robot, *in_visuals):
        if (name := _get_name(material)) and _list_content(material):
            defined.setdefault(name, material)
    for material in on_robot:
        name = _get_name(material)
        if name not in defined:
            what = f"material '{name}' of the robot has no color and no image"
            text = f"{what if name else 'a material of the robot has no name'}: it is left out"
            yield remove_element(source, material), _report(material, text)
        elif material is not defined[name] and not _is_equal(material, defined[name]):
            text = f"{_describe_conflict(defined[name])}: it is left out"
            yield remove_element(source, material), _report(material, text)
    used: set[str] = {_get_name(material) for material in on_robot}
    for material in in_visuals:
        yield from _change_use(source, material, defined, used)


def _change_use(
    source: Source, material: Element, defined: dict[str, Element], used: set[str]
) -> Iterator[Change]:
    """Yield the change of a material in a visual; ``used`` has the names before it."""
    name = _get_name(material)
    if not name:
        return
    known = defined.get(name)
    if known is None:
        text = f"material '{name}' is not defined: the visual has the reader's default color"
        yield remove_element(source, material), _report(material, text)
        return
    has_content, is_first = bool(_list_content(material)), name not in used
    used.add(name)
    if material is known or (_is_equal(material, known) if has_content else not is_first):
        return
    copy = source.file.data[known.start : known.end]
    if has_content:
        text = f"{_describe_conflict(known)}, which the visual gets"
    else:
        text = f"material '{name}' is defined below its first use: its definition is copied there"
    yield Edit(material.start, material.end, copy), _report(material, text)


def _describe_conflict(known: Element) -> str:
    line, _ = known.file.position(known.start)
    return f"material '{_get_name(known)}' is defined with another color in line {line}"


def _get_name(element: Element) -> str:
    return (element.get("name") or "").strip()


def _list_content(material: Element) -> list[tuple[str, object]]:
    """Return the color and image of a material, in a form that compares numbers."""
    content: list[tuple[str, object]] = []
    for child in material.children:
        if child.tag == "color" and child.get("rgba"):
            content.append(("color", _parse_numbers(child.get("rgba") or "")))
        elif child.tag == "texture" and child.get("filename"):
            content.append(("texture", (child.get("filename") or "").strip()))
    return sorted(content, key=lambda item: item[0])


def _is_equal(one: Element, other: Element) -> bool:
    return _list_content(one) == _list_content(other)


def _parse_numbers(text: str) -> tuple[float | None, ...]:
    return tuple(number(word) for word in text.split())


def _change_colors(source: Source) -> Iterator[Change]:
    """Yield changes of colors outside of 0 to 1, to which other readers limit them."""
    for element in source.document.root.walk():
        numbers = _parse_numbers(element.get("rgba") or "") if element.tag == "color" else ()
        values = [value for value in numbers if value is not None]
        if len(values) != len(numbers) or all(0 <= value <= 1 for value in values):
            continue
        limited = " ".join(f"{min(max(value, 0.0), 1.0):g}" for value in values)
        text = f"color '{element.get('rgba')}' is outside of 0 to 1: it becomes {limited}"
        yield set_attribute(source, element, "rgba", limited), _report(element, text)


def _change_sizes(source: Source) -> Iterator[Change]:
    """Yield changes of boxes and cylinders with a size of 0."""
    for element in source.document.root.walk():
        names = {"box": ("size",), "cylinder": ("radius", "length")}.get(element.tag, ())
        for name in names:
            words = (element.get(name) or "").split()
            sizes = [THICKNESS if number(word) == 0 else word for word in words]
            if sizes != words:
                text = f"{element.tag} has a {name} of 0: it becomes {THICKNESS} m"
                yield (
                    set_attribute(source, element, name, " ".join(sizes)),
                    _report(element, text),
                )


def _change_mimics(source: Source) -> Iterator[Change]:
    """Yield removals of mimics that Drake refuses: of joints without a degree of freedom."""
    joints = {_get_name(joint): joint for joint in source.document.root.list_children("joint")}
    for name, joint in joints.items():
        mimic = joint.find_child("mimic")
        if mimic is None or joint.get("type") == "floating":
            continue
        leader = joints.get((mimic.get("joint") or "").strip())
        if leader is not None and leader is not joint and _count_degrees(leader, joint) == {1}:
            continue
        text = f"joint '{name}': <mimic> of '{mimic.get('joint')}' is left out; both joints must "
        text += "exist and have one degree of freedom"
        yield remove_element(source, mimic), _report(joint, text)


def _count_degrees(*joints: Element) -> set[int | None]:
    return {_DEGREES.get((joint.get("type") or "").strip()) for joint in joints}


def _change_transmissions(source: Source) -> Iterator[Change]:
    """Yield changes after which actuators have names of their own, and their joints exist."""
    root = source.document.root
    joints = {_get_name(joint) for joint in root.list_children("joint")}
    taken: set[str] = set()
    for transmission in root.list_children("transmission"):
        if why := _find_defect(transmission, joints):
            text = f"transmission '{_get_name(transmission)}' is left out: {why}"
            yield remove_element(source, transmission), _report(transmission, text)
            continue
        actuator = transmission.find_child("actuator")
        assert actuator is not None
        old = _get_name(actuator)
        new = _choose_name(old, taken)
        taken.add(new)
        if new != old:
            text = f"actuator '{old}' exists already: this one is named '{new}'"
            yield set_attribute(source, actuator, "name", new), _report(actuator, text)


def _choose_name(name: str, taken: set[str]) -> str:
    """Return a name, with a number if it is taken."""
    names = (f"{name}_{number}" if number > 1 else name for number in count(1))
    return next(one for one in names if one not in taken)


def _find_defect(transmission: Element, joints: set[str]) -> str:
    """Return why Drake refuses a transmission; empty if it does not."""
    if transmission.find_child("type") is None and not transmission.get("type"):
        return "it has no <type>"
    for tag in ("joint", "actuator"):
        child = transmission.find_child(tag)
        if child is None or not _get_name(child):
            return f"it has no <{tag}> with a name"
    joint = _get_name(transmission.find_child("joint") or transmission)
    return "" if joint in joints else f"joint '{joint}' does not exist"


_PASSES: tuple[tuple[Callable[[Source], Iterator[Change]], ...], ...] = (
    (_change_colors, _change_sizes),  # keep lines, and colors that the next pass copies
    (_change_materials, _change_mimics, _change_transmissions),
)
