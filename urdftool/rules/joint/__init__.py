"""Rules on the type, axis, limits, dynamics and placement of joints."""

FILES = (
    *(
        "kind",
        "axis",
        "origin",
        "axis_position",
        "limits",
        "range",
        "drive",
        "mimic",
        "gripper",
        "safety",
    ),
    "sides",
)
"""Files with rules, in reading order."""
