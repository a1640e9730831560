"""Precompute results of checks in a thread, while an engine runs in its process."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from queue import SimpleQueue
from threading import Thread
from typing import TypeVar

from ..model.elements import Mesh, Robot
from .mesh_cache import get_outermost_points

T = TypeVar("T")


@contextmanager
def prefetch(robot: Robot, precompute: Callable[[T], object]) -> Iterator[Callable[[T], None]]:
    """Read the visual meshes of a robot in a thread, then precompute from the first message.

    Errors are ignored: the check that needs the result computes it again, and reports them.

    Yields:
        Function that passes the message, once. The thread has ended at the end of the ``with``
        statement, unless that raised an error.
    """
    messages: SimpleQueue[tuple[T] | None] = SimpleQueue()

    def work() -> None:
        with suppress(Exception):
            prefetch_visuals(robot)
        first = messages.get()
        if first is not None:
            with suppress(Exception):
                precompute(*first)

    thread = Thread(target=work, daemon=True)
    with suppress(RuntimeError):  # the thread limit of the system is reached
        thread.start()
    try:
        yield lambda first: messages.put((first,))
    finally:
        messages.put(None)
    if thread.ident is not None:
        thread.join()


def prefetch_visuals(robot: Robot) -> None:
    """Read the meshes of the visuals."""
    for link in robot.links:
        for visual in link.visuals:
            if isinstance(visual.geometry, Mesh):
                get_outermost_points(robot, visual.geometry)
