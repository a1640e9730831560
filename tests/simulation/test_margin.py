"""The static margin of known support polygons."""

import numpy as np
import pytest

from urdftool.simulation.checks.final_state import support_margin

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5], [0.5, 0.0]], dtype=float)


@pytest.mark.parametrize(
    ("points", "at", "margin"),
    [
        (SQUARE, (0.5, 0.5), 0.5),
        (SQUARE, (0.9, 0.4), 0.1),
        (SQUARE, (1.2, 0.5), -0.2),
        (SQUARE[:1], (0.3, 0.4), -0.5),
        (SQUARE[:2], (0.5, 0.2), -0.2),
    ],
)
def test_margin(points, at, margin):
    assert support_margin(points, np.array(at)) == pytest.approx(margin)
