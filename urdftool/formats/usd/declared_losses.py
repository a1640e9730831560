"""Groups of reported losses by the difference that they explain."""

from __future__ import annotations

from ...compare.proof import Excuse

MASS = ("lossy-massless-body", "lossy-inertia-without-mass")
"""A moving body without mass got one, or the tensor of a link without mass was dropped."""

INERTIA = (
    *MASS, "lossy-inertia", "lossy-inertia-raised", "lossy-inertia-moved",
    "inertia-triangle-inequality",
)  # fmt: skip
"""A tensor was changed."""

TREE = ("lossy-joint-type", "lossy-floating-joint")
"""A joint moves differently from its description."""

SHAPES = (
    "lossy-shape", "lossy-ellipsoid", "mesh-not-found", "corrupt-mesh", "bad-scale",
)  # fmt: skip
"""A shape was dropped or changed."""

EXCUSES = (
    Excuse(("mass", "center of mass"), frozenset(MASS), "body"),
    Excuse(("inertia",), frozenset(INERTIA), "body"),
    Excuse(("tree", "axes", "frames", "limits", "joint physics", "actuators"), frozenset(TREE)),
    Excuse(("frames", "tree", "base"), frozenset(("lossy-floating-joint",)), "robot"),
    Excuse(("tree",), frozenset(("lossy-mimic",))),
    Excuse(("joint physics",), frozenset(("lossy-joint-resistance", "lossy-negative-dynamics"))),
    Excuse(("limits",), frozenset(("lossy-effort",)), properties=("limit of effort",)),
    Excuse(("limits",), frozenset(("lossy-ball-limit",))),
    Excuse(("limits",), frozenset(("lossy-velocity",)), properties=("limit of velocity",)),
    Excuse(("collisions", "visuals", "surface", "colors", "textures"), frozenset(SHAPES)),
    Excuse(("collisions",), frozenset(("lossy-convex",))),
    Excuse(("surface",), frozenset(("lossy-friction",))),
    Excuse(("colors", "textures"), frozenset(("lossy-material", "lossy-texture"))),
    Excuse(("loops",), frozenset(("lossy-closure",))),
)
"""Rows whose differences a loss explains."""

UNSEEN = (
    Excuse(("loops",), frozenset(("unread-disabled-joint",))),
    Excuse(("textures",), frozenset(("unread-texture",)), "robot"),
)
"""Rows of what the reader does not hold of a stage."""
