"""Elements that are there too often, or hold nothing."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ..rule import ERROR, WARNING, Problem, rule
from .owner import owner
from .vocabulary_table import VOCABULARY, census, misspelt_children


@rule(
    WARNING,
    raised={"mujoco": ERROR},
    effects={
        "urdfdom, gz, gazebo-classic, pybullet, pinocchio, drake": "take the first",
        "mujoco": "rejects the file: repeated element",
    },
)
def repeated_element(robot: Robot) -> Iterator[Problem]:
    """An element of which there can be one is written twice.

    urdfdom and with it ROS and Gazebo take the first and drop the others, whatever they say; MuJoCo
    refuses the file. Of two masses or two limits only one can have been meant.
    """
    known = census(robot.element).known
    for tag in ("link", "inertial", "visual", "collision", "material", "joint"):
        kind = VOCABULARY[tag]
        single = {child for child in kind.children if child not in kind.many}
        for element in known[tag]:
            if len(element.children) < 2:
                continue
            seen = set()
            for child in element.children:
                if child.tag in seen:
                    yield Problem(
                        child,
                        f"a second <{child.tag}> in the <{tag}> of {owner(child)}; "
                        "only the first is read",
                    )
                elif child.tag in single:
                    seen.add(child.tag)


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": (
            "take the first shape and drop the others"
        ),
    },
)
def several_shapes_in_geometry(robot: Robot) -> Iterator[Problem]:
    """A ``<geometry>`` holds more than one shape.

    Every reader takes the first and drops the rest without a word, so half of the body is not drawn
    or does not touch. Each shape needs a ``<visual>`` or ``<collision>`` of its own; a link may
    have as many as it likes.
    """
    for geometry in census(robot.element).known["geometry"]:
        if len(geometry.children) > 1:
            second = geometry.children[1]
            around = geometry.parent.tag if geometry.parent is not None else "visual"
            yield Problem(
                second,
                f"the <{second.tag}> in a {around} of {owner(second)} is dropped, as a <geometry> "
                "holds one shape; "
                f"give it a <{around}> of its own",
            )


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": (
            "load the link without its visuals and collisions, with an error in the log"
        ),
        "check_urdf": "reports success nevertheless",
        "mujoco, pybullet, drake": "reject the file",
    },
)
def empty_geometry(robot: Robot) -> Iterator[Problem]:
    """A visual or collision has no shape.

    urdfdom gives up on the link at that point: what else is drawn and touches of it is lost too,
    though the robot is reported as parsed. The link falls through the floor.
    """
    for link, shape in robot.shapes:
        if shape.geometry is not None:
            continue
        element = shape.element.child("geometry")
        if element is None and "geometry" in misspelt_children(shape.element).values():
            continue
        kind = shape.element.tag
        what = "no <geometry>" if element is None else "an empty <geometry>"
        yield Problem(
            link,
            f"a {kind} of link '{link.name}' has {what}; give it a shape or take the {kind} out",
            at=element if element is not None else shape,
        )
