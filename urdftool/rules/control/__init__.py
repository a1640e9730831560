"""Transmissions and ros2_control."""
