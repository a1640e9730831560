"""Write ``rules/table.py`` from the decorators of rules: ``python -m tests.rule_table``."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType

import urdftool.rules
from urdftool.rules.rule import FixTraits, Rule

TABLE = Path(urdftool.rules.__file__).with_name("table.py")

_HEAD = '''"""Facts about rules that are known without importing them.

Written by ``python -m tests.rule_table`` from the decorators; not to be edited.
"""

from .fix_traits import BOTH, SAFE, UNSAFE, FixTraits

'''


def modules() -> dict[tuple[str, str], ModuleType]:
    """Import every file of rules, in reading order, by family and file."""
    found = {}
    for family in urdftool.rules.FAMILIES:
        for file in import_module(f"urdftool.rules.{family}").FILES:
            found[family, file] = import_module(f"urdftool.rules.{family}.{file}")
    return found


def rules_in(module: ModuleType) -> list[Rule]:
    """List the rules that a file defines, in the order they are written."""
    found = [value for value in vars(module).values() if isinstance(value, Rule)]
    return [rule for rule in found if rule.check.__module__ == module.__name__]


def _traits(traits: FixTraits) -> str:
    named = {"safe": "SAFE", "unsafe": "UNSAFE", "safe or unsafe": "BOTH"}
    flags = [f"{name}=True" for name, value in traits._asdict().items() if value is True]
    return f"FixTraits({', '.join([named[traits.applicability], *flags])})"


def text() -> str:
    """Get the text of the table."""
    rules: dict[str, dict[str, tuple[str, ...]]] = {}
    applies_to: dict[str, tuple[str, ...]] = {}
    fixes = []
    for (family, file), module in modules().items():
        found = rules_in(module)
        rules.setdefault(family, {})[file] = tuple(rule.name for rule in found)
        if hasattr(module, "APPLIES_TO"):
            applies_to[f"{family}.{file}"] = module.APPLIES_TO
        for rule in found:
            if rule.fix_traits is not None:
                fixes.append((rule.name, rule.fix_traits))
    lines = ",\n".join(f"{name!r}: {_traits(traits)}" for name, traits in fixes)
    raw = (
        f"{_HEAD}RULES: dict[str, dict[str, tuple[str, ...]]] = {rules!r}\n"
        '"""Rules by family and file, in reading order."""\n\n'
        f"APPLIES_TO: dict[str, tuple[str, ...]] = {applies_to!r}\n"
        '"""Elements without which a file of rules finds nothing."""\n\n'
        f"FIXES: dict[str, FixTraits] = {{{lines},}}\n"
        '"""Rules with a fix."""\n'
    )
    formatted = subprocess.run(
        [sys.executable, "-m", "ruff", "format", "-"],
        input=raw.encode(),
        cwd=TABLE.parent,
        capture_output=True,
        check=True,
    )
    return formatted.stdout.decode()


if __name__ == "__main__":
    TABLE.write_text(text(), "utf-8")
