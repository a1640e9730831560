"""Fixes that do not stand beside their rules yet, by the file in ``fixes``."""

from __future__ import annotations

from .rule import BOTH, SAFE, UNSAFE

FIXES: dict[str, dict[str, str]] = {
    "joint": {
        "unknown-joint-type": UNSAFE,
        "redundant-on-fixed": SAFE,
        "axis-not-unit": UNSAFE,
        "axis-omitted": SAFE,
        "axis-nearly-canonical": UNSAFE,
        "rpy-in-degrees": UNSAFE,
        "missing-limit": UNSAFE,
        "limit-without-effort-or-velocity": BOTH,
        "limit-without-bounds": UNSAFE,
        "continuous-with-bounds": UNSAFE,
        "lower-above-upper": UNSAFE,
        "locked-by-limits": UNSAFE,
        "limit-in-degrees": UNSAFE,
        "prismatic-in-millimetres": UNSAFE,
        "limit-rounded-outward": UNSAFE,
        "negative-limit": UNSAFE,
        "negative-dynamics": UNSAFE,
        "empty-dynamics": SAFE,
        "dynamics-as-child-elements": UNSAFE,
        "mimic-unknown-joint": UNSAFE,
        "mimic-chain": UNSAFE,
        "mimic-limits-inconsistent": UNSAFE,
        "soft-limits-lock-joint": UNSAFE,
        "soft-limits-outside-hard": UNSAFE,
    },
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
