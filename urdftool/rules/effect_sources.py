"""How the sentences about readers are known: run, or read in the source.

The data beside this module is made by ``python -m tests.effects --write`` of the table in
``fixtures/effects``, and read only where a rule's page is shown.
"""

from __future__ import annotations

import json
from pathlib import Path


def _sources() -> dict[str, dict[str, str]]:
    text = Path(__file__).with_suffix(".json").read_text("utf-8")
    return json.loads(text)  # type: ignore[no-any-return]


def effect_source(rule: str, readers: str) -> str:
    """Return how the effect of a rule on readers is known.

    Args:
        rule: Name of the rule, such as ``zero-axis``.
        readers: The key of the effect, such as ``mujoco, drake``.

    Returns:
        Such as ``run: MuJoCo 4.0.0`` or ``source: REPOSITORY FILE``; empty where it is not known.
    """
    return _sources().get(rule, {}).get(readers, "")
