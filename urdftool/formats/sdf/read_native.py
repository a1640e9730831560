"""Elements of SDF that an export to SDF copies, and those that are not read."""

from __future__ import annotations

from collections.abc import Iterator

from ...diagnostic import Severity
from ...model.appearance import APPEARANCE
from ...model.mechanism import NativeElement
from ...model.pose import rpy_from_rotation
from ...model.provenance import Written
from ...model.settings import OF_JOINTS, OF_LINKS, OF_ROBOT, SURFACE
from ...source.document import Element
from .read_links import Context, compute_part_pose
from .read_scope import Scope

OF_LINK = (
    "sensor", "light", "projector", "particle_emitter", "battery", "audio_source", "audio_sink",
    "plugin",
)  # fmt: skip
"""Elements of a link that are copied."""

OF_JOINT = ("sensor", "plugin")
OF_MODEL = ("plugin", "gripper")

_IN_ROWS = frozenset(("sensor", "plugin"))
"""Elements of which the robot has a part with all values."""

_READ = {
    "model": ("link", "joint", "frame", "model", "include", "pose", "plugin", "gripper",
              *(row.path for row in OF_ROBOT)),
    "link": (*OF_LINK, "inertial", "collision", "visual", "pose", *(row.path for row in OF_LINKS)),
    "joint": (
        *("parent", "child", "pose", "axis/xyz", "axis/mimic", "axis2", "sensor", "plugin"),
        *(f"axis/limit/{end}" for end in ("lower", "upper", "effort", "velocity")),
        *("axis/dynamics/damping", "axis/dynamics/friction", "axis/use_parent_model_frame"),
        *(row.path for row in OF_JOINTS if row.path),
    ),
    "inertial": ("mass", "pose", "inertia", "fluid_added_mass"),
    "collision": ("geometry", "pose", *(row.path for row in SURFACE)),
    "visual": (
        *("geometry", "pose", "material/script", "material/pbr"),
        *(row.path for row in APPEARANCE),
    ),
}  # fmt: skip
"""Paths of the elements that the robot holds, or that are copied or reported as a whole."""


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
    context.robot.native = found


def _list_copied(context: Context, scope: Scope, prefix: str) -> Iterator[NativeElement]:
    for item in scope.links.values():
        for child in item.element.children:
            if child.tag in OF_LINK:
                made = _make(f"link {prefix}{item.name}", child)
                pose = compute_part_pose(context, scope, prefix, item.element, child)
                made.values["pose"] = (*pose.translation, *rpy_from_rotation(pose.rotation))
                yield made
    for item in scope.joints.values():
        for child in item.element.children:
            if child.tag in OF_JOINT:
                yield _make(f"joint {prefix}{item.name}", child)
    for child in scope.element.children:
        if child.tag in OF_MODEL and not prefix:
            yield _make("model", child)
        elif child.tag == "plugin":
            text = "plugins of nested models are not copied"
            context.record_loss("nested-plugin", text, child, Severity.INFO)


def _make(section: str, element: Element) -> NativeElement:
    """Return an element with its children; its pose is that in the robot's link."""
    children = [_make(section, child) for child in element.children if child.tag != "pose"]
    written = Written(element.place, element)
    attributes = dict(element.attributes)
    made = NativeElement(
        written, section, element.tag, attributes, element.text.strip(), children=children
    )
    if element.tag in _IN_ROWS:
        made.held = frozenset(("text", *attributes, *(child.tag for child in children)))
    return made


def _report_unread(context: Context, element: Element, kind: str) -> None:
    """Report the elements below one that the robot does not hold."""
    read = _READ[kind]
    for path, child in _list_leaves(element, ""):
        if ":" in path or any(_has_below(one, path) or _has_below(path, one) for one in read):
            continue
        severity = Severity.INFO if kind == "visual" else Severity.WARNING
        code = "look" if kind == "visual" else "element"
        what = "elements for the look are not read" if kind == "visual" else "elements are not read"
        name = f"{path} of <{kind}> {element.get('name') or ''}".strip()
        context.losses.add(code, what, name, child.place, severity)


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
