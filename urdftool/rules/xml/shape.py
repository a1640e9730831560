"""Rules on repeated and empty elements."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Collision, Link, Robot, Visual
from ...model.urdf_schema import VOCABULARY
from ...source.document import Element
from ..fix import (
    Change,
    FixContext,
    Proposal,
    are_equal_elements,
    find_element,
    get_written_lines,
    remove_element,
    replace_element,
    safe,
    unsafe,
)
from ..mujoco import keeps_visuals
from ..rule import BOTH, ERROR, UNSAFE, WARNING, Problem, rule
from .owner import describe_owner
from .vocabulary_table import find_misspelled_attributes, find_misspelled_children, get_census

_REPEATED_IN_MUJOCO = "mujoco (an element that it reads)"
_UNREAD_BY_MUJOCO = ("safety_controller", "calibration")


@rule(
    WARNING,
    raised={"mujoco": ERROR},
    effects={
        "urdfdom, gz, gazebo-classic, pybullet, pinocchio, drake": "take the first",
        _REPEATED_IN_MUJOCO: "rejects the file: repeated element",
    },
)
def repeated_element(robot: Robot) -> Iterator[Problem]:
    """An element that may only be written once is repeated.

    urdfdom, and therefore ROS and Gazebo, take the first and ignore the others; MuJoCo rejects the
    file, except for an element that it does not read. Remove the wrong one.
    """
    known, keeps = get_census(robot).known, keeps_visuals(robot)
    effects = repeated_element.effects
    for tag in ("link", "inertial", "visual", "collision", "material", "joint"):
        kind = VOCABULARY[tag]
        single = {child for child in kind.children if child not in kind.many}
        for element in known[tag]:
            if len(element.children) < 2:
                continue
            seen = set()
            for child in element.children:
                if child.tag in seen:
                    in_visual = tag == "visual" and child.tag != "material" and not keeps
                    ignored = in_visual or child.tag in _UNREAD_BY_MUJOCO
                    yield Problem(
                        child,
                        f"second <{child.tag}> in the <{tag}> of {describe_owner(child)}: "
                        "readers take only the first; remove one",
                        severity=WARNING if ignored else None,
                        effects=[k for k in effects if not (ignored and k == _REPEATED_IN_MUJOCO)],
                    )
                elif child.tag in single:
                    seen.add(child.tag)


_NEEDED = {
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
    "axis": ("xyz",),
    "color": ("rgba",),
}
"""Attributes without which an element has no meaning; others are reported by other rules."""

_OF_VISUAL = "gz, gazebo-classic, pinocchio (a visual)"
_OF_COLLISION = "gz, gazebo-classic, pinocchio (a collision)"
_OF_SHAPE = ("pybullet (a shape)", "drake (a shape)")
_OF_AXIS = "gz, gazebo-classic (an axis)"
_OF_COLOR = ("gz, gazebo-classic (a color)", "drake (a color)")


@rule(
    ERROR,
    effects={
        _OF_VISUAL: "load the link without its visuals and collisions, with an error in the log",
        _OF_COLLISION: "load the link without its collisions, with an error in the log",
        _OF_SHAPE[0]: "rejects the robot",
        _OF_SHAPE[1]: "rejects the file",
        _OF_AXIS: "reject the model: the axis is 0 0 0",
        _OF_COLOR[0]: "load the robot without the color",
        _OF_COLOR[1]: "rejects the file",
        "mujoco": "rejects the file: required attribute missing",
    },
)
def missing_attribute(robot: Robot) -> Iterator[Problem]:
    """A shape, axis or color has none of its numbers.

    A box needs ``size``, a cylinder ``radius`` and ``length``, a sphere ``radius``, an axis ``xyz``
    and a color ``rgba``. urdfdom stops reading the link at a shape without its size: a link with
    such a visual also loses its collisions, and ``check_urdf`` still reports success.
    """
    known = get_census(robot).known
    keeps = keeps_visuals(robot)
    for tag, names in _NEEDED.items():
        for element in known[tag]:
            misspelled = set(find_misspelled_attributes(element).values())
            missing = [n for n in names if n not in element.attributes and n not in misspelled]
            if missing:
                what = " and ".join(missing)
                them = "them" if len(missing) > 1 else "it"
                yield Problem(
                    element,
                    f"<{tag}> of {describe_owner(element)} has no {what}; write {them}",
                    effects=_list_effects(element, keeps),
                )


def _list_effects(element: Element, keeps: bool) -> list[str]:
    """List what readers do without the numbers of an element; ``keeps``: MuJoCo reads visuals."""
    if element.tag == "axis":
        return [_OF_AXIS, "mujoco"]
    if element.tag == "color":
        return [*_OF_COLOR, "mujoco"]
    above = element.parent
    while above is not None and above.tag not in ("visual", "collision"):
        above = above.parent
    if above is not None and above.tag == "visual":
        return [_OF_VISUAL, *_OF_SHAPE, *["mujoco"] * keeps]
    return [_OF_COLLISION, *_OF_SHAPE, "mujoco"]


def list_shapes(geometry: Element) -> list[Element]:
    """List the shapes of a ``<geometry>``, without misplaced elements of URDF."""
    return [
        child
        for child in geometry.children
        if child.tag in VOCABULARY["geometry"].children
        or not (child.tag in VOCABULARY or ":" in child.tag)
    ]


@repeated_element.fix(BOTH, reveals=True)
def keep_first(problem: Problem, context: FixContext) -> Proposal | None:
    """Keep the first element, which readers take."""
    element = problem.element
    parent = element.parent
    if parent is None:
        return None
    one = parent.find_child(element.tag)
    if one is None or one is element:
        return None
    if are_equal_elements(one, element) or element.tag == "material":
        return safe(f"keep the first <{element.tag}>, which readers take", remove_element(element))
    return unsafe(f"keep the first <{element.tag}>, which readers take", remove_element(element))


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pybullet, pinocchio": (
            "take the first shape and drop the others"
        ),
        "mujoco (different shapes)": (
            "takes a box before a cylinder before a sphere, and drops the others"
        ),
        "mujoco (one shape twice)": "rejects the file: repeated element",
        "drake": "takes a box before a sphere before a cylinder, and drops the others",
        "newton": "takes all of them",
    },
)
def several_shapes_in_geometry(robot: Robot) -> Iterator[Problem]:
    """A ``<geometry>`` contains more than one shape.

    Each reader takes one shape and ignores the others without a message, and readers differ:
    urdfdom takes the first, MuJoCo and Drake prefer a box. So parts of the link are not drawn, or
    make no contact. Write a separate ``<visual>`` or ``<collision>`` for each shape.
    """
    for geometry in get_census(robot).known["geometry"]:
        shapes = list_shapes(geometry)
        if len(shapes) > 1 and geometry.children[0] is shapes[0]:
            first, second = shapes[:2]
            around = geometry.parent.tag if geometry.parent is not None else "visual"
            drawn = around == "visual" and not keeps_visuals(robot)
            twice = len({shape.tag for shape in shapes}) < len(shapes)
            untrue = "different shapes" if twice else "one shape twice"
            of_mujoco = {f"mujoco ({untrue})"}
            if drawn:
                of_mujoco = {key for key in several_shapes_in_geometry.effects if "mujoco" in key}
            read = set(several_shapes_in_geometry.effects) - of_mujoco
            yield Problem(
                second,
                f"{around} of {describe_owner(second)} has a <{second.tag}> next to its "
                f"<{first.tag}>, but readers take only one; "
                f"write a separate <{around}> for each",
                effects=[key for key in several_shapes_in_geometry.effects if key in read],
            )


@several_shapes_in_geometry.fix(UNSAFE, reveals=True)
def separate_shapes(problem: Problem, context: FixContext) -> Proposal | None:
    """Write a separate visual or collision for each shape."""
    shape = problem.element
    geometry = shape.parent
    part = geometry.parent if geometry is not None else None
    if geometry is None or part is None or part.tag not in ("visual", "collision"):
        return None
    changes: list[Change] = []
    for other in list_shapes(geometry)[1:]:
        inside = [line for c in part.list_children("origin") for line in get_written_lines(c)]
        material = [line for c in part.list_children("material") for line in get_written_lines(c)]
        lines = (
            f"<{part.tag}>",
            *(f"\t{line}" for line in inside),
            "\t<geometry>",
            *(f"\t\t{line}" for line in get_written_lines(other)),
            "\t</geometry>",
            *(f"\t{line}" for line in material),
            f"</{part.tag}>",
        )
        changes += [remove_element(other), Change("after", part, blocks=(lines,))]
    return unsafe(f"write a separate <{part.tag}> for each shape", *changes)


_SHAPES = ("box", "cylinder", "sphere", "capsule", "mesh")
_DROPPING = "urdfdom, gz, gazebo-classic, pinocchio"


@rule(
    ERROR,
    effects={
        f"{_DROPPING} (a visual)": (
            "load the link without its visuals and collisions, with an error in the log"
        ),
        "pinocchio (a collision)": (
            "loads the link without its collisions, with an error in the log"
        ),
        "check_urdf": "reports success anyway",
        "pybullet, drake": "reject the file",
        "mujoco": "rejects the file",
    },
)
def empty_geometry(robot: Robot) -> Iterator[Problem]:
    """A visual or collision has no shape.

    urdfdom loads the link without visual and collision geometry, and reports the robot as loaded;
    the link falls through the ground. PyBullet and Drake reject the file, and so does MuJoCo for a
    collision; it discards visuals unless ``discardvisual`` is ``false``.
    """
    keeps = keeps_visuals(robot)
    for link, shape in robot.shapes:
        if shape.geometry is not None:
            continue
        element = shape.element.find_child("geometry")
        if element is None and "geometry" in find_misspelled_children(shape.element).values():
            continue
        at = element if element is not None else shape
        read = ["mujoco"] if keeps or isinstance(shape, Collision) else []
        urdfdom = _DROPPING if isinstance(shape, Visual) else "pinocchio"
        effects = [f"{urdfdom} (a {shape.element.tag})", "check_urdf", "pybullet, drake", *read]
        yield Problem(link, _describe_missing_shape(link, shape), at=at, effects=effects)


@empty_geometry.full
def report_empty_geometries(robot: Robot) -> Iterator[Problem]:
    """Report each visual and collision without a shape, also if ``<geometry>`` is misspelled."""
    for link, shape in robot.shapes:
        if shape.geometry is None:
            yield Problem(link, _describe_missing_shape(link, shape), at=shape)


def _describe_missing_shape(link: Link, shape: Visual | Collision) -> str:
    kind, element = shape.element.tag, shape.element.find_child("geometry")
    what = "no <geometry>" if element is None else "an empty <geometry>"
    return f"{kind} of link '{link.name}' has {what}; write a shape, or remove the {kind}"


@empty_geometry.fix(UNSAFE, reveals=True)
def fill_geometry(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the shape of the only counterpart; without one, remove the visual or collision."""
    element = find_element(problem)
    while element is not None and element.tag not in ("visual", "collision"):
        element = element.parent
    if element is None or find_misspelled_children(element):
        return None
    geometry = element.find_child("geometry")
    if geometry is not None and geometry.children:
        return None
    link = element.parent
    if link is None or _has_misplaced_shape(link):
        return None
    other = "collision" if element.tag == "visual" else "visual"
    shapes = [g for c in link.list_children(other) for g in c.list_children("geometry")]
    if len(shapes) == 1 and len(shapes[0].children) == 1:
        lines = tuple(get_written_lines(shapes[0]))
        origin = element.find_child("origin")
        if geometry is not None:
            change = replace_element(geometry, lines)
        elif origin is not None:
            change = Change("after", origin, blocks=(lines,))
        else:
            change = Change("first", element, blocks=(lines,))
        return unsafe(f"write the shape of the {other}", change)
    return unsafe(f"remove the empty <{element.tag}>", remove_element(element))


def _has_misplaced_shape(link: Element) -> bool:
    """Tell whether a shape or ``<geometry>`` of a link is in the wrong element.

    Moving it is the fix then, and not another shape or none.
    """
    places = {"geometry": ("visual", "collision"), **dict.fromkeys(_SHAPES, ("geometry",))}
    return any(
        one.parent is not None and one.parent.tag not in places.get(one.tag, (one.parent.tag,))
        for one in link.walk()
    )
