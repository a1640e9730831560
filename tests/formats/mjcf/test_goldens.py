"""Whole small robots, as they are to come out."""

import pytest

from .goldens import GOLDENS, path, text


@pytest.mark.parametrize("name", GOLDENS)
def test_golden(name):
    assert text(name, GOLDENS[name]) == path(name).read_text("utf-8")


@pytest.mark.parametrize("name", GOLDENS)
def test_same_bytes_twice(name):
    assert text(name, GOLDENS[name]) == text(name, GOLDENS[name])
