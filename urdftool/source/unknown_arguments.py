"""xacro arguments that are given to a description and have no effect."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .expansion import Expansion


def list_unknown_arguments(
    given: Mapping[str, str], expansion: Expansion | None
) -> dict[str, tuple[str, ...]]:
    """Return the given arguments that a description neither declares nor uses.

    Returns:
        The declared names by unknown name.
    """
    declared = () if expansion is None else tuple(expansion.arguments)
    unknown = [name for name in given if name not in declared]
    text = _join_sources(expansion) if unknown and expansion is not None else ""
    return {name: declared for name in unknown if f"$(arg {name})" not in text}


def _join_sources(expansion: Expansion) -> str:
    return "".join(f.data.decode(f.encoding, "replace") for f in expansion.files.values())
