"""Mass and inertia."""

FILES = (
    "presence",
    "completeness",
    "mass",
    "density",
    "tensor",
    "typing_mistakes",
    "size",
    "center",
    "frame",
    "sides",
)
"""Files with rules, in reading order."""
