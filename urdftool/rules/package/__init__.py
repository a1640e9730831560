"""Rules on the ROS package of a description."""

FILES = ("resolution", "manifest", "launch_files", "xacro_calls", "configuration_files")
"""Files with rules, in reading order."""
