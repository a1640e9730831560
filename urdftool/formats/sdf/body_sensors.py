"""Gazebo Classic plugins that measure a link or joint: for gz, each becomes a ``<sensor>``."""

from __future__ import annotations

from ...model.block_elements import list_plugins
from ...model.elements import Joint, Link
from ...model.gazebo_plugins import BODY_SENSORS, SENSOR_PLUGINS, get_library
from ...model.numbers import format_numbers_text, number_text
from ...model.read import number, parse_numbers
from ...source.document import Element
from ..common.naming import get_free_name
from .copied_elements import move_to_owner
from .sensor_plugins import convert_sensor_plugin
from .translation import Translation
from .xml import Node, add, get_or_create

_CARRIED = frozenset(
    ("bodyName", "body_name", "jointName", "joint_name", "updateRate", "update_rate", "topicName",
     "topic_name", "frameName", "frame_name", "frameId", "frame_id", "xyzOffset", "rpyOffset",
     "xyz_offset", "rpy_offset", "ros", "alwaysOn", "always_on", "robotNamespace", "serviceName")
)  # fmt: skip


def is_body_sensor(t: Translation, element: Element) -> bool:
    """Tell whether a plugin outside of a sensor becomes one: for gz, if its part exists."""
    return not t.options.classic and _place(t, element) is not None


def add_body_sensors(model: Node, t: Translation) -> None:
    """Add the sensors for plugins of the model, its links and its joints."""
    for element in list_plugins(t.robot):
        if is_body_sensor(t, element):
            _add_sensor(model, t, element)


def _place(t: Translation, element: Element) -> Link | Joint | None:
    """Return the link or joint that a plugin measures: by its parameters, else by its block."""
    kind = BODY_SENSORS.get(get_library(element))
    if kind is None:
        return None
    named = (child.text.strip() for tag in kind.names for child in element.list_children(tag))
    name = next(named, "") or (element.parent.get("reference") or "" if element.parent else "")
    if kind.type == "force_torque":
        joint = t.robot.joint.get(name)
        return joint if joint is not None and joint.name not in t.plan.dissolved else None
    return t.robot.link.get(name) if name in t.plan.owner else None


def _add_sensor(model: Node, t: Translation, element: Element) -> None:
    part = _place(t, element)
    assert part is not None
    kind = BODY_SENSORS[get_library(element)]
    if isinstance(part, Link):
        tag, name = "link", t.names.link(t.plan.owner[part.name])
    else:
        tag, name = "joint", t.names.get_joint(part.name)
    node = next((e for e in model.findall(tag) if e.get("name") == name), None)
    if node is None:  # a joint that SDF does not have, such as a floating one
        t.report_loss(
            "plugin",
            f"plugin '{get_library(element)}' measures '{part.name}', which is no {tag} in "
            "SDF; it is not exported",
            element,
            part,
        )
        return
    made = add(node, "sensor", name=_choose_free_name(node, element), type=kind.type)
    _add_pose(made, element)
    add(made, "always_on", "true")
    texts = {child.tag: child.text.strip() for child in element.children}
    for table, word in ((kind.noises, "stddev"), (kind.offsets, "mean")):
        for parameter, places in table.items():
            _set_noise(made, places, word, texts.get(parameter, ""))
    if get_library(element) in SENSOR_PLUGINS:
        convert_sensor_plugin(made, t, part, element)
    if isinstance(part, Link):
        move_to_owner(made, t, part)
    left = [tag for tag in texts if tag not in _CARRIED | {*kind.noises, *kind.offsets}]
    if left:
        text = f"plugin '{get_library(element)}' is sensor '{made.get('name')}' in gz; it has no "
        t.report_loss("plugin", text + ", ".join(dict.fromkeys(left)), element, part)


def _choose_free_name(node: Node, element: Element) -> str:
    name = element.get("name") or get_library(element)
    taken = {other.get("name") for other in node}
    return get_free_name(name, taken)


def _add_pose(made: Node, element: Element) -> None:
    six: list[float] = []
    for word in ("xyz", "rpy"):
        found = element.find_child(f"{word}Offset") or element.find_child(f"{word}_offset")
        six += (parse_numbers(found.text, 3) if found is not None else None) or (0.0, 0.0, 0.0)
    if any(six):
        add(made, "pose", format_numbers_text(six))


def _set_noise(made: Node, places: tuple[str, ...], word: str, text: str) -> None:
    """Set a noise parameter at each place; a vector of three sets one component per axis."""
    single = number(text)
    values = parse_numbers(text, 3) if single is None else (single, single, single)
    if values is None or not any(values):
        return
    for index, place in enumerate(places):
        noise = get_or_create(made, f"{place}/noise")
        noise.set("type", "gaussian")
        for tag in ("mean", "stddev"):
            get_or_create(noise, tag).text = noise.findtext(tag) or "0"
        get_or_create(noise, word).text = number_text(values[index % 3])
