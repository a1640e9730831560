"""Get the evidence for sentences about readers: runs, or their source code.

``python -m tests.effects --write`` writes the data next to this module from the table in
``fixtures/effects``; it is read only to show the page of a rule.
"""

from __future__ import annotations

import json
from pathlib import Path


def _load_sources() -> dict[str, dict[str, str]]:
    text = Path(__file__).with_suffix(".json").read_text("utf-8")
    return json.loads(text)  # type: ignore[no-any-return]


def get_effect_source(rule: str, readers: str) -> str:
    """Get the evidence for the effect of a rule on readers.

    Args:
        rule: Name of the rule, such as ``zero-axis``.
        readers: The key of the effect, such as ``mujoco, drake``.

    Returns:
        Such as ``run: MuJoCo 4.0.0`` or ``source: REPOSITORY FILE``; empty if there is none.
    """
    return _load_sources().get(rule, {}).get(readers, "")
