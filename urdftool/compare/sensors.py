"""Comparison of sensors and cameras: type, place, rate and parameters.

MJCF has one sensor for each measured quantity, so a sensor of another format is compared with it as
the sensors of ``model/sensors.py: KINDS`` that measure the same.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..mechanics.reference import Array, get_origin_matrix, turn
from ..model.elements import Robot
from ..model.mechanism import Camera, MountedSensor
from ..model.numbers import describe_content
from ..model.sensors import KINDS, MAX_RAYS, get_kind, get_sensor_row
from ..model.settings import Settings, Value, get_number
from .difference import EXISTENCE, Comparison, Difference
from .frames import describe_motion, describe_pose, invert, measure_largest
from .origins import find_least_offset
from .pair import Match, Pair, add_presence, locate
from .settings import measure_content

_ROW = "sensors"
_ELEMENTARY = frozenset(tag for kind in KINDS for tag, _ in kind.mjcf)
_NUMBERS = 1e-6
"""Largest difference of parameters, relative above 1; of 32-bit numbers and printed digits."""
_PLACES = 1e-5
"""Largest distance [m] and angle [rad]; as of frames; chosen, no source."""
_CPU = ("lidar", "ray")


class _Sensor(NamedTuple):
    """A sensor or camera that is compared."""

    part: Camera | MountedSensor
    name: str
    type: str
    link: str
    pose: Array | None
    settings: Settings


def compare_sensors(pair: Pair, comparison: Comparison) -> None:
    """Compare the sensors and cameras of two robots of formats that have them."""
    if _ROW not in comparison.tolerances:
        return
    if "usd" in pair.formats:
        comparison.skipped[_ROW] = "of USD they are not read"
        return
    with_mjcf = pair.formats.count("mjcf")
    sides = []
    for bodies in (pair.a, pair.b):
        robot = bodies.robot
        sensors: Iterator[_Sensor] = _list_plain(robot)
        if with_mjcf == 1:
            sensors = _split(sensors, comparison, is_mjcf=robot.format == "mjcf")
        elif not with_mjcf:
            sensors = (s for s in sensors if not _is_hardware(s))
        sides.append(list(sensors))
    comparison.record_parts(_ROW, *sides)
    matched = _match(pair, *sides)
    for one, two in matched:
        _compare(pair, one, two, comparison, plain=with_mjcf != 1)
    known = {id(two.part) for _, two in matched}
    for side, left in enumerate(sides):
        for sensor in left:
            owner = _get_owner(sensor.part)
            add_presence(
                comparison, _ROW, _get_noun(sensor), EXISTENCE, side, sensor.part, sensor.name,
                sensor.type, owners=(owner,),
                # it measures what the sensors of the first robot do, and more
                is_convention=side == 1 and id(sensor.part) in known,
            )  # fmt: skip


def _is_hardware(sensor: _Sensor) -> bool:
    return isinstance(sensor.part, MountedSensor) and bool(sensor.part.quantities)


def _get_owner(part: Camera | MountedSensor) -> str:
    return part.link or getattr(part, "joint", "")


def _get_noun(sensor: _Sensor) -> str:
    return "camera" if isinstance(sensor.part, Camera) else "sensor"


def _list_plain(robot: Robot) -> Iterator[_Sensor]:
    """Yield the sensors and cameras as they are written."""
    parts: list[Camera | MountedSensor] = [*robot.mounted_sensors, *robot.cameras]
    for part in parts:
        link = part.link
        if isinstance(part, MountedSensor) and part.joint:
            joint = robot.joint.get(part.joint)
            link = "" if joint is None else joint.child
        pose = get_origin_matrix(part.origin)
        yield _Sensor(part, part.name, get_kind(part.type).type, link, pose, part.settings)


def _split(
    sensors: Iterator[_Sensor], comparison: Comparison, *, is_mjcf: bool
) -> Iterator[_Sensor]:
    """Yield cameras, and sensors as those of MJCF; what the other format lacks is recorded."""
    for sensor in sensors:
        if isinstance(sensor.part, Camera):
            yield sensor
        elif is_mjcf:
            if sensor.type in _ELEMENTARY:
                yield sensor
            else:
                comparison.record_not_comparable(
                    _ROW, f"sensors of type {sensor.type}: only in MJCF"
                )
        else:
            yield from _expand(sensor, comparison)


def _expand(sensor: _Sensor, comparison: Comparison) -> Iterator[_Sensor]:
    """Yield the sensors of MJCF that measure what a sensor measures."""
    part = sensor.part
    assert isinstance(part, MountedSensor)
    tags = get_kind(part.type).mjcf
    if part.quantities:
        suffixes = dict(pair for kind in KINDS for pair in kind.mjcf)
        tags = tuple((tag, suffixes[tag]) for tag in part.quantities)
    if not tags:
        comparison.record_not_comparable(_ROW, f"sensors of type {sensor.type}: not in MJCF")
    for tag, suffix in tags:
        if tag == "rangefinder":
            yield from _expand_rays(sensor, comparison)
            continue
        pose = None if tag == "touch" else sensor.pose
        yield sensor._replace(name=sensor.name + suffix, type=tag, pose=pose, settings={})


def _expand_rays(sensor: _Sensor, comparison: Comparison) -> Iterator[_Sensor]:
    """Yield a rangefinder for each ray, which measures along the z axis of its site."""
    names = ("samples", "minimum angle", "maximum angle")
    count, low, high = (get_number(sensor.settings, name) for name in names)
    rays = 0 if count is None else int(count)
    if not 0 < rays <= MAX_RAYS:
        text = f"lidars of more than {MAX_RAYS} rays: not in MJCF"
        comparison.record_not_comparable(_ROW, text)
        return
    z, y = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
    for index in range(rays):
        start, end = low or 0.0, high or 0.0
        ray = np.eye(4)
        angle = start + (end - start) * index / max(rays - 1, 1)
        ray[:3, :3] = turn(z, angle) @ turn(y, math.pi / 2)
        pose = None if sensor.pose is None else sensor.pose @ ray
        name = f"{sensor.name}_{index}"
        yield sensor._replace(name=name, type="rangefinder", pose=pose, settings={})


def _match(pair: Pair, one: list[_Sensor], two: list[_Sensor]) -> list[tuple[_Sensor, _Sensor]]:
    """Remove the sensors that correspond from both lists, and return them as pairs."""

    def same_name(x: _Sensor, y: _Sensor) -> bool:
        return x.name == y.name and isinstance(x.part, Camera) == isinstance(y.part, Camera)

    def same_body(x: _Sensor, y: _Sensor) -> bool:
        return _get_match(pair, x, y) is not None

    def same_kind(x: _Sensor, y: _Sensor) -> bool:
        return x.type == y.type and same_body(x, y)

    tests: tuple[Callable[[_Sensor, _Sensor], bool], ...] = (
        lambda x, y: same_name(x, y) and same_kind(x, y),
        lambda x, y: same_name(x, y) and same_body(x, y),
        same_name,
        same_kind,
    )
    found = []
    for test in tests:
        for x in list(one):
            y = next((y for y in two if test(x, y)), None)
            if y is not None:
                one[:] = [sensor for sensor in one if sensor is not x]
                two[:] = [sensor for sensor in two if sensor is not y]
                found.append((x, y))
    return found


def _get_match(pair: Pair, x: _Sensor, y: _Sensor) -> Match | None:
    """Return the bodies of two sensors if they correspond."""
    one, two = (bodies.body_of.get(s.link) for bodies, s in ((pair.a, x), (pair.b, y)))
    if one is None or two is None:
        return None
    other, frame = pair.frames.get(one, ("", np.eye(4)))
    return Match(pair.a.by_name[one], pair.b.by_name[two], frame) if other == two else None


def _has_same_link(pair: Pair, x: _Sensor, y: _Sensor) -> bool:
    """Tell whether two sensors are in one link, whose bodies correspond to none.

    Its joint has another type in the second robot, for example.
    """
    is_alone = pair.a.body_of.get(x.link) not in pair.frames
    return is_alone and pair.links.get(x.link, x.link) == y.link


def _compare(
    pair: Pair, one: _Sensor, two: _Sensor, comparison: Comparison, *, plain: bool
) -> None:
    """Compare two sensors; as MJCF writes them, or ``plain`` with every parameter."""

    def add(what: str, values: tuple[object, object], amount: float, **more: object) -> None:
        places = locate(one.part, None), locate(two.part, None)
        comparison.add(
            Difference(
                _ROW,
                _get_noun(one),
                (one.name, two.name),
                what,
                values,
                str(more.get("unit", "")),
                amount,
                places,
                str(more.get("note", "")),
                bool(more.get("convention")),
                (_get_owner(one.part), _get_owner(two.part)),
            )
        )

    match = _get_match(pair, one, two)
    if match is None and not _has_same_link(pair, one, two):
        add("link", (one.link, two.link), math.inf)
    elif match is None and one.pose is not None and two.pose is not None:
        size = measure_largest(invert(one.pose) @ two.pose)
        values = describe_pose(one.pose), describe_pose(two.pose)
        add("pose in the link", values, size if size > _PLACES else 0.0, unit="m, rad")
    elif match is not None and one.pose is not None and two.pose is not None:
        poses = match.one.members[one.link] @ one.pose, match.two.members[two.link] @ two.pose
        offset = find_least_offset(pair, match, *poses)
        size = measure_largest(offset)
        values = describe_pose(poses[0]), describe_pose(match.frame @ poses[1])
        note = describe_motion(offset)
        add("pose", values, size if size > _PLACES else 0.0, unit="m, rad", note=note)
    if one.type != two.type and (plain or not isinstance(one.part, Camera)):
        forms = dict(zip((one.type, two.type), pair.formats, strict=True))
        on_gpu = forms.get("lidar") == "urdf" and forms.get("gpu_lidar") == "sdf"
        add("type", (one.part.type, two.part.type), math.inf, convention=on_gpu)
    if not plain or set(pair.formats) == {"mjcf"}:
        _compare_images(one, two, add)
        return
    settings = {name: _rename(pair, value) for name, value in one.settings.items()}
    one = one._replace(settings=settings)
    own = [_get_frame(sensor) == sensor.link for sensor in (one, two)]
    for name in dict.fromkeys((*one.settings, *two.settings)):
        if name != "frame" or not all(own):  # links of one body, whose poses are compared
            _compare_parameter(name, one, two, add)


def _get_frame(sensor: _Sensor) -> object:
    """Return the name of the frame of a sensor's messages; None for none."""
    value = sensor.settings.get("frame")
    return None if value is None else value.content


