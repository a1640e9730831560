"""The error raised when numbers cannot belong to a rigid body."""

from ..errors import UrdftoolError


class InertiaError(UrdftoolError, ValueError):
    """A size, mass or tensor that no rigid body has; the sentence says what would be right."""
