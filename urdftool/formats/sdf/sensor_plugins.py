"""Gazebo Classic plugins that publish sensor data, which gz sensors do themselves."""

from __future__ import annotations

from ...model.elements import Joint, Link
from ...model.gazebo_plugins import SENSOR_PLUGINS, get_library
from ...model.read import number
from ...model.sensors import get_topic
from ...source.document import Element
from .translation import Translation
from .xml import Node, add


def convert_sensor_plugin(made: Node, t: Translation, part: Link | Joint, element: Element) -> bool:
    """Convert a sensor's plugin to settings of the sensor; return whether it is such a plugin."""
    name = get_library(element)
    known = SENSOR_PLUGINS.get(name)
    if known is None:
        return False
    if known.type and made.get("type") != known.type:
        made.set("type", known.type)
    settings = {child.tag: child.text.strip() for child in element.children if child.text.strip()}
    topic = get_topic(element)
    _add_once(made, "topic", topic)
    rate = settings.get("updateRate") or settings.get("update_rate") or ""
    if number(rate):
        _add_once(made, "update_rate", rate)
    frame = next((settings[tag] for tag in known.frame if tag in settings), "")
    _name_frame(made, t, part, element, frame)
    on = f" on topic '{topic}'" if topic else ""
    t.report_note(
        "plugin",
        f"plugin '{name}' is not needed in gz: sensor '{made.get('name')}' publishes{on} itself, "
        f"where the world has gz-sim-{known.system}-system; ros_gz_bridge brings it to ROS",
        element,
        part,
    )
    return True


def _add_once(made: Node, tag: str, text: str) -> None:
    if text and made.find(tag) is None:
        node = add(made, tag, text)
        made.remove(node)
        pose = made.find("pose")
        made.insert(0 if pose is None else list(made).index(pose) + 1, node)


def _name_frame(
    made: Node, t: Translation, part: Link | Joint, element: Element, frame: str
) -> None:
    """Set the frame of a sensor's messages, if the SDF version supports it."""
    if not frame or made.find("gz_frame_id") is not None:
        return
    camera = made.find("camera")
    if t.options.is_at_least("1.12"):
        _add_once(made, "frame_id", frame)
    elif camera is not None:
        if camera.find("optical_frame_id") is None:
            add(camera, "optical_frame_id", frame)
    else:
        t.report_loss(
            "frame-id",
            f"SDF {t.options.sdf_version} cannot express the frame '{frame}' of the messages of "
            f"sensor '{made.get('name')}'; gz writes MODEL/LINK/SENSOR as their frame",
            element,
            part,
            hint="use --sdf-version 1.12, or write <gz_frame_id> in the <sensor>",
        )
