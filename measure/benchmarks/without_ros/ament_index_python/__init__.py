"""A stand-in for ROS's package index, so that plain xacro can be timed without ROS."""
