"""Names of the elements of a description in its format, for messages."""

from __future__ import annotations

from ..model.elements import Robot

_NAMES = {
    "mjcf": {
        "<collision>": "geom that makes contact",
        "<origin>": "pos and quat",
        "<mimic>": "equality of joints",
        "<limit effort>": "the forcerange of its actuator",
    },
    "sdf": {"<origin>": "<pose>", "<limit effort>": "<effort>"},
}


def name_element(robot: Robot, urdf: str) -> str:
    """Return the name of an element in the format of the robot."""
    return _NAMES.get(robot.format, {}).get(urdf, urdf)