def _compare_images(one: _Sensor, two: _Sensor, add: Callable[..., None]) -> None:
    """Compare field of view and resolution of two cameras."""
    if not (isinstance(one.part, Camera) and isinstance(two.part, Camera)):
        return
    x, y = one.part.vertical_fov, two.part.vertical_fov
    if x is not None and y is not None:
        amount = measure_content(x, y)
        amount = amount if amount > _NUMBERS else 0.0
        add("vertical field of view", (x, y), amount, unit="rad")
    sizes = one.part.resolution, two.part.resolution
    if sizes[0] is not None and sizes[1] is not None:
        texts = [f"{width} × {height}" for width, height in (sizes[0], sizes[1])]
        amount = 0.0 if sizes[0] == sizes[1] else math.inf
        add("resolution", (texts[0], texts[1]), amount, unit="pixels")


def _compare_parameter(name: str, one: _Sensor, two: _Sensor, add: Callable[..., None]) -> None:
    row = get_sensor_row(name)
    x, y = (s.settings[name].content if name in s.settings else row.default for s in (one, two))
    if name.startswith("collision") and isinstance(x, str) and isinstance(y, str):
        if _shorten(x) == _shorten(y):
            return
    amount = measure_content(x, y)
    values = describe_content(x), describe_content(y)
    add(name.replace("/", " "), values, amount if amount > _NUMBERS else 0.0, unit=row.unit)


def _rename(pair: Pair, value: Value) -> Value:
    """Return a parameter with the given new name, if it is the name of a renamed part."""
    name = value.content if isinstance(value.content, str) else ""
    return replace(value, content=pair.parts[name]) if name in pair.parts else value


def _shorten(collision: str) -> str:
    """Return the name of a collision without the scope that Gazebo gives it."""
    return collision.rpartition("__")[2].rpartition("::")[2]
