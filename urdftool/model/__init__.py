"""The robot, in the specification's words."""
