"""Lint settings of a file: command line, then configuration, then defaults."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass, field, replace
from fnmatch import fnmatch
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..configuration import Configuration
from ..diagnostic import Severity
from ..errors import ConfigError
from ..memo import Memo
from ..rules import FAMILIES, FAMILY_OF, applies_to, get_rule
from ..rules.old_names import resolve_rule, resolve_selectors, resolve_threshold
from ..rules.targets import TARGETS
from ..suggestions import find_nearest as nearest_name
from ..suggestions import suggest_name

if TYPE_CHECKING:
    from ..rules.rule import Rule

_LISTS = ("select", "ignore", "extend-select", "targets")
_KEYS = (*_LISTS, "severity", "per-file-ignores", "variants", "robots", "exclude")
PEDANTIC = "pedantic"
"""Selects every rule, and what is off by default."""
_EVERY = ("all", "ALL", "*", PEDANTIC)
_LEVELS = ("off", "info", "warning", "error")


@dataclass(frozen=True)
class Settings:
    """Lint settings of one file.

    Attributes:
        select: Rule names, prefixes with ``*`` and families; None selects the default rules.
        extend_select: Rules to add to ``select``.
        ignore: Rules to exclude.
        targets: Active targets; None infers them from the file.
        severity: Severity by rule name, overriding that of the rule; None turns the rule off.
        thresholds: Thresholds by rule name.
        memo: Rules to run by targets and tags, computed once.
    """

    select: tuple[str, ...] | None = None
    extend_select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    targets: frozenset[str] | None = None
    severity: Mapping[str, Severity | None] = field(default_factory=dict)
    thresholds: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    memo: Memo = field(default_factory=Memo, init=False, repr=False, compare=False)

    def get_names(self) -> list[str]:
        """Return the selected rules, whether or not they are on for the targets."""
        selected = set(FAMILY_OF) if self.select is None else _expand(self.select)
        selected |= _expand(self.extend_select)
        selected -= _expand(self.ignore)
        return [
            name
            for name in FAMILY_OF
            if name in selected and self.severity.get(name, Severity.INFO) is not None
        ]

    def get_rules(self, targets: frozenset[str], tags: Set[str]) -> list[Rule]:
        """Return the rules to run."""
        chosen = []
        for name in self.get_names():
            if applies_to(name, tags):
                rule = get_rule(name)
                shown = rule.default or self.is_pedantic_on(name)
                if self._is_named(name) or (shown and rule.is_enabled_for(targets)):
                    chosen.append(rule)
        return chosen

    def is_pedantic_on(self, rule: str) -> bool:
        """Tell whether the cases of a rule that are off by default are reported."""
        return self._is_named(rule) or self._is_named(PEDANTIC)

    def _is_named(self, word: str) -> bool:
        return word in self.extend_select or word in (self.select or ())


def _expand(selectors: Iterable[str]) -> set[str]:
    """Return the rule names that selectors denote."""
    names: set[str] = set()
    for selector in selectors:
        if selector in _EVERY:
            names.update(FAMILY_OF)
        elif selector in FAMILIES:
            names.update(name for name, family in FAMILY_OF.items() if family == selector)
        elif selector.endswith("*"):
            names.update(name for name in FAMILY_OF if name.startswith(selector[:-1]))
        else:
            names.add(selector)
    return names


def check_selectors(selectors: Iterable[str], path: str | None = None) -> tuple[str, ...]:
    """Return selectors, split at commas, with the present names of rules.

    Raises:
        ConfigError: A selector denotes no rule; the message suggests the nearest one.
    """
    words = resolve_selectors(
        word.strip() for text in selectors for word in text.split(",") if word.strip()
    )
    for word in words:
        prefix = word[:-1] if word.endswith("*") else None
        if word in FAMILY_OF or word in FAMILIES or word in _EVERY:
            continue
        if prefix is not None and any(name.startswith(prefix) for name in FAMILY_OF):
            continue
        raise ConfigError(
            f"there is no rule '{word}'{suggest_rule(word)}",
            path=path,
            data={"name": word, "suggestion": nearest_name(word, (*FAMILY_OF, *FAMILIES), 0.5)},
        )
    return words


def suggest_rule(word: str) -> str:
    """Return a suggestion of the nearest rule or family, as the end of a message."""
    return suggest_word(word, (*FAMILY_OF, *FAMILIES)) or "; --list-rules lists all rules"


def suggest_word(word: str, known: Iterable[str]) -> str:
    """Return a suggestion of the nearest known word; empty if none is near."""
    return suggest_name(word, known, 0.5)


def check_targets(targets: Iterable[str], path: str | None = None) -> frozenset[str] | None:
    """Return targets, split at commas; None if there are none.

    Raises:
        ConfigError: A target is unknown.
    """
    words = [word.strip() for text in targets for word in text.split(",") if word.strip()]
    for word in words:
        if word not in TARGETS:
            hint = suggest_word(word, TARGETS) or f"; there are {', '.join(TARGETS)}"
            raise ConfigError(f"there is no target '{word}'{hint}", path=path)
    return frozenset(words) if words else None


def read_settings(file: str | Path, configuration: Configuration, line: Settings) -> Settings:
    """Return the settings of a file; those of the command line have priority.

    Raises:
        ConfigError: The configuration has an unknown rule, option or value.
    """
    table = configuration.lint
    if not table:
        return line
    path = configuration.path
    own = _from_table(table, path)
    ignores = _read_per_file_ignores(file, table.get("per-file-ignores", {}), path)
    return replace(
        own,
        select=own.select if line.select is None else line.select,
        extend_select=(*own.extend_select, *line.extend_select),
        ignore=(*own.ignore, *ignores, *line.ignore),
        targets=own.targets if line.targets is None else line.targets,
    )


def _from_table(table: Mapping[str, Any], path: str | None) -> Settings:
    lists: dict[str, list[str]] = {}
    thresholds: dict[str, Mapping[str, Any]] = {}
    for written, value in table.items():
        key = resolve_rule(written)
        if key in _LISTS:
            if not isinstance(value, list) or not all(isinstance(word, str) for word in value):
                raise ConfigError(f"lint.{key} must be a list of names", path=path)
            lists[key] = value
        elif key in FAMILY_OF:
            thresholds[key] = {**thresholds.get(key, {}), **_read_thresholds(key, value, path)}
        elif key not in _KEYS:
            hint = suggest_word(key, (*_KEYS, *FAMILY_OF)) or f"; there are {', '.join(_KEYS)}"
            raise ConfigError(f"there is no option lint.{key}{hint}", path=path)
    return Settings(
        select=check_selectors(lists["select"], path) if "select" in lists else None,
        extend_select=check_selectors(lists.get("extend-select", ()), path),
        ignore=check_selectors(lists.get("ignore", ()), path),
        targets=check_targets(lists.get("targets", ()), path),
        severity=_read_severities(table.get("severity", {}), path),
        thresholds=thresholds,
    )


def _read_severities(table: object, path: str | None) -> dict[str, Severity | None]:
    if not isinstance(table, dict):
        raise ConfigError(
            ("lint.severity must have lines such as zero-effort-limit = 'info'"), path=path
        )
    found: dict[str, Severity | None] = {}
    for selector, level in table.items():
        if level not in _LEVELS:
            hint = suggest_word(str(level), _LEVELS) or f"; there are {', '.join(_LEVELS)}"
            raise ConfigError(f"lint.severity.{selector} is '{level}'{hint}", path=path)
        for name in _expand(check_selectors([selector], path)):
            found[name] = None if level == "off" else Severity[level.upper()]
    return found


def _read_thresholds(name: str, table: object, path: str | None) -> dict[str, Any]:
    known = get_rule(name).thresholds
    if not isinstance(table, dict):
        raise ConfigError(f"lint.{name} must be a table of thresholds", path=path)
    found = {}
    for key, value in table.items():
        parameter = resolve_threshold(name, key).replace("-", "_")
        if parameter not in known:
            names = [k.replace("_", "-") for k in known]
            hint = suggest_word(key, names) or f"; it has {', '.join(names) or 'none'}"
            raise ConfigError(f"{name} has no threshold '{key}'{hint}", path=path)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ConfigError(f"lint.{name}.{key} must be a number", path=path)
        found[parameter] = value
    return found


def _read_per_file_ignores(file: str | Path, table: object, path: str | None) -> tuple[str, ...]:
    if not isinstance(table, dict):
        raise ConfigError(
            ("lint.per-file-ignores must have lines such as 'x/*' = ['mesh']"), path=path
        )
    folder = os.path.dirname(os.path.abspath(path)) if path else os.getcwd()
    relative = os.path.relpath(os.path.abspath(file), folder).replace(os.sep, "/")
    found: list[str] = []
    for pattern, selectors in table.items():
        if not isinstance(selectors, list) or not all(isinstance(w, str) for w in selectors):
            raise ConfigError(
                (f"lint.per-file-ignores.'{pattern}' must be a list of names"), path=path
            )
        names = check_selectors(selectors, path)
        if fnmatch(relative, pattern) or fnmatch(os.path.basename(relative), pattern):
            found.extend(names)
    return tuple(found)
