"""``lint`` of the corpus's URDF files in one command against check_urdf once for each."""

from __future__ import annotations

import csv
import shutil
import subprocess
from collections.abc import Iterator

from .timing import CORPUS, URDFTOOL, in_turn, row, run


def rows() -> Iterator[str]:
    """One row; check_urdf is C++, from Debian's liburdfdom-tools."""
    if not CORPUS.exists() or shutil.which("check_urdf") is None:
        yield f"skipped: needs {CORPUS} and check_urdf (apt-get install liburdfdom-tools)"
        return
    with open(CORPUS / "MANIFEST.tsv") as table:
        manifest = list(csv.DictReader(table, delimiter="\t"))
    files = [str(CORPUS / entry["path"]) for entry in manifest if entry["kind"] == "urdf"]

    def check_each() -> None:
        for file in files:
            subprocess.run(
                ["check_urdf", file],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                check=False,
            )

    medians = in_turn({"urdftool": run([*URDFTOOL, "lint", *files]), "check_urdf": check_each})
    yield row(f"lint of {len(files)} files (at most 2.0)", medians, "urdftool", "check_urdf")
    medians = in_turn(
        {"urdftool": run([*URDFTOOL, "lint", "-j", "1", *files]), "check_urdf": check_each}
    )
    yield row(f"lint -j 1 of {len(files)} files", medians, "urdftool", "check_urdf")
