"""Bodies in other frames, for tests."""

from urdftool.model.pose import Pose, rotation_from_rpy


def move(body, *, xyz=(0.0, 0.0, 0.0), rpy=(0.0, 0.0, 0.0)):
    """Express a body in the frame in which its own is at ``xyz`` [m], ``rpy`` [rad]."""
    return body.transform(Pose(rotation_from_rpy(rpy), xyz))
