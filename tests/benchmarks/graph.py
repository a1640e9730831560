"""``graph`` to PDF of the corpus's largest robots against urdf_to_graphviz, which calls dot."""

from __future__ import annotations

import csv
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from urdftool.errors import UrdftoolError
from urdftool.source.description import read_description
from urdftool.source.expansion import Expansion

from .timing import CORPUS, URDFTOOL, in_turn, row, run

COUNT = 10


def rows() -> Iterator[str]:
    """A row for each robot, and one for all; urdf_to_graphviz is Debian's, and so is dot."""
    if not CORPUS.exists() or not (shutil.which("urdf_to_graphviz") and shutil.which("dot")):
        yield (
            f"skipped: needs {CORPUS}, urdf_to_graphviz and dot "
            "(apt-get install liburdfdom-tools graphviz)"
        )
        return
    total = {"urdftool": 0.0, "urdf_to_graphviz": 0.0}
    with tempfile.TemporaryDirectory() as folder:
        for links, name, path in largest(Path(folder)):
            medians = in_turn(
                {
                    "urdftool": run([*URDFTOOL, "graph", path, "-o", f"{folder}/ours"]),
                    "urdf_to_graphviz": run(["urdf_to_graphviz", path, f"{folder}/theirs"]),
                },
                rounds=7,
            )
            for side, seconds in medians.items():
                total[side] += seconds
            yield row(f"{name}, {links} links", medians, "urdftool", "urdf_to_graphviz")
    yield row("all of them (below 1.0)", total, "urdftool", "urdf_to_graphviz")


def largest(folder: Path) -> list[tuple[int, str, str]]:
    """Links, name and URDF of the largest robots that both sides read.

    Xacro is expanded beforehand for both; of files of one name the largest counts.
    """
    with open(CORPUS / "MANIFEST.tsv") as table:
        manifest = list(csv.DictReader(table, delimiter="\t"))
    found: dict[str, tuple[int, str, str]] = {}
    for entry in manifest:
        words = entry["xacro_args"].split()
        arguments = {name: value for name, _, value in (word.partition(":=") for word in words)}
        try:
            description = read_description(CORPUS / entry["path"], arguments)
        except UrdftoolError:
            continue
        root = description.document.root
        links = sum(1 for _ in root.all("link"))
        name = Path(entry["path"]).name
        if links > found.get(name, (0, "", ""))[0]:
            found[name] = links, name, _urdf(description.expansion, description.path, folder, name)
    accepted = (item for item in sorted(found.values(), reverse=True) if _is_read(item[2], folder))
    return list(islice(accepted, COUNT))


def _is_read(path: str, folder: Path) -> bool:
    command = ["urdf_to_graphviz", path, str(folder / "tried")]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


def _urdf(expansion: Expansion | None, path: str, folder: Path, name: str) -> str:
    if expansion is None:
        return path
    target = folder / f"{name}.urdf"
    target.write_text(expansion.text, "utf-8")
    return str(target)
