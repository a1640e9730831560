"""Rules on transmissions and ros2_control."""

FILES = (
    "transmissions",
    "transmission_joints",
    "ros2_control",
    "ros2_control_interfaces",
    "command_interfaces",
    "ros2_control_form",
    "ros2_control_simulated",
    "controllers",
    "parameter_types",
)
"""Files with rules, in reading order."""
