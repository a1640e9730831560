"""The error for numbers that are not physically possible."""

from ..errors import UrdftoolError


class InertiaError(UrdftoolError, ValueError):
    """A size, mass or tensor that is physically impossible; the message contains the remedy."""
