"""Old names of rules and of their thresholds, which are still accepted for one release."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from . import FAMILY_OF

RENAMED_RULES: Mapping[str, str] = MappingProxyType(
    {
        "inertia-component-slip": "inertia-component-typo",
        "mass-out-of-line": "mass-outlier",
        "mesh-in-millimetres": "mesh-in-millimeters",
        "mesh-scale-out-of-line": "mesh-scale-outlier",
        "prismatic-in-millimetres": "prismatic-in-millimeters",
        "shape-in-millimetres": "shape-in-millimeters",
    }
)
"""New names of rules by old ones."""

RENAMED_THRESHOLDS: Mapping[str, Mapping[str, str]] = MappingProxyType(
    {
        "mass-outlier": MappingProxyType(
            {
                "denser": "density-ratio",
                "densest": "max-density-ratio",
                "filled": "moment-ratio",
                "fits": "fit-factor",
                "others": "min-links",
            }
        ),
        "stiff-joint-damping": MappingProxyType({"step": "timestep"}),
        "tiny-moving-inertia": MappingProxyType({"step": "timestep"}),
    }
)
"""New keys of thresholds by old ones, by the new name of their rule."""

_FIRST_NAMES = MappingProxyType({new: old for old, new in RENAMED_RULES.items()})


class OldName(NamedTuple):
    """Use of an old name."""

    kind: str
    old: str
    new: str

    @property
    def message(self) -> str:
        """The deprecation warning."""
        return (
            f"{self.kind} '{self.old}' is now '{self.new}'; the old name will stop working in the "
            "next release"
        )


def resolve_rule(name: str) -> str:
    """Resolve an old name of a rule to the present one; other names are returned unchanged."""
    return RENAMED_RULES.get(name, name)


def resolve_selectors(words: Iterable[str]) -> tuple[str, ...]:
    """Resolve old names of rules, and prefixes with ``*`` that only old names have."""
    return tuple(new for word in words for new in _resolve_selector(word))


def _resolve_selector(word: str) -> tuple[str, ...]:
    prefix = word[:-1]
    if not word.endswith("*") or any(name.startswith(prefix) for name in FAMILY_OF):
        return (resolve_rule(word),)
    return tuple(new for old, new in RENAMED_RULES.items() if old.startswith(prefix)) or (word,)


def resolve_threshold(rule: str, key: str) -> str:
    """Resolve an old key of a threshold to the present one.

    Args:
        rule: Present name of the rule.
        key: Key of a configuration file, such as ``density-ratio``.
    """
    return RENAMED_THRESHOLDS.get(rule, {}).get(key, key)


def get_first_name(name: str) -> str:
    """Return the name under which a rule was first released: the identity of its findings."""
    return _FIRST_NAMES.get(name, name)


def find_old_rules(selectors: Iterable[str]) -> Iterator[OldName]:
    """Find the old names of rules in selectors, which may contain several with commas."""
    for text in selectors:
        for word in map(str.strip, text.split(",")):
            present = _resolve_selector(word)
            if present != (word,):
                yield OldName("rule", word, ", ".join(present))


def find_old_names(table: Mapping[str, Any]) -> Iterator[OldName]:
    """Find old names of rules and thresholds in a ``lint`` table; invalid values are ignored."""
    for key, value in table.items():
        yield from find_old_rules([key])
        if key in ("select", "extend-select", "ignore"):
            yield from find_old_rules(_list_texts(value))
        elif isinstance(value, Mapping):
            renamed = RENAMED_THRESHOLDS.get(resolve_rule(key), {})
            for inner, words in value.items():
                if key == "severity":
                    yield from find_old_rules([inner])
                elif key == "per-file-ignores":
                    yield from find_old_rules(_list_texts(words))
                elif inner in renamed:
                    new = f"{resolve_rule(key)}.{renamed[inner]}"
                    yield OldName("threshold", f"{key}.{inner}", new)


def _list_texts(value: object) -> list[str]:
    return [word for word in value if isinstance(word, str)] if isinstance(value, list) else []
