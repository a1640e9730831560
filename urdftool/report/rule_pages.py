"""Page of a rule, from its docstring and its decorator."""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ..errors import ConfigError
from ..lint.settings import suggest_rule
from ..rules import FAMILY_OF, get_all_rules, get_rule
from ..rules.old_names import resolve_rule
from ..rules.rule import Rule
from ..rules.table import FIXES
from .json_text import format_json


def format_rule_list() -> str:
    """Format a line for each rule: family, name, severity and fact."""
    width = max(map(len, FAMILY_OF))
    lines = []
    family = ""
    for rule in get_all_rules():
        if rule.family != family:
            family = rule.family
            lines.append(f"{family}:")
        off = "" if rule.default else " (off)"
        fix = f" [fix: {FIXES[rule.name].applicability}]" if rule.name in FIXES else ""
        fact = remove_markup(rule.fact)
        lines.append(f"  {rule.name:<{width}}  {rule.severity.label:<7}  {fact}{off}{fix}")
    return "\n".join(lines) + "\n"


def format_page(name: str) -> str:
    """Format the page of a rule, by its present or old name, as plain text.

    Raises:
        ConfigError: There is no such rule.
    """
    rule = _find_rule(name)
    text = remove_markup(inspect.cleandoc(rule.check.__doc__ or ""))
    lines = [f"{rule.name} ({rule.family})", "", text, ""]
    lines.extend(f"{label}: {value}" for label, value in get_facts(rule))
    if rule.effects:
        lines.append("What readers do:")
        for readers, effect in rule.effects.items():
            lines.append(f"  {readers}: {effect}")
            if known := get_effect_source(rule.name, readers):
                lines.append(f"    [{known}]")
    return "\n".join(lines) + "\n"


def format_pages_as_json(names: Iterable[str]) -> str:
    """Format the pages of rules as one object; the schema is ``docs/schemas/rules.json``.

    Raises:
        ConfigError: There is no such rule.
    """
    records = [_build_page(_find_rule(name)) for name in names]
    return format_json({"version": 1, "rules": records}, 1) + "\n"


def _build_page(rule: Rule) -> dict[str, Any]:
    """Return the JSON form of a rule's page."""
    fix = FIXES.get(rule.name)
    return {
        "rule": rule.name,
        "family": rule.family,
        "fact": remove_markup(rule.fact),
        "page": remove_markup(inspect.cleandoc(rule.check.__doc__ or "")),
        "severity": rule.severity.label,
        "severity_for": {target: raised.label for target, raised in rule.raised.items()},
        "on_by_default": rule.default,
        "targets": None if rule.on is None else list(rule.on),
        "fixes": [] if fix is None else fix.applicability.split(" or "),
        "thresholds": {
            name.replace("_", "-"): default for name, default in rule.thresholds.items()
        },
        "effects": [
            {
                "readers": [reader.strip() for reader in readers.split(",")],
                "effect": effect,
                "evidence": get_effect_source(rule.name, readers) or None,
            }
            for readers, effect in rule.effects.items()
        ],
    }


def _find_rule(name: str) -> Rule:
    """Return a rule by its present or old name; raise :class:`ConfigError` if there is none."""
    name = resolve_rule(name)
    if name not in FAMILY_OF:
        raise ConfigError(f"no rule is called '{name}'{suggest_rule(name)}")
    return get_rule(name)


def remove_markup(text: str) -> str:
    """Remove the marks of code and of cross-references from a docstring."""
    return re.sub(r":\w+:`~?(?:[\w.]*\.)?(\w+)`", r"\1", text).replace("``", "")


def get_facts(rule: Rule) -> list[tuple[str, str]]:
    """Return severity, targets and thresholds as labeled texts."""
    severity = rule.severity.label
    for target, raised in rule.raised.items():
        severity += f"; {raised.label} for {target}"
    on = "always" if rule.on is None else "for " + ", ".join(rule.on)
    if not rule.default:
        on = f"when selected (--extend-select {rule.name})"
    facts = [("Severity", severity), ("On", on)]
    if rule.pedantic:
        facts.append(("Off by default", f"{rule.pedantic} (--extend-select {rule.name})"))
    if rule.infos and rule.default:
        facts.append(("Infos", "on by default"))
    if rule.name in FIXES:
        facts.append(("Fix", FIXES[rule.name].described))
    for threshold, default in rule.thresholds.items():
        facts.append(("Threshold", f"{threshold.replace('_', '-')} = {default:g}"))
    return facts


def _load_sources() -> dict[str, dict[str, str]]:
    text = (Path(__file__).parents[1] / "rules" / "effect_sources.json").read_text("utf-8")
    return json.loads(text)  # type: ignore[no-any-return]


def get_effect_source(rule: str, readers: str) -> str:
    """Get the evidence for the effect of a rule on readers.

    Returns:
        Such as ``run: MuJoCo 4.0.0`` or ``source: REPOSITORY FILE``; empty if there is none.
    """
    return _load_sources().get(rule, {}).get(readers, "")
