"""What is done while an engine is waited for, in a thread: the other cores are free."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from queue import SimpleQueue
from threading import Thread
from typing import TypeVar

from ..model.elements import Mesh, Robot
from .remembered import mesh_points

T = TypeVar("T")


@contextmanager
def meanwhile(robot: Robot, look: Callable[[T], object]) -> Iterator[Callable[[T], None]]:
    """Read what is seen of a robot, and look at what the engine tells first.

    What fails here is tried again, and told, by who asks for it.

    Args:
        robot: The robot, which finds its meshes.
        look: Is given what is told.

    Yields:
        To be told once; at the end of the ``with`` all is done, unless that ended in an error.
    """
    told: SimpleQueue[tuple[T] | None] = SimpleQueue()

    def work() -> None:
        with suppress(Exception):
            read_looks(robot)
        first = told.get()
        if first is not None:
            with suppress(Exception):
                look(*first)

    thread = Thread(target=work, daemon=True)
    with suppress(RuntimeError):  # the system may give no more threads
        thread.start()
    try:
        yield lambda first: told.put((first,))
    finally:
        told.put(None)
    if thread.ident is not None:
        thread.join()


def read_looks(robot: Robot) -> None:
    """Read the meshes that are seen."""
    for link in robot.links:
        for visual in link.visuals:
            if isinstance(visual.geometry, Mesh):
                mesh_points(robot, visual.geometry)
