"""Pictures on several cores: in their order, and none lost with a worker."""

import multiprocessing
import os
import signal

import numpy as np
import pytest

from urdftool.drawing.together import drawn_together

FORKS = "fork" in multiprocessing.get_all_start_methods()
HERE = os.getpid()


def numbered(number):
    return [np.full((2, 2, 3), number, np.uint8)]


def values(drawn):
    return [int(images[0][0, 0, 0]) for images in drawn]


@pytest.mark.parametrize("workers", [1, 2, 8])
def test_they_come_in_their_order(workers):
    assert values(drawn_together(numbered, 20, workers)) == list(range(20))
    assert values(drawn_together(numbered, 0, workers)) == []


@pytest.mark.skipif(not FORKS, reason="processes cannot be forked here")
def test_they_are_drawn_by_others():
    def who(number):
        return [np.full((2, 2, 3), os.getpid() == HERE, np.uint8)]

    assert values(drawn_together(who, 3, 2)) == [0, 0, 0]


@pytest.mark.skipif(not FORKS, reason="processes cannot be forked here")
def test_what_a_killed_worker_leaves_is_drawn_here():
    def dies(number):
        if number == 5 and os.getpid() != HERE:
            os.kill(os.getpid(), signal.SIGKILL)
        return numbered(number)

    assert values(drawn_together(dies, 9, 2)) == list(range(9))


def test_what_goes_wrong_is_raised():
    def fails(number):
        raise ValueError("no picture")

    for workers in (1, 2):
        with pytest.raises(ValueError, match="no picture"):
            next(drawn_together(fails, 3, workers))
