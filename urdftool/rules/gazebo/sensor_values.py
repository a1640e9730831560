"""Rules on values of sensors in ``<gazebo>`` blocks."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from ...model.elements import Robot, Sensor
from ...model.read import number
from ...source.document import Element
from ..fix import FixContext, Proposal, get_suggestion, is_computed, set_text, unsafe
from ..rule import GAZEBO, INFO, UNSAFE, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import find_nearest, suggest_name

APPLIES_TO = ("gazebo",)

_ANGLES = ("min_angle", "max_angle", "horizontal_fov")
_FRAMES = ("gz_frame_id", "ignition_frame_id", "optical_frame_id")


def _iterate_elements(robot: Robot, tags: tuple[str, ...]) -> Iterator[tuple[Sensor, Element]]:
    """Yield each sensor with its elements of some tags that have an expanded text."""
    for sensor in robot.sensors:
        for element in sensor.element.walk():
            if element.tag in tags and element.text.strip() and not is_unexpanded(element.text):
                yield sensor, element


@rule(
    WARNING,
    on=GAZEBO,
    evidence="SDFormat gives `min_angle`, `max_angle` and `horizontal_fov` in radians "
    "([specification](http://sdformat.org/spec?ver=1.9&elem=sensor))",
)
def sensor_angle_in_degrees(robot: Robot, *, turn: float = 2 * math.pi) -> Iterator[Problem]:
    """An angle of a sensor is more than a full turn, so it is in degrees.

    ``<min_angle>``, ``<max_angle>`` and ``<horizontal_fov>`` are in radians. A lidar from -90 to 90
    makes 28 turns: the rays are in wrong directions, and the scan does not fit the map. ``turn``
    [rad] is the largest angle that is not reported.
    """
    for sensor, element in _iterate_elements(robot, _ANGLES):
        value = number(element.text.strip())
        if value is None or not turn < abs(value) <= 360:
            continue
        right = f"{math.radians(value):.6g}"
        yield Problem(
            sensor.element,
            f"<{element.tag}> of sensor '{sensor.name}' is {value:g} rad, which is {value:g} "
            f"degrees; write {right}",
            at=element,
            data={"value": value, "write": right},
        )


@sensor_angle_in_degrees.fix(UNSAFE)
def write_radians(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the angle in radians, unless an expression computes it."""
    element = problem.at
    if not isinstance(element, Element) or is_computed(element):
        return None
    return unsafe(f"write {problem.data['write']}", set_text(element, problem.data["write"]))


@rule(
    INFO,
    on=("gz",),
    effects={
        "gz": "stamps the data with that name",
    },
)
def unknown_sensor_frame(robot: Robot) -> Iterator[Problem]:
    """The frame of a sensor is not a link.

    ``<gz_frame_id>`` and ``<optical_frame_id>`` are copied to the header of each message. TF has
    frames only for links, so RViz and SLAM drop the data, unless another node publishes the frame.
    Quotes in the text are a part of the name, and are a warning, as is a name near that of a link.
    """
    for sensor, element in _iterate_elements(robot, _FRAMES):
        name = element.text.strip()
        bare = name.strip("\"'")
        known = {link.partition("/")[2] or link for link in robot.link} | robot.link.keys()
        if name in known or name.rpartition("/")[2] in known:
            continue
        quoted = bare != name
        near = bare if quoted and bare in known else find_nearest(bare, robot.link, 0.85)
        what = "has quotes" if quoted else "is not a link"
        yield Problem(
            sensor.element,
            f"<{element.tag}> '{name}' of sensor '{sensor.name}' {what}"
            + (f"; write {bare}" if quoted else suggest_name(name, robot.link) or "; add the link"),
            at=element,
            severity=WARNING if quoted or near else None,
            data={"suggestion": bare if quoted else near},
        )


@unknown_sensor_frame.fix(UNSAFE)
def write_frame(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the quotes, or write the suggested link."""
    element = problem.at
    if not isinstance(element, Element) or is_computed(element):
        return None
    written = element.text.strip()
    bare = re.sub(r"^[\"']+|[\"']+$", "", written)
    right = bare if bare != written else get_suggestion(problem, written)
    return unsafe(f"write {right}", set_text(element, right)) if right else None
