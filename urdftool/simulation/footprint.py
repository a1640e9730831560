"""What a robot stands on: the polygon of the plane around all that touches it.

An engine may report one point of a contact at one moment and another at the next, so the corners of
the shapes that touch, as far as they are down there too, belong to it.
"""

from __future__ import annotations

import numpy as np

from .recording import Array
from .run import Run
from .shapes import Shape, lowest

EVEN = 0.001
"""How much higher than the lowest point of its body a corner may be that touches, of the
robot's size."""


def footprint(run: Run) -> Array:
    """Points of the plane at the end that carry the robot [m], shape (n, 2)."""
    touching = run.recording.carrying
    found = [np.array([contact.point[:2] for contact in touching]).reshape(-1, 2)]
    links = {contact.one for contact in touching}
    for number, body in enumerate(run.bodies.bodies):
        shapes = [shape for shape in body.shapes if shape.link in links]
        if not shapes:
            continue
        pose = run.end.pose(number)
        turn, at = np.array(pose.rotation), np.array(pose.translation)
        highest = lowest(shapes, turn, at) + EVEN * run.bodies.size
        for shape in shapes:
            corners = _placed_corners(shape) @ turn.T + at
            found.append(corners[corners[:, 2] <= highest, :2])
    return np.concatenate(found)


def _placed_corners(shape: Shape) -> Array:
    """Corners of a shape in its body's frame, shape (n, 3); what is round has none."""
    if shape.kind not in ("mesh", "box"):
        return np.zeros((0, 3))
    turned = shape.corners() @ np.array(shape.pose.rotation).T
    placed: Array = turned + np.array(shape.pose.translation)
    return placed
