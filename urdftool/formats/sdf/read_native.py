"""Elements of SDF that an export to SDF copies, and those that are not read."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping

from ...diagnostic import Severity
from ...model.mechanism import NativeElement
from ...model.native import (
    HELD_PATHS,
    NESTED,
    OF_SECOND_AXIS,
    OTHER_TAGS,
    make_loop,
    make_native,
    make_rest,
)
from ...model.pose import Pose, make_pose
from ...model.provenance import Written
from ...model.settings import OF_LINKS, OF_ROBOT
from ...model.shapes import collect_content
from ...source.document import Element
from .read_links import Context, compute_part_pose
from .read_scope import Scope

_OF_MODEL = (*OTHER_TAGS["model"], "plugin")
"""Elements of a model that are copied, and nested models."""

_IN_ROWS = frozenset(("sensor", "plugin", *NESTED))
"""Elements of which the robot has parts with all values."""

_COPIED = (*OTHER_TAGS["link"], "sensor", "plugin")
"""Elements of a link that are copied, and reported as a whole for other formats."""

_READ = {
    "model": ("link", "joint", "frame", *NESTED, "pose", "plugin", "gripper",
              *(row.path for row in OF_ROBOT)),
    "link": (*_COPIED, "inertial", "collision", "visual", "pose", *(row.path for row in OF_LINKS)),
    "joint": (*HELD_PATHS["joint"], *OF_SECOND_AXIS),
    "inertial": ("mass", "pose", "inertia", "fluid_added_mass"),
    "collision": HELD_PATHS["collision"],
    "visual": (*HELD_PATHS["visual"], "material/pbr"),
}  # fmt: skip
"""Paths of the elements that the robot holds, or that are copied or reported as a whole."""


_ELEMENT = ("element", "elements are not read", Severity.WARNING)
_REPORTED = {
    "visual": ("look", "elements for the look are not read", Severity.INFO),
    "inertial": ("inertial", "elements for the inertia are not read", Severity.WARNING),
}
"""Code, sentence and severity of what is not read, by what it is in."""


def add_native(context: Context, top: Scope) -> None:
    """Add the elements that an export copies, and report those that are not read."""
    found: list[NativeElement] = []
    for prefix, scope in top.list_scopes():
        found += _list_copied(context, scope, prefix)
        _report_unread(context, scope.element, "model")
        for item in scope.joints.values():
            if item.element.get("type") != "screw":  # whose pitch is read or reported
                _report_unread(context, item.element, "joint")
        for item in scope.links.values():
            _report_unread(context, item.element, "link")
            for child in item.element.children:
                if child.tag in _READ:
                    _report_unread(context, child, child.tag)
    context.robot.native = [*context.robot.native, *found]


def _list_copied(context: Context, scope: Scope, prefix: str) -> Iterator[NativeElement]:
    for item in scope.links.values():
        yield from _list_of_link(context, scope, prefix, item.element)
    loops = {closure.name for closure in context.robot.closures}
    poses = {
        (sensor.joint, sensor.name): make_pose(sensor.origin)
        for sensor in context.robot.mounted_sensors
        if sensor.joint
    }
    for item in scope.joints.values():
        yield from _list_of_joint(prefix + item.name, item.element, loops, poses)
    for child in scope.element.children:
        if not prefix and (child.tag in _OF_MODEL or _is_unknown("model", child)):
            yield _mark(make_native("model", child))
        elif child.tag == "plugin":
            text = "plugins of nested models are not copied"
            context.record_loss("nested-plugin", text, child, Severity.INFO)


def _is_unknown(kind: str, element: Element) -> bool:
    """Tell whether an element of a model or link is neither a part of it nor a setting."""
    return all(path.partition("/")[0] != element.tag for path in _READ[kind])


def _list_of_link(
    context: Context, scope: Scope, prefix: str, link: Element
) -> Iterator[NativeElement]:
    section = f"link {prefix}{link.get('name')}"
    for child in link.children:
        if child.tag in ("collision", "visual"):
            rest = make_rest(section, child.tag, (child,), Written(child.place, child))
            if rest is not None:
                yield rest
        elif child.tag in _COPIED or _is_unknown("link", child):
            pose = compute_part_pose(context, scope, prefix, link, child)
            yield _mark(make_native(section, child, pose))


def _list_of_joint(
    name: str, joint: Element, loops: Container[str], poses: Mapping[tuple[str, str], Pose]
) -> Iterator[NativeElement]:
    """Yield the elements of a joint; sensors at their ``poses`` in its child, by joint and name."""
    if name in loops:
        yield make_loop(joint, name)
    else:
        rest = make_rest(f"joint {name}", "joint", (joint,), Written(joint.place, joint))
        if rest is not None:
            yield rest
    for child in joint.children:
        if child.tag in _IN_ROWS:
            pose = poses.get((name, child.get("name") or "")) if child.tag == "sensor" else None
            yield _mark(make_native(f"joint {name}", child, pose))


def _mark(made: NativeElement) -> NativeElement:
    """Set what other parts of the robot hold of a sensor, a plugin or a nested model."""
    if made.tag in _IN_ROWS:
        tags = (child.tag for child in made.children)
        made.held = frozenset(("text", *made.attributes, *tags))
    return made


def _report_unread(context: Context, element: Element, kind: str) -> None:
    """Report the elements below one that the robot does not hold."""
    read = _READ[kind]
    for path, child in _list_leaves(element, ""):
        if ":" in path or any(_has_below(one, path) or _has_below(path, one) for one in read):
            continue
        code, what, severity = _REPORTED.get(kind, _ELEMENT)
        name = f"{path} of <{kind}> {element.get('name') or ''}".strip()
        context.losses.add(code, what, name, child.place, severity, str(collect_content(child)))


def _has_below(path: str, other: str) -> bool:
    """Tell whether an element at a path contains that at another, or is it."""
    return f"{other}/".startswith(f"{path}/")


def _list_leaves(element: Element, path: str) -> Iterator[tuple[str, Element]]:
    for child in element.children:
        inner = f"{path}/{child.tag}".lstrip("/")
        if child.children:
            yield from _list_leaves(child, inner)
        else:
            yield inner, child
