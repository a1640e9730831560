"""What a joint can do."""

FILES = (
    *("kind", "axis", "origin", "place", "limits", "range", "drive", "mimic", "gripper", "safety"),
    "sides",
)
"""Files with rules, in reading order."""
