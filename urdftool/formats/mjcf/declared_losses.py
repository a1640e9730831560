"""Which loss of an export excuses which difference."""

from __future__ import annotations

INERTIA = (
    "lossy-inertia", "lossy-massless", "lossy-point-mass", "lossy-world-mass", "negative-mass",
    "inertia-triangle-inequality",
)  # fmt: skip
"""Masses or tensors are changed."""

TREE = (
    "lossy-mimic", "lossy-mimic-fixed", "zero-axis", "unknown-joint-type",
    "mimic-unknown-joint", "mimic-cycle",
)  # fmt: skip
"""A joint moves otherwise than it is written."""

FREE = "lossy-free-base"
"""The root is free for what the robot stands on."""

LOOPS = ("lossy-loop", "bad-extension-number")
"""A joint that closes a loop is left out."""

LIMITS = (
    "lossy-limit-inverted", "lower-above-upper", "not-a-number", "lossy-mimic-fixed",
    "lossy-actuator-config",
)  # fmt: skip
"""A joint's bounds are changed."""

TORN = ("lossy-floating",)
"""A body that floats hangs on the world instead of its parent."""

EFFORT = ("lossy-effort", "not-a-number", "lossy-actuator-config")
"""The bound of its effort is changed."""

SHAPES = (
    "lossy-collision", "lossy-visual", "lossy-mesh", "mesh-not-found", "bad-scale",
    "corrupt-mesh", "empty-geometry", "unsupported-shape", "not-a-number",
)  # fmt: skip
"""A shape is dropped or changed."""

CUT = ("lossy-convex",)
"""A mesh that collides is cut into pieces."""

LOOKS = ("lossy-material", "lossy-texture")
"""A colour is."""
