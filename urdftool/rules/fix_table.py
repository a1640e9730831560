"""Fixes that do not stand beside their rules yet, by the file in ``fixes``."""

from __future__ import annotations

from .rule import BOTH, SAFE, UNSAFE

FIXES: dict[str, dict[str, str]] = {
    "inertia": {
        "missing-inertial": UNSAFE,
        "massless-moving-body": UNSAFE,
        "preserved-joint-massless": UNSAFE,
        "root-link-has-inertia": UNSAFE,
        "incomplete-inertial": UNSAFE,
        "negative-mass": UNSAFE,
        "inertia-not-positive-definite": UNSAFE,
        "inertia-triangle-inequality": UNSAFE,
        "inertia-triangle-inequality-rounding": UNSAFE,
        "zero-inertia": UNSAFE,
        "singular-inertia": UNSAFE,
        "inertia-component-slip": UNSAFE,
        "inertia-off-by-power-of-ten": UNSAFE,
        "redundant-inertia-attributes": SAFE,
        "placeholder-inertia": UNSAFE,
        "inertia-exceeds-geometry": UNSAFE,
        "inertial-not-at-com-suspect": UNSAFE,
        "inertia-about-link-frame": UNSAFE,
        "com-not-mirrored": UNSAFE,
        "radius-of-gyration": UNSAFE,
    },
}
"""Applicability by rule, by the file in ``fixes``."""

FIX_FILE = {rule: file for file, rules in FIXES.items() for rule in rules}
"""The file in ``fixes`` by rule."""
