"""In what two engines differ, in words and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

from .findings import Painter
from .json_text import json_text
from .simulate import _fault, _faults

if TYPE_CHECKING:
    from ..simulation.fault import Fault


def differences_text(faults: Sequence[Fault], *, colors: bool = False) -> str:
    """A paragraph for each cause; one line where both agree."""
    paint = Painter(colors)
    if not faults:
        return f"\n{paint('the engines agree', 'green')}\n"
    return "".join(f"{line}\n" for line in _faults(faults, paint))


def with_differences(text: str, faults: Sequence[Fault]) -> str:
    """The JSON of a verdict with what engines differ in."""
    said = json.loads(text)
    said["differences"] = [_fault(fault) for fault in faults]
    said["stands"] = said["stands"] and not faults
    return json_text(said) + "\n"
