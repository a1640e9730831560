"""What Gazebo does with a robot's `<gazebo>` blocks."""
