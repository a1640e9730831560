"""Rules on the ROS package of a description."""

FILES = ("resolution", "manifest", "launch_files", "xacro_calls")
"""Files with rules, in reading order."""
