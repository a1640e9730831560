"""Names of the targets for which rules are enabled."""

TARGETS = (
    *("ros1", "ros2", "gazebo-classic", "gz", "mujoco", "pybullet", "moveit"),
    *("newton", "isaac"),
)
