"""``lint`` against check_urdf and simcheck"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from . import peers
from .robots import CORPUS, FIXTURES, bullet_robots, example_robots, manifest, options_of
from .table import Pairs, Table
from .timing import URDFTOOL, Call, Taken, command, each, in_turn

PEERS = ("check_urdf", "simcheck")
TEN_LINKS = FIXTURES / "robots" / "ten_links.urdf"
ABOUT = """\
check_urdf (C++) parses a file and prints its tree, in one process per file; `simcheck check
--static-only` has 20 checks. urdftool has some 240 rules, reads the meshes, and caches results of
unchanged files."""


def rows() -> Iterator[Table | str]:
    """A row for each pile of files, with and without a cache."""
    pairs = Pairs("files", PEERS)
    for name in PEERS:
        if peers.tool(name) is None:
            yield peers.missing(name)
    with tempfile.TemporaryDirectory() as folder:
        for name, files in _piles():
            add_pile(pairs, name, files, f"{folder}/kept", rounds=9, budget=25, most=12)
        yield pairs.table(
            "check_urdf does far less, in C++: with many files lint is similar only if they are "
            "cached; with one file most of the time is the start of Python."
        )
        yield _keeping(folder)


def add_pile(
    pairs: Pairs, name: str, files: list[Path], kept: str, *, rounds: int, budget: float, most: int
) -> None:
    """Add two rows for a pile of files: nothing kept, and nothing changed.

    Args:
        pairs: The table.
        name: What the rows are called.
        files: The pile.
        kept: A folder for results.
        rounds: As :func:`in_turn`.
        budget: As :func:`in_turn`.
        most: Files that simcheck gets; of more it would take minutes.
    """
    check, simcheck = (peers.tool(tool) for tool in PEERS)
    sides: dict[str, Call] = {
        "urdftool": _lint("--no-cache", files=files),
        "kept": _lint("--cache-dir", kept, files=files),
    }
    if check:
        sides["check_urdf"] = each([command([check, f], codes=range(256)) for f in files])
    taken = in_turn(sides, rounds=rounds, budget=budget, label=name)
    slow: dict[str, Taken] = {}
    if simcheck and len(files) <= most:
        words = [simcheck, "check", "--static-only", "--no-cache", *files]
        slow = in_turn({"simcheck": command(words)}, rounds=3, budget=15)
    unchanged = taken.pop("kept")
    pairs.add(f"{name}, no cache", {**taken, **slow})
    pairs.add(f"{name}, cached", {**taken, **slow, "urdftool": unchanged})


def _lint(*words: str, files: list[Path]) -> Call:
    found = next((options for path in files if (options := options_of(path))), [])
    return command([*URDFTOOL, "lint", *words, *found, *files])


def _piles() -> Iterator[tuple[str, list[Path]]]:
    yield "a small one of 10 links", [TEN_LINKS]
    robots = [*example_robots(), *bullet_robots()]
    yield "10 robots of PyPI", robots[5::9][:10]
    urdf = [CORPUS / entry["path"] for entry in manifest() if entry["kind"] == "urdf"]
    if urdf:
        yield f"{len(urdf)} URDF files of the tests' collection", urdf


def _keeping(folder: str) -> str:
    """What it costs to keep the result of one file."""
    new = f"{folder}/new"
    keeping = command([*URDFTOOL, "lint", "--cache-dir", new, TEN_LINKS])

    def fresh() -> Taken:
        shutil.rmtree(new, ignore_errors=True)
        return keeping()

    plain = command([*URDFTOOL, "lint", "--no-cache", TEN_LINKS])
    taken = in_turn({"keeping": fresh, "plain": plain}, rounds=15, budget=10, label="cache")
    ratio = taken["keeping"].seconds / taken["plain"].seconds
    return f"To keep a small file's result for the next time takes {ratio:.2f} of `--no-cache`."
