"""What tests of the readers of all formats share."""

import pytest


def make_reading_fixtures(read, path):
    """Return two fixtures of a module: what a reader gives for a file, and its robot."""

    @pytest.fixture(scope="module")
    def mechanism():
        return read(path)

    @pytest.fixture(scope="module")
    def robot(mechanism):
        return mechanism.robot

    return mechanism, robot


def line_of(text, file):
    """Return the number of the first line of a file that contains a text, from 1."""
    lines = file.read_text("utf-8").splitlines()
    return next(number for number, line in enumerate(lines, 1) if text in line)
