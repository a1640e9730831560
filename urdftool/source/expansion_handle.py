"""A process that expands one description, as the side that reads files sees it."""

from __future__ import annotations

from .expansion_channel import Channel
from .location import Place, SourceFile


class ExpansionHandle:
    """Process that expands, with the channel to it."""

    channel: Channel

    def find_place(self, files: list[SourceFile]) -> Place | None:
        """Return the location of the last evaluated element; None if unknown."""
        return None

    def end(self) -> int:
        """End the process and close the channel; return its exit code, negative for a signal."""
        raise NotImplementedError


def make_place(files: list[SourceFile], index: int, start: int) -> Place | None:
    """Return the location of an element by its file's index and its first byte; None if invalid."""
    known = 0 <= index < len(files) and 0 <= start < len(files[index].data)
    return Place(files[index], start, files[index].find_tag_end(start)) if known else None
