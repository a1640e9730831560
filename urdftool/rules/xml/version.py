"""Rules on the URDF version, and on features of later versions."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from ...model.angles import format_angles
from ...model.elements import Robot
from ...model.pose import rotation_from_quaternion, rpy_from_rotation
from ...model.read import parse_numbers
from ...source.description import Description
from ...source.document import Document, Element, parse
from ...source.location import Place
from ..fix import (
    FixContext,
    Proposal,
    Span,
    find_attribute,
    find_element,
    remove_attribute,
    set_attribute,
    unsafe,
)
from ..rule import ERROR, INFO, UNSAFE, Problem, rule, select_holding
from ..unexpanded import is_unexpanded
from .owner import describe_owner
from .vocabulary_table import get_census, is_for_another_reader

_LIMITS_OF_1_2 = ("acceleration", "deceleration", "jerk")


@rule(
    ERROR,
    effects={
        "urdfdom, gz, gazebo-classic, pinocchio": (
            "reject the robot: urdfdom 3 and 4 read version 1.0 only, urdfdom 6 reads 1.0, 1.1 "
            "and 1.2"
        ),
        "mujoco, pybullet, drake": "ignore the version",
    },
)
def unsupported_urdf_version(robot: Robot) -> Iterator[Problem]:
    """Readers do not support the URDF version of the robot.

    urdfdom rejects a robot with an unsupported version, and the urdfdom of every released ROS
    supports only 1.0. The default is 1.0.
    """
    version = robot.version
    if version is None or version.strip() in ("1.0", "1") or is_unexpanded(version):
        return
    known = version.strip() in ("1.1", "1.2")
    what = "requires urdfdom 5.1 or 6" if known else "does not exist"
    uses_newer = known and next(_report_newer_features(robot, 1.0), None) is not None
    remedy = "remove its new features, and write 1.0" if uses_newer else "write 1.0, or remove it"
    yield Problem(
        robot,
        f"URDF version '{version}' {what}; {remedy}",
        at=robot.locate_attribute("version"),
        data={"uses_newer": uses_newer},
    )


_FEATURE_EFFECTS = {
    "urdfdom, gz, gazebo-classic, pinocchio (a capsule in a visual)": (
        "drop the visuals and collisions of the link, at least from this one on"
    ),
    "urdfdom, gz, gazebo-classic, pinocchio (a capsule in a collision)": (
        "drop the collisions of the link, at least from this one on"
    ),
    "pybullet, drake (a capsule in a visual)": "read it",
    "pybullet, drake (a capsule in a collision)": "read it",
    "mujoco (a capsule in a collision)": "reads it",
    "urdfdom, gz, gazebo-classic (a quaternion)": "ignore it: the rotation is the identity",
    "urdfdom, gz, gazebo-classic, mujoco, pybullet (a later limit)": "ignore it",
}


@unsupported_urdf_version.fix(UNSAFE)
def write_version(problem: Problem, context: FixContext) -> Proposal | None:
    """Write 1.0, if the robot has no features of later versions."""
    if problem.data["uses_newer"]:
        return None
    return unsafe('write version="1.0"', set_attribute(problem.element, "version", "1.0"))


@rule(
    ERROR,
    effects=_FEATURE_EFFECTS,
    group="robot",
    infos=True,
)
def feature_needs_newer_version(robot: Robot) -> Iterator[Problem]:
    """The robot has a feature of a later URDF version.

    Capsules and ``quat_xyzw`` require URDF 1.1, limits of acceleration and jerk 1.2. In a robot of
    version 1.0, readers drop the shapes of a link with a capsule, and ignore the other features. A
    capsule is an info in a robot for a different reader, such as Drake.
    """
    version = (robot.version or "1.0").strip()
    yield from _report_newer_features(robot, {"1.1": 1.1, "1.2": 1.2}.get(version, 1.0))


def _report_newer_features(robot: Robot, version: float) -> Iterator[Problem]:
    known = get_census(robot).known
    if version < 1.1:
        for element in known["capsule"]:
            yield Problem(
                element,
                f"{describe_owner(element)} has a <capsule>, which is not in URDF 1.0; "
                "for ROS and Gazebo, write a <cylinder> and two <sphere>s",
                severity=INFO if is_for_another_reader(robot.element) else None,
                group="{count} shapes are a <capsule>, which is not in URDF 1.0; for ROS and "
                "Gazebo, write a <cylinder> and two <sphere>s each",
                effects=select_holding(_FEATURE_EFFECTS, _get_condition(element)),
            )
        for element in known["origin"]:
            if "quat_xyzw" in element.attributes and "rpy" not in element.attributes:
                yield Problem(
                    element,
                    f"readers of URDF 1.0 ignore quat_xyzw in {describe_owner(element)}; write rpy",
                    at=element.locate_attribute("quat_xyzw"),
                    effects=select_holding(_FEATURE_EFFECTS, "a quaternion"),
                )
    if version < 1.2:
        for element in known["limit"]:
            for name in _LIMITS_OF_1_2:
                if name in element.attributes:
                    yield Problem(
                        element,
                        f"readers of URDF {version} ignore {name} of {describe_owner(element)}, "
                        "which requires 1.2",
                        at=element.locate_attribute(name),
                        severity=INFO,
                        effects=select_holding(_FEATURE_EFFECTS, "a later limit"),
                    )


def _get_condition(capsule: Element) -> str:
    shapes = capsule.parent and capsule.parent.parent
    in_visual = shapes is not None and shapes.tag == "visual"
    return "a capsule in a visual" if in_visual else "a capsule in a collision"


@feature_needs_newer_version.fix(UNSAFE)
def write_rpy(problem: Problem, context: FixContext) -> Proposal | None:
    """Write a quaternion as rpy."""
    element = find_element(problem)
    if element is None:
        return None
    if element.tag == "origin" and "quat_xyzw" in element.attributes:
        quaternion = parse_numbers(element.get("quat_xyzw"), 4)
        if quaternion is None or math.hypot(*quaternion) < 1e-9:
            return None
        x, y, z, w = quaternion
        rpy = format_angles(rpy_from_rotation(rotation_from_quaternion((w, x, y, z))), 10)
        return unsafe(
            f'write rpy="{rpy}"',
            remove_attribute(element, "quat_xyzw"),
            set_attribute(element, "rpy", rpy),
        )
    return None


@rule(
    ERROR,
    effects={
        "urdfdom": "6 rejects the robot if its version is 1.1 or later; 3 and 4 take rpy",
    },
)
def rpy_and_quat(robot: Robot) -> Iterator[Problem]:
    """An ``<origin>`` has two rotations: ``rpy`` and ``quat_xyzw``.

    Readers that support both reject them, other readers take ``rpy``.
    """
    for element in get_census(robot).known["origin"]:
        if "rpy" in element.attributes and "quat_xyzw" in element.attributes:
            yield Problem(
                element,
                f"<origin> of {describe_owner(element)} has both rpy and quat_xyzw; write only rpy",
                at=element.locate_attribute("quat_xyzw"),
            )


_COLON_SPACE = re.compile(r":(?=\s)")


@rpy_and_quat.fix(UNSAFE)
def keep_rpy(problem: Problem, context: FixContext) -> Proposal | None:
    """Keep rpy, which readers of URDF 1.0 take."""
    found = find_attribute(problem)
    if found is None:
        return None
    return unsafe("keep rpy", remove_attribute(found[0], "quat_xyzw"))


@rule(
    INFO,
    on=("ros2",),
    effects={"ros2 run … -p robot_description:=…": "stops: couldn't parse parameter override rule"},
    infos=True,
)
def colon_space_in_comment(document: Document, description: Description) -> Iterator[Problem]:
    """A comment contains a colon with a space or line end after it.

    ROS 2 reads a parameter on the command line as YAML, where this is a key and a value: the node
    does not start, and the error does not mention the comment. A launch file with
    ``ParameterValue(…, value_type=str)`` avoids this.
    """
    if document.file is not description.files[0]:
        return
    found = [comment for comment in document.comments if _COLON_SPACE.search(comment.text)]
    if found:
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        yield Problem(
            document.root,
            f"comment{more} contains a colon before a blank or line end, which ROS 2 may read as "
            "YAML; write ' - '",
            at=Place(document.file, found[0].start, found[0].end),
        )


@colon_space_in_comment.fix(UNSAFE)
def replace_colons(problem: Problem, context: FixContext) -> Proposal | None:
    """Write ``-`` for the colon in all comments of the file."""
    document = context.document
    if document is None:
        return None
    data, spans = document.file.data, []
    for comment in parse(document.file).comments:
        if b"urdftool-ignore" in data[comment.start : comment.end]:
            continue
        for match in re.finditer(rb":(?=\s)", data[comment.start : comment.end]):
            start = comment.start + match.start()
            blank = b"-" if data[start - 1 : start].isspace() else b" -"
            if data[start + 2 : start + 3] == b"-" or data[start - 1 : start] == b"-":
                return None
            spans.append(Span(document.file, start, start + 1, blank))
    return unsafe("write ' - ' for ': ' in comments", *spans) if spans else None
