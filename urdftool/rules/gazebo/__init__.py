"""What Gazebo does with a robot's `<gazebo>` blocks."""

FILES = (
    "tags",
    "references",
    "vocabulary",
    "values",
    "settings",
    "lumping",
    "model",
    "sensors",
    "plugins",
    "drives",
)
"""Files with rules, in reading order."""
