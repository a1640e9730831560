"""Cases of a test of which only some run each time."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def list_cases(values: Iterable[Any], step: int) -> list[Any]:
    """Return values as parameters of a test; all but every ``step``-th are slow.

    Args:
        values: One value a case; a tuple has the values of several parameters.
        step: Distance of the cases that run each time, of which the first is one.
    """
    return [
        pytest.param(
            *(value if isinstance(value, tuple) else (value,)),
            marks=[pytest.mark.slow] * (index % step > 0),
        )
        for index, value in enumerate(values)
    ]
