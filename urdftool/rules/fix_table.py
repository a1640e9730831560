"""Fixes that do not stand beside their rules yet, by the file in ``fixes``."""

from __future__ import annotations

from .rule import BOTH, SAFE, UNSAFE

FIXES: dict[str, dict[str, str]] = {
}
"""Applicability by rule, by the file in ``fixes``."""

FIX_FILE = {rule: file for file, rules in FIXES.items() for rule in rules}
"""The file in ``fixes`` by rule."""
