"""Inertial parameters that were identified by measurements of a robot, and so belong together."""

from __future__ import annotations

import math

from ...model.elements import Link
from ...model.pose import compute_norm, make_pose

_FRANKA = (
    (2.92747, 0.042647, 0.05276),  # fr3
    (2.93554, 0.074911, 0.12879),  # fr3
    (2.2449, 0.050193, 0.062886),  # fr3
    (2.6156, 0.078457, 0.10467),  # fr3
    (2.32712, 0.10161, 0.11591),  # fr3
    (1.81704, 0.073161, 0.035551),  # fr3
    (0.627143, 0.018871, 0.00044804),  # fr3
    (0.629769, 0.064652, 0.011315),  # panda
    (4.97068, 0.047823, 1.4191),  # panda
    (0.646926, 0.029102, 0.062067),  # panda
    (3.2286, 0.081979, 0.084227),  # panda
    (3.5879, 0.12035, 0.073728),  # panda
    (1.22595, 0.057503, 0.07365),  # panda
    (1.66656, 0.062672, 0.011751),  # panda
    (0.735522, 0.062633, 0.027358),  # panda
)
"""Mass [kg], distance of the center of mass from the origin [m] and trace of the inertia [kg·m²] of
the links of Franka's arms. Source: inertials.yaml of the FR3 in franka_description, and for the
Panda, Gaz et al., 2019, as in panda.xml of MuJoCo Menagerie.
"""

_DIGITS = 2e-4
"""Relative difference of a number that a program rounded. Chosen, no source."""


def is_identified(link: Link) -> bool:
    """Tell whether the inertial of a link has the numbers that its maker published.

    They are right for the torques of the arm, not for the shape of each link. The numbers that are
    compared do not depend on the axes of the inertial frame, which other formats turn.
    """
    inertial = link.inertial
    if inertial is None or inertial.inertia is None or not inertial.mass:
        return False
    six = inertial.inertia.six
    com = compute_norm(make_pose(inertial.origin).translation)
    own = (inertial.mass, com, six[0] + six[3] + six[5])
    return any(
        all(math.isclose(a, b, rel_tol=_DIGITS) for a, b in zip(own, known, strict=True))
        for known in _FRANKA
    )
