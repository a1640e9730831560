"""Values that are computed once for an object."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, TypeVar, cast

T = TypeVar("T")


class Memo:
    """Values that are computed once and live as long as their owner."""

    __slots__ = ("_known",)

    def __init__(self) -> None:
        """Create an empty memo."""
        self._known: dict[Hashable, Any] = {}

    def get(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return the value of a key, computing it at the first request."""
        try:
            return cast("T", self._known[key])
        except KeyError:
            return cast("T", self._known.setdefault(key, make()))

    def get_for(self, key: Hashable, given: object, make: Callable[[], T]) -> T:
        """Return the value of a key, computing it where it was not made of equal objects."""
        known = self._known.get(key)
        if known is None or known[0] != given:
            known = self._known[key] = given, make()
        return cast("T", known[1])

    def peek(self, key: Hashable) -> Any:
        """Return the value of a key; None if it was not computed."""
        return self._known.get(key)

    def clear(self) -> None:
        """Remove all values, which breaks reference cycles with the owner."""
        self._known.clear()

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle as an empty memo: values are recomputed."""
        return Memo, ()
