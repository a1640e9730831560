"""Old names of verdict kinds and thresholds, which are still accepted for one release."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

OLD_KINDS: Mapping[str, str] = MappingProxyType(
    {
        "diverged": "blew-up",
        "engine-readback-mismatch": "read-otherwise",
        "ground-penetration": "sank-in",
        "interpenetration": "parts-collide",
        "joint-drift": "sags",
        "mass-outlier": "mass-out-of-line",
        "missing-contact-geometry": "no-contact-shape",
        "no-collision-geometry": "nothing-touches",
        "spawn-penetration": "starts-in-floor",
    }
)
"""Old names of verdict kinds by present ones."""

RENAMED_THRESHOLDS: Mapping[str, str] = MappingProxyType(
    {
        "sag-slide": "joint-drift-slide",
        "sag-turn": "joint-drift-turn",
        "shake-reversals": "oscillation-reversals",
        "shake-slide": "oscillation-slide",
        "shake-turn": "oscillation-turn",
    }
)
"""New keys of thresholds by old ones."""


def find_old_thresholds(table: Mapping[str, object]) -> Iterator[str]:
    """Yield a deprecation warning for each old key of a ``simulate`` table."""
    for key in table:
        if key in RENAMED_THRESHOLDS:
            yield (
                f"threshold 'simulate.{key}' is now 'simulate.{RENAMED_THRESHOLDS[key]}'; the old "
                "name will stop working in the next release"
            )
