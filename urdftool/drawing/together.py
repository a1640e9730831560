"""Many pictures on several cores, in their order."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ..workers import ignore_interrupts
from .png_file import Image

_AHEAD = 4  # pictures a worker may be ahead of those that are taken

_draw: list[Callable[[int], list[Image]]] = []
"""What workers call; they are forked and have it, as it cannot be sent to them."""


def drawn_together(
    draw: Callable[[int], list[Image]], count: int, workers: int
) -> Iterator[list[Image]]:
    """What a function draws for 0, 1, 2 … up to a count, by so many processes.

    With one, or where a process cannot be forked, it is done here, and so is what is left when a
    worker is killed.
    """
    done = 0
    if min(workers, count) > 1:
        for images in _forked(draw, count, min(workers, count)):
            yield images
            done += 1
    for number in range(done, count):
        yield draw(number)


def _forked(draw: Callable[[int], list[Image]], count: int, workers: int) -> Iterator[list[Image]]:
    import multiprocessing
    from collections import deque
    from concurrent.futures import Future, ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool

    if "fork" not in multiprocessing.get_all_start_methods():
        return
    context = multiprocessing.get_context("fork")
    _draw.append(draw)
    pool = ProcessPoolExecutor(workers, context, ignore_interrupts)
    waiting: deque[Future[list[Image]]] = deque()
    try:
        begun = 0
        for _ in range(count):
            while begun < count and len(waiting) < workers * _AHEAD:
                waiting.append(pool.submit(_drawn, begun))
                begun += 1
            yield waiting.popleft().result()
    except BrokenProcessPool:
        return
    finally:
        _draw.pop()
        pool.shutdown(wait=False, cancel_futures=True)


def _drawn(number: int) -> list[Image]:
    return _draw[-1](number)
