"""The page of benchmarks: a section for each, with its date, versions and machine."""

from __future__ import annotations

import datetime
import os
import re
from collections.abc import Sequence
from pathlib import Path

from . import peers

PAGE = peers.ROOT / "docs" / "measurements" / "benchmarks.md"
FIDELITY = peers.ROOT / "docs" / "measurements" / "fidelity.md"
LINK = "[fidelity](fidelity.md)"

_INSTALLED = re.compile(r"/[^\s'\"]*/site-packages/(?:cmeel\.prefix/share/)?")
"""Where a package happens to be installed, which a message of another tool names."""

HEAD = """\
# Benchmarks

`make bench-peers` installs the other tools from PyPI in an environment of their own. `make bench`
runs all benchmarks in about fifteen minutes and writes this page. `python -m measure.benchmarks
NAME --write` runs one; long ones must be named: {long}.

Every command is a separate process, measured from start to end. Both sides of a row alternate in
one run on the same input; the values are medians. **Ratio** is the time of urdftool divided by
that of the other tool: below 1 urdftool is faster; above 1, in bold, it is slower. Memory is the
peak of the largest process; less than 9 MB is not resolved. Libraries without a command are timed
without their imports, on both sides. No result passes or fails.
"""


def begin(name: str) -> str:
    return f"<!-- {name}: begin -->"


def end(name: str) -> str:
    return f"<!-- {name}: end -->"


def conditions(names: Sequence[str], load: float) -> str:
    """Date, versions, machine and load in a line."""
    found = [(name, peers.version(name)) for name in ("urdftool", *names)]
    versions = ", ".join(f"{name} {number}" for name, number in found if number)
    cores = os.cpu_count() or 1
    busy = f"load {load:.1f} at its start"
    if load > cores:
        busy += f" on {cores} cores: **other work was running**, so take ratios and not seconds"
    elif load > 0.7:
        busy += ": other work took a part of it"
    today = datetime.datetime.now(tz=datetime.timezone.utc).date().isoformat()
    return f"*{today}. {versions}. {peers.machine()}; {busy}.*"


def section(name: str, title: str, about: str, body: str, facts: str) -> str:
    body = _INSTALLED.sub("", body)
    parts = [f"## {title}", about, facts, body]
    return "\n\n".join([begin(name), *(part for part in parts if part), end(name)])


def write(sections: dict[str, str], order: Sequence[str], long: Sequence[str]) -> None:
    """Put sections in their places and leave the others as they are."""
    text = PAGE.read_text("utf-8") if PAGE.exists() else ""
    kept = {}
    for name in order:
        pattern = re.escape(begin(name)) + ".*?" + re.escape(end(name))
        match = re.search(pattern, text, re.DOTALL)
        if name in sections or match:
            kept[name] = sections.get(name) or (match[0] if match else "")
    if not FIDELITY.exists():  # a link to it would lead nowhere
        kept = {n: text.replace(LINK, "`make fidelity`") for n, text in kept.items()}
    head = HEAD.format(long=", ".join(f"`{name}`" for name in long))
    PAGE.write_text("\n\n".join([head.strip(), *kept.values()]) + "\n", "utf-8")


def relative(path: Path) -> str:
    """A file of the project by its path in it."""
    return path.relative_to(peers.ROOT).as_posix() if peers.ROOT in path.parents else path.name
