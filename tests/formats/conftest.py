"""Fixtures of tests of several formats."""

import pytest


@pytest.fixture
def stages_are_read_here(monkeypatch):
    """Read stages in this process, where OpenUSD is loaded once for all tests.

    Commands read them in a process with limits; tests/formats/test_native_limits.py and
    tests/formats/usd/test_bad_stages.py do so, too.
    """
    from urdftool.formats.usd import read

    def call(function, *arguments, limits, prepare):
        assert limits.memory
        prepare()
        return function(*arguments)

    monkeypatch.setattr(read, "call_with_limits", call)
