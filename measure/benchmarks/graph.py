"""``graph`` to PDF against urdf_to_graphviz"""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from urdftool.errors import UrdftoolError
from urdftool.source.description import read_description

from . import peers
from .robots import CORPUS, bullet_robots, example_robots, manifest
from .table import Pairs, Table
from .timing import URDFTOOL, command, in_turn

PEERS = ("urdf_to_graphviz", "dot")
COUNT = 8
ABOUT = """\
Both write a .gv and a .pdf of the largest robots that both read. urdf_to_graphviz is C++ and
starts `dot`; urdftool loads Graphviz into Python."""


def rows() -> Iterator[Table | str]:
    """A row for each robot."""
    theirs = peers.tool("urdf_to_graphviz")
    if theirs is None or peers.tool("dot") is None:
        yield peers.missing("urdf_to_graphviz" if theirs is None else "dot")
        return
    pairs = Pairs("robot", PEERS[:1], extra=["links"])
    with tempfile.TemporaryDirectory() as folder:
        for links, name, path in largest(Path(folder), theirs):
            sides = {
                "urdftool": command([*URDFTOOL, "graph", path, "-o", f"{folder}/ours"]),
                "urdf_to_graphviz": command([theirs, path, f"{folder}/theirs"], cwd=folder),
            }
            pairs.add(name, in_turn(sides, rounds=7, budget=10, label=name), str(links))
    yield pairs.table(
        "What urdftool pays is Python's start and the reading of places for messages; layout and "
        "PDF are Graphviz's on both sides."
    )


def largest(folder: Path, theirs: str) -> list[tuple[int, str, str]]:
    """Links, name and URDF of the largest robots that both sides read.

    Xacro is expanded beforehand for both; of files of one name the largest counts.
    """
    found: dict[str, tuple[int, str, str]] = {}
    for path, arguments in _candidates():
        try:
            description = read_description(path, arguments)
        except UrdftoolError:
            continue
        links = sum(1 for _ in description.document.root.list_children("link"))
        if links <= found.get(path.name, (0, "", ""))[0]:
            continue
        place = description.path
        if description.expansion is not None:
            place = str(folder / f"{path.name}.urdf")
            Path(place).write_text(description.expansion.text, "utf-8")
        found[path.name] = links, path.name, place
    accepted = (i for i in sorted(found.values(), reverse=True) if _reads(theirs, i[2], folder))
    return list(islice(accepted, COUNT))


def _candidates() -> Iterator[tuple[Path, dict[str, str]]]:
    for path in (*example_robots(), *bullet_robots()):
        yield path, {}
    for entry in manifest():
        words = (word.partition(":=") for word in entry["xacro_args"].split())
        yield CORPUS / entry["path"], {name: value for name, _, value in words}


def _reads(theirs: str, path: str, folder: Path) -> bool:
    done = subprocess.run([theirs, path, str(folder / "tried")], capture_output=True, check=False)
    return done.returncode == 0
