"""Elements of SDF that an export to SDF copies, and those that are not read."""

from __future__ import annotations

from collections.abc import Container, Iterator

from ...diagnostic import Severity
from ...model.mechanism import NativeElement
from ...model.native import HELD_PATHS, HELD_TAGS, make_loop, make_native, make_rest
from ...model.provenance import Written
from ...model.settings import OF_LINKS, OF_ROBOT
from ...source.document import Element
from .read_links import Context, compute_part_pose
from .read_scope import Scope

_IN_ROWS = frozenset(("sensor", "plugin"))
"""Elements of which the robot has a part with all values."""

_NESTED = ("model", "include")
"""Elements whose links and joints the robot has."""

_COPIED = (
    *("sensor", "light", "projector", "particle_emitter", "battery", "audio_source"),
    *("audio_sink", "plugin"),
)
"""Elements of a link that are copied, and reported as a whole for other formats."""

_READ = {
    "model": ("link", "joint", "frame", *_NESTED, "pose", "plugin", "gripper",
              *(row.path for row in OF_ROBOT)),
    "link": (*_COPIED, "inertial", "collision", "visual", "pose", *(row.path for row in OF_LINKS)),
    "joint": (*HELD_PATHS["joint"], "axis2"),
    "inertial": ("mass", "pose", "inertia", "fluid_added_mass"),
    "collision": HELD_PATHS["collision"],
    "visual": (*HELD_PATHS["visual"], "material/pbr"),
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
        yield from _list_of_link(context, scope, prefix, item.element)
    loops = {closure.name for closure in context.robot.closures}
    for item in scope.joints.values():
        yield from _list_of_joint(prefix + item.name, item.element, loops)
    for child in scope.element.children:
        held = child.tag in _NESTED
        if not prefix and (held or child.tag in ("plugin", "gripper") or _is_unknown(child)):
            made = make_native("model", child)
            made.held = _list_all(made) if held else made.held
            yield _mark(made)
        elif child.tag == "plugin":
            text = "plugins of nested models are not copied"
            context.record_loss("nested-plugin", text, child, Severity.INFO)


def _is_unknown(element: Element) -> bool:
    """Tell whether an element of a model is neither a part of it nor a setting."""
    return element.tag not in HELD_TAGS and element.tag not in _READ["model"]


def _list_of_link(
    context: Context, scope: Scope, prefix: str, link: Element
) -> Iterator[NativeElement]:
    section = f"link {prefix}{link.get('name')}"
    for child in link.children:
        if child.tag in ("collision", "visual"):
            rest = make_rest(section, child.tag, (child,), Written(child.place, child))
            if rest is not None:
                yield rest
        elif child.tag in _COPIED or child.tag not in HELD_TAGS:
            pose = compute_part_pose(context, scope, prefix, link, child)
            yield _mark(make_native(section, child, pose))


def _list_of_joint(name: str, joint: Element, loops: Container[str]) -> Iterator[NativeElement]:
    if name in loops:
        yield make_loop(joint)
    else:
        rest = make_rest(f"joint {name}", "joint", (joint,), Written(joint.place, joint))
        if rest is not None:
            yield rest
    for child in joint.children:
        if child.tag in _IN_ROWS:
            yield _mark(make_native(f"joint {name}", child))


def _mark(made: NativeElement) -> NativeElement:
    """Set what other parts of the robot hold of a sensor or plugin."""
    if made.tag in _IN_ROWS:
        made.held = _list_all(made)
    return made


def _list_all(made: NativeElement) -> frozenset[str]:
    return frozenset(("text", *made.attributes, *(child.tag for child in made.children)))


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
