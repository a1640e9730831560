"""Rules on the ROS package of a description."""

FILES = ("resolution", "manifest", "xacro_calls")
"""Files with rules, in reading order."""
