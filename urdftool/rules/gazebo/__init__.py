"""Rules on ``<gazebo>`` blocks and the plugins and sensors in them."""

FILES = (
    "tags",
    "references",
    "vocabulary",
    "values",
    "setting_values",
    "settings",
    "lumping",
    "model",
    "sensors",
    "sensor_values",
    "plugins",
    "classic_parameters",
    "drives",
)
"""Files with rules, in reading order."""
