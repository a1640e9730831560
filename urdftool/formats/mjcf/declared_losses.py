"""Groups of reported losses by the difference that they explain."""

from __future__ import annotations

from ...compare.proof import Excuse

INERTIA = (
    "lossy-inertia", "lossy-massless", "lossy-point-mass", "lossy-world-mass", "negative-mass",
    "inertia-triangle-inequality",
)  # fmt: skip
"""Masses or tensors were changed."""

TREE = (
    "lossy-mimic", "lossy-mimic-fixed", "zero-axis", "unknown-joint-type",
    "mimic-unknown-joint", "mimic-cycle",
)  # fmt: skip
"""A joint moves differently from its description."""

LOOPS = ("lossy-loop", "invalid-sdf-value")
"""A loop-closing joint was dropped."""

LIMITS = (
    "lossy-limit-inverted", "lower-above-upper", "not-a-number", "lossy-mimic-fixed",
    "lossy-actuator-config",
)  # fmt: skip
"""The limits of a joint were changed."""

TORN = ("lossy-floating",)
"""A floating body is a child of the world instead of its parent."""

EFFORT = ("lossy-effort", "lossy-limit-missing", "not-a-number", "lossy-actuator-config")
"""The effort limit of a joint was changed."""

SHAPES = (
    "lossy-collision", "lossy-visual", "lossy-mesh", "mesh-not-found", "bad-scale",
    "corrupt-mesh", "empty-geometry", "unsupported-shape", "not-a-number",
)  # fmt: skip
"""A shape was dropped or changed."""

EXCUSES = (
    Excuse(("mass", "center of mass", "inertia"), frozenset(INERTIA), "body"),
    Excuse(("tree", "axes", "frames", "limits", "joint physics", "actuators"), frozenset(TREE)),
    Excuse(("frames", "tree", "base"), frozenset(TORN), "robot"),
    Excuse(("limits", "actuators"), frozenset((*LIMITS, *EFFORT))),
    Excuse(("collisions", "visuals", "surface", "colors", "textures"), frozenset(SHAPES)),
    Excuse(("collisions", "surface"), frozenset(("lossy-convex",))),
    Excuse(("surface",), frozenset(("lossy-friction",))),
    Excuse(("colors", "textures"), frozenset(("lossy-material", "lossy-texture"))),
    Excuse(("sensors",), frozenset(("lossy-sensor", "lossy-camera"))),
    Excuse(("loops",), frozenset(LOOPS)),
    Excuse(("configurations",), frozenset(("lossy-configuration",))),
    Excuse(("other elements",), frozenset(("lossy-mujoco-element",))),
    Excuse(
        ("configurations",),
        frozenset(
            ("lossy-home", "lossy-limit-inverted", "lossy-mimic", "lossy-mujoco-element"),
        ),
        "robot",
    ),
)
"""Rows whose differences a loss explains."""

LOOKS = ("lossy-material", "lossy-texture")
"""A color or texture was changed."""
