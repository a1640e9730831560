"""Rules on unknown elements in ``<gazebo>`` blocks."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import GazeboExtension, Robot
from ...source.document import Element
from ..fix import FixContext, Proposal, find_element, rename_element, unsafe
from ..rule import ERROR, UNSAFE, WARNING, Problem, rule
from ..words import find_nearest, fold
from .keywords import JOINT_KEYWORDS, KEYWORDS, LINK_KEYWORDS, ROBOT_KEYWORDS
from .plugin_parameters import LIBRARIES, PARAMETERS
from .sdf_names import SDF_CHILDREN

APPLIES_TO = ("gazebo",)

_REMEDIES = {
    "mu": "write <mu1> and <mu2>",
    "friction": "write <mu1> and <mu2>, or <collision><surface><friction>…",
    "surface": "write it inside <collision>",
    "ode": "write it inside <collision><surface>",
    "color": "write <material>, or <visual><material><diffuse>",
    "restitution": "write <collision><surface><bounce><restitution_coefficient>",
}

_RENAMED = {
    "friction1": "mu1",
    "friction2": "mu2",
    "color": "material",
    "turnOffGravity": "turnGravityOff",
}


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic": "copy it unchanged into the SDF; the default applies",
    },
)
def unknown_extension(robot: Robot) -> Iterator[Problem]:
    """A ``<gazebo>`` block contains an unknown element.

    Gazebo reads about thirty keywords and the elements of SDF; it copies others into the model and
    ignores them. With ``<mu>`` or ``<Mu1>`` the friction stays 1, and ``<updateRate>`` in a sensor
    does not set its rate. The finding is an error if the intended element is clear. In sensors, and
    in plugins with known parameters, only misspelled elements are reported, because plugins may
    have any parameters.
    """
    unknown: dict[str, list[tuple[str, GazeboExtension, Element]]] = {}
    for block in robot.gazebo:
        known, parent = _get_known_elements(robot, block)
        for child in block.element.children:
            tag = child.tag
            if tag == "sensor":
                yield from _check_sdf(child)
            elif tag == "plugin":
                yield from _check_plugin(child)
            elif tag == "ros2_control":
                continue  # ros2-control-nested reports it
            elif parent and tag not in known and tag not in KEYWORDS and ":" not in tag:
                problem = _report_misspelled(block, child, known, parent)
                if problem is not None:
                    yield problem
                else:
                    unknown.setdefault(tag, []).append((parent, block, child))
    for tag, found in unknown.items():
        parent, block, child = found[0]
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        yield Problem(
            block.element,
            f"<{tag}>{more} is not an element for a {parent} in Gazebo, which ignores it; "
            "remove it",
            at=child,
            data={"count": len(found)},
        )


@unknown_extension.fix(UNSAFE)
def write_known_element(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the element that Gazebo reads."""
    element, word = find_element(problem), problem.data.get("write", "")
    if element is None or not word.replace("_", "").isalnum():
        return None
    if element.parent is None or element.parent.find_child(word) is not None:
        return None
    return unsafe(f"write <{word}>", rename_element(element, word))


def _get_known_elements(robot: Robot, block: GazeboExtension) -> tuple[frozenset[str], str]:
    """Get the elements that a block may contain, and the SDF element that it is copied to."""
    name = block.reference
    if not name:
        return ROBOT_KEYWORDS | SDF_CHILDREN["model"], "model"
    if name in robot.link:
        known = LINK_KEYWORDS | SDF_CHILDREN["link"]
        both = JOINT_KEYWORDS | SDF_CHILDREN["joint"] if name in robot.joint else frozenset()
        return known | both, "link"
    if name in robot.joint:
        return JOINT_KEYWORDS | SDF_CHILDREN["joint"], "joint"
    return frozenset(), ""


def _report_misspelled(
    block: GazeboExtension, child: Element, known: frozenset[str], parent: str
) -> Problem | None:
    """Report a misspelled element; None if no similar element is known."""
    tag = child.tag
    instead, right = _REMEDIES.get(tag, ""), _RENAMED.get(tag, "")
    if not instead and not right:
        right = _suggest_element(tag, known | KEYWORDS)
    if not instead and not right:
        return None
    return Problem(
        block.element,
        f"<{tag}> is not an element for a {parent} in Gazebo; {instead or f'write <{right}>'}",
        at=child,
        severity=ERROR,
        data={"write": right} if right else {},
    )


def _check_sdf(element: Element) -> Iterator[Problem]:
    """Report misspelled elements in a sensor and its descendants."""
    known = SDF_CHILDREN.get(element.tag)
    for child in element.children:
        if child.tag == "plugin":
            yield from _check_plugin(child)
            continue
        if known is not None and child.tag not in known and ":" not in child.tag:
            near = _suggest_element(child.tag, known)
            if near:
                yield Problem(
                    element,
                    f"<{element.tag}> has the unknown element <{child.tag}>; write <{near}>",
                    at=child,
                    severity=ERROR,
                    data={"write": near},
                )
                continue
        yield from _check_sdf(child)


def _check_plugin(plugin: Element) -> Iterator[Problem]:
    library = (plugin.get("filename") or "").rpartition("/")[2]
    if not library.startswith(LIBRARIES):
        return
    for child in plugin.children:
        tag = child.tag
        if tag in PARAMETERS or ":" in tag or len(tag) < 5:
            continue
        near = find_nearest(tag, PARAMETERS, 0.86)
        if near and fold(near) != fold(tag) and not _is_variant(tag, near):
            yield Problem(
                plugin,
                f"plugin '{plugin.get('name') or library}' has the unknown parameter <{tag}>; "
                f"write <{near}>",
                at=child,
                data={"write": near},
            )


def _is_variant(tag: str, near: str) -> bool:
    """Tell whether two words differ by a number, a plural or an additional word."""
    a, b = fold(tag), fold(near)
    letters = "".join(c for c in a if not c.isdigit()), "".join(c for c in b if not c.isdigit())
    if letters[0] == letters[1] or a.startswith(b) or b.startswith(a):
        return True
    return a.endswith(b) or b.endswith(a) or abs(len(a) - len(b)) > 1


def _suggest_element(tag: str, known: frozenset[str]) -> str:
    near = find_nearest(tag, known, 0.8)
    if near and fold(near) != fold(tag) and (len(tag) < 4 or abs(len(tag) - len(near)) > 2):
        return ""
    return near
