"""What simulators make of a robot."""
