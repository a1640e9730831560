"""Mass and inertia."""

FILES = (
    "presence",
    "completeness",
    "mass",
    "density",
    "tensor",
    "slips",
    "size",
    "center",
    "frame",
    "sides",
)
"""Files with rules, in reading order."""
