"""Elements of SDF, in a file or in ``<gazebo>`` blocks of a URDF, that no other part holds.

They are lights, projectors, batteries, nested models, joints of loops, and the values of
collisions, visuals and joints without a row in the tables of settings. A writer of SDF copies them,
and the comparison compares them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from ..source.document import Element
from .appearance import APPEARANCE
from .block_elements import is_set_by_block, list_model_elements, list_part_elements
from .elements import Joint, Link, Robot
from .kinematics import link_poses
from .mechanism import NativeElement
from .pose import IDENTITY, Pose, rpy_from_rotation
from .provenance import Written
from .sensors import read_sensor_pose
from .settings import LIMIT_NAMES, OF_JOINTS, RESISTANCE, SURFACE, Setting, Value
from .world_settings import OF_SDF

if TYPE_CHECKING:
    from .provenance import Provenance

NESTED = ("model", "include")
"""Elements of a model in which links and joints are."""

OTHER_TAGS = {
    "link": (*("light", "projector", "particle_emitter", "battery", "audio_source", "audio_sink"),),
    "joint": ("gearbox_ratio", "gearbox_reference_body", "thread_pitch"),
    "model": ("gripper", *NESTED),
}
"""Elements of SDF that the robot does not have as values, by what they are in."""

LOOP = "joint"
"""Tag of the elements of a model that close loops; other joints are parts of the robot."""

AROUND = "world"
"""Tag of the element around a model, which has what a world says in addition to its settings."""

NAMED_BY_TAG = ("light", "projector")
"""Elements that have their tag as their name if they write none."""


def _list_paths(rows: Iterable[Setting]) -> tuple[str, ...]:
    return tuple(path for row in rows for path in (row.path, row.also) if path)


_OF_AXIS = (
    *("xyz", "mimic", "use_parent_model_frame"),
    *(f"limit/{end}" for end in LIMIT_NAMES),
    *(path.removeprefix("axis/") for path in _list_paths((*RESISTANCE, *OF_JOINTS))
      if path.startswith("axis/")),
)  # fmt: skip
"""Paths of what the robot has as values below each axis of a joint."""

OF_SECOND_AXIS = tuple(f"axis2/{path}" for path in _OF_AXIS)
"""Paths of what the robot has as values of a joint of ``TWO_AXES``."""

TWO_AXES = ("universal", "revolute2")
"""Types of joints of SDF that turn about ``<axis>`` and ``<axis2>``."""

HELD_PATHS = {
    "collision": ("geometry", "pose", *_list_paths(SURFACE)),
    "visual": (
        *("geometry", "pose", "material/script", "material/pbr/metal/albedo_map"),
        *_list_paths(APPEARANCE),
    ),
    "joint": (
        *("parent", "child", "pose", "sensor", "plugin"),
        *(f"axis/{path}" for path in _OF_AXIS),
        *(path for path in _list_paths(OF_JOINTS) if not path.startswith("axis/")),
    ),
    "loop": ("parent", "child", "pose", "axis/xyz", "sensor", "plugin"),
    "world": (*NESTED, *_list_paths(OF_SDF)),
}
"""Paths of what the robot has as values, or what is reported alone, below a shape, a joint, one
that closes a loop, or a world.
"""


def make_native(section: str, element: Element, pose: Pose | None = None) -> NativeElement:
    """Return an element with its children.

    Args:
        section: What it belongs to: ``model``, or ``link`` or ``joint`` with a name.
        element: The element.
        pose: Its pose in the frame of the link, which replaces the one it writes; None for none.
    """
    made = _copy(section, element)
    if pose is not None:
        made.children = [child for child in made.children if child.tag != "pose"]
        made.values["pose"] = (*pose.translation, *rpy_from_rotation(pose.rotation))
    return made


def _copy(section: str, element: Element) -> NativeElement:
    return NativeElement(
        Written(element.place, element),
        section,
        element.tag,
        {name: v for name, v in element.attributes.items() if not name.startswith("xmlns")},
        element.text.strip(),
        children=[_copy(section, child) for child in element.children],
    )


def make_rest(
    section: str, kind: str, elements: Iterable[Element], provenance: Provenance | None
) -> NativeElement | None:
    """Return the values of a shape or joint that the robot does not hold; None without any.

    Args:
        section: Its link or joint.
        kind: ``collision``, ``visual`` or ``joint``.
        elements: The shape or joint, or elements of blocks that would be in it; for common leaves
            the last counts.
        provenance: Its source.
    """
    made = NativeElement(provenance, section, kind)
    for element in elements:
        held = HELD_PATHS[kind]
        if kind == "joint" and element.get("type") in TWO_AXES:
            held = (*held, *OF_SECOND_AXIS)
        for part in element.children if element.tag == kind else (element,):
            kept = _leave_out_held(section, held, part, part.tag)
            _merge(made, () if kept is None else (kept,))
    return made if made.children else None


def make_loop(element: Element, name: str) -> NativeElement:
    """Return what the robot does not hold of a joint that closes a loop, such as its limits."""
    made = NativeElement(Written(element.place, element), "model", LOOP)
    made.attributes = {"name": name}
    rest = make_rest("model", "loop", element.children, made.provenance)
    made.children = [] if rest is None else rest.children
    made.held = frozenset()  # whether it exists is known from the loop
    return made


def make_world(element: Element) -> NativeElement:
    """Return what the robot does not hold of the world around it, such as lights and physics.

    It has no name, since a robot may be in worlds of any name.
    """
    made = NativeElement(Written(element.place, element), AROUND, AROUND)
    kept = (
        _leave_out_held(AROUND, HELD_PATHS[AROUND], child, child.tag) for child in element.children
    )
    made.children = [child for child in kept if child is not None]
    made.held = frozenset()  # a file without a world can hold the same robot
    return made


def find_world(robot: Robot) -> NativeElement | None:
    """Return the world around the model of an SDF; None if its file has none."""
    return next((element for element in robot.native if element.tag == AROUND), None)


def _leave_out_held(
    section: str, held: Sequence[str], element: Element, path: str
) -> NativeElement | None:
    """Return an element without what the robot holds, by paths; None if nothing is left."""
    if any(f"{path}/".startswith(f"{one}/") for one in held):
        return None
    made = _copy(section, element)
    if element.children:
        below = [
            _leave_out_held(section, held, child, f"{path}/{child.tag}")
            for child in element.children
        ]
        made.children = [one for one in below if one is not None]
        return made if made.children else None
    return made if made.text or made.attributes else None


def _merge(target: NativeElement, added: Iterable[NativeElement]) -> None:
    """Add elements to the children of another; for common leaves the added ones count."""
    for one in added:
        same = next((child for child in target.children if child.tag == one.tag), None)
        if same is None or (one.children and one.get("name") and not same.children):
            target.children.append(one)
        elif one.children:
            _merge(same, one.children)
        else:
            same.text = one.text
            same.attributes.update(one.attributes)


def list_block_elements(robot: Robot) -> Iterator[NativeElement]:
    """Yield what the ``<gazebo>`` blocks of a URDF have in addition to what the robot holds."""
    for element in list_model_elements(robot):
        if element.tag == LOOP:
            yield make_loop(element, element.get("name") or "")
        elif _is_other("model", element):
            yield make_native("model", element)
    for link in robot.links:
        yield from _list_of_link(robot, link)
    for joint in robot.joints:
        yield from _list_of_joint(robot, joint)


def _is_other(kind: str, element: Element) -> bool:
    """Tell whether SDF has an element in a block; elements with a prefix are for programs."""
    return element.tag in OTHER_TAGS[kind] or ":" in element.tag


def _list_of_link(robot: Robot, link: Link) -> Iterator[NativeElement]:
    section = f"link {link.name}"
    elements = list(list_part_elements(robot, link))
    for element in elements:
        if _is_other("link", element):
            made = make_native(section, element, _compute_pose(robot, link, element))
            if element.tag in NAMED_BY_TAG and not made.name:
                made.attributes["name"] = element.tag
            yield made
    yield from _list_of_shapes(link, section, elements)


def _list_of_shapes(
    link: Link, section: str, elements: Sequence[Element]
) -> Iterator[NativeElement]:
    """Yield what blocks set for each shape of a link; the last of several materials counts."""
    materials = [element for element in elements if element.tag == "material"]
    material = [one for one in materials[-1:] if one.children]
    reflectance = link.surface.get("laser_retro")
    collisions = [one for one in link.collisions if is_set_by_block(one.name, link.name)]
    for shape in (*collisions, *link.visuals):
        rest = [element for element in elements if element.tag == shape.tag]
        rest += material if shape.tag == "visual" else []
        made = make_rest(section, shape.tag, rest, shape.provenance)
        if shape.tag == "visual" and reflectance is not None:  # which gz's lidars see
            made = _add_reflectance(made, section, reflectance)
        if made is not None:
            yield made


def _add_reflectance(visual: NativeElement | None, section: str, value: Value) -> NativeElement:
    """Add the reflectance that a block sets for the shapes of a link to a visual."""
    made = visual or NativeElement(value.provenance, section, "visual")
    if all(child.tag != "laser_retro" for child in made.children):
        text = str(value.content)
        made.children.append(NativeElement(value.provenance, section, "laser_retro", text=text))
    return made


def _list_of_joint(robot: Robot, joint: Joint) -> Iterator[NativeElement]:
    section = f"joint {joint.name}"
    elements = list(list_part_elements(robot, joint))
    rest = [element for element in elements if element.tag in ("physics", "axis", "axis2")]
    made = make_rest(section, "joint", rest, rest[0]) if rest else None
    if made is not None:
        yield made
    for element in elements:
        if _is_other("joint", element) and joint.name not in robot.link:
            yield make_native(section, element)


def _compute_pose(robot: Robot, link: Link, element: Element) -> Pose:
    """Return the pose of an element of a block in the frame of its link."""
    pose, frame = read_sensor_pose(element)
    if frame in robot.link and frame != link.name:
        poses = link_poses(robot)
        return poses.get(link.name, IDENTITY).invert() @ poses.get(frame, IDENTITY) @ pose
    return pose
