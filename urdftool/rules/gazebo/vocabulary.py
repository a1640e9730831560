"""Words that Gazebo does not know."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import GazeboExtension, Robot
from ...source.document import Element
from ..fix import FixContext, Proposal, element_at, rename_element, unsafe
from ..rule import ERROR, UNSAFE, WARNING, Problem, rule
from ..words import fold, nearest
from .keywords import JOINT_KEYWORDS, KEYWORDS, LINK_KEYWORDS, ROBOT_KEYWORDS
from .plugin_parameters import LIBRARIES, PARAMETERS
from .sdf_names import SDF_CHILDREN

APPLIES_TO = ("gazebo",)

_INSTEAD = {
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
        "gz, gazebo-classic": "copy it into the SDF as it is; the default holds",
    },
)
def unknown_extension(robot: Robot) -> Iterator[Problem]:
    """Gazebo has no such word there.

    What a ``<gazebo>`` block holds is either one of some thirty words, or SDF. All else is copied
    into the simulated model and passed over: ``<mu>`` or ``<Mu1>`` leaves the friction at 1, an
    ``<updateRate>`` in a sensor leaves its rate as it is. It is an error where the word meant is
    plain.

    In sensors, and in plugins whose parameters are known, only words that are nearly right are
    told of: plugins read what they like.
    """
    strange: dict[str, list[tuple[str, GazeboExtension, Element]]] = {}
    for block in robot.gazebo:
        known, parent = _known(robot, block)
        for child in block.element.children:
            tag = child.tag
            if tag == "sensor":
                yield from _in_sdf(child)
            elif tag == "plugin":
                yield from _in_plugin(child)
            elif tag == "ros2_control":
                continue  # a rule of its own says where it belongs
            elif parent and tag not in known and tag not in KEYWORDS and ":" not in tag:
                problem = _misspelt(block, child, known, parent)
                if problem is not None:
                    yield problem
                else:
                    strange.setdefault(tag, []).append((parent, block, child))
    for tag, found in strange.items():
        parent, block, child = found[0]
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        yield Problem(
            block.element,
            f"<{tag}> means nothing to Gazebo at a {parent}, and nothing of it is read; "
            f"take it away{more}",
            at=child,
            data={"count": len(found)},
        )


@unknown_extension.fix(UNSAFE)
def write_known_element(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the element that Gazebo knows."""
    element, word = element_at(problem), problem.data.get("write", "")
    if element is None or not word.replace("_", "").isalnum():
        return None
    if element.parent is None or element.parent.child(word) is not None:
        return None
    return unsafe(f"write <{word}>", rename_element(element, word))


def _known(robot: Robot, block: GazeboExtension) -> tuple[frozenset[str], str]:
    """What may stand in a block, and which element of SDF it is copied to."""
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


def _misspelt(
    block: GazeboExtension, child: Element, known: frozenset[str], parent: str
) -> Problem | None:
    """Report an element in whose place another is meant; None where no other is known."""
    tag = child.tag
    instead, right = _INSTEAD.get(tag, ""), _RENAMED.get(tag, "")
    if not instead and not right:
        right = _near(tag, known | KEYWORDS)
    if not instead and not right:
        return None
    return Problem(
        block.element,
        f"<{tag}> means nothing to Gazebo at a {parent}; {instead or f'write <{right}>'}",
        at=child,
        severity=ERROR,
        data={"write": right} if right else {},
    )


def _in_sdf(element: Element) -> Iterator[Problem]:
    """What is nearly right in a sensor and all below it."""
    known = SDF_CHILDREN.get(element.tag)
    for child in element.children:
        if child.tag == "plugin":
            yield from _in_plugin(child)
            continue
        if known is not None and child.tag not in known and ":" not in child.tag:
            near = _near(child.tag, known)
            if near:
                yield Problem(
                    element,
                    f"<{element.tag}> has no <{child.tag}>; write <{near}>",
                    at=child,
                    severity=ERROR,
                    data={"write": near},
                )
                continue
        yield from _in_sdf(child)


def _in_plugin(plugin: Element) -> Iterator[Problem]:
    library = (plugin.get("filename") or "").rpartition("/")[2]
    if not library.startswith(LIBRARIES):
        return
    for child in plugin.children:
        tag = child.tag
        if tag in PARAMETERS or ":" in tag or len(tag) < 5:
            continue
        near = nearest(tag, PARAMETERS, 0.86)
        if near and fold(near) != fold(tag) and not _variant(tag, near):
            yield Problem(
                plugin,
                f"plugin '{plugin.get('name') or library}' has no <{tag}>; write <{near}>",
                at=child,
                data={"write": near},
            )


def _variant(tag: str, near: str) -> bool:
    """Whether two words differ in a number, a plural, or by a word more, as kin do."""
    a, b = fold(tag), fold(near)
    letters = "".join(c for c in a if not c.isdigit()), "".join(c for c in b if not c.isdigit())
    if letters[0] == letters[1] or a.startswith(b) or b.startswith(a):
        return True
    return a.endswith(b) or b.endswith(a) or abs(len(a) - len(b)) > 1


def _near(tag: str, known: frozenset[str]) -> str:
    near = nearest(tag, known, 0.8)
    if near and fold(near) != fold(tag) and (len(tag) < 4 or abs(len(tag) - len(near)) > 2):
        return ""
    return near
