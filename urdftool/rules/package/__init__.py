"""Rules on the ROS package of a description."""

FILES = ("resolution", "manifest", "launching")
"""Files with rules, in reading order."""
