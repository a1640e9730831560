"""``lint`` of the corpus's URDF files in one command, against check_urdf and simcheck.

check_urdf is C++, from Debian's liburdfdom-tools, run once for each file. simcheck is from PyPI; it
wants an environment of its own (``python -m venv V; V/bin/pip install simcheck``), and ``SIMCHECK``
says where it is: ``SIMCHECK=V/bin/simcheck python -m tests.benchmarks lint``.
"""

from __future__ import annotations

import csv
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from .timing import CORPUS, URDFTOOL, in_turn, row, run

TEN_LINKS = Path(__file__).parents[2] / "fixtures" / "robots" / "ten_links.urdf"


def rows() -> Iterator[str]:
    """A row a pair; what is missing is said."""
    if not CORPUS.exists():
        yield f"skipped: needs {CORPUS}"
        return
    with open(CORPUS / "MANIFEST.tsv") as table:
        manifest = list(csv.DictReader(table, delimiter="\t"))
    files = [str(CORPUS / entry["path"]) for entry in manifest if entry["kind"] == "urdf"]
    with tempfile.TemporaryDirectory() as folder:
        if shutil.which("check_urdf") is None:
            yield "check_urdf is not there (apt-get install liburdfdom-tools)"
        else:
            yield from _beside_check_urdf(files, folder)
        simcheck = os.environ.get("SIMCHECK") or shutil.which("simcheck")
        if simcheck is None:
            yield "simcheck is not there; SIMCHECK says where it is"
        else:
            yield from _beside_simcheck(files[5::9][:10], simcheck)
        yield from _of_one(folder)


def _beside_check_urdf(files: list[str], folder: str) -> Iterator[str]:
    def check_each() -> None:
        for file in files:
            subprocess.run(
                ["check_urdf", file],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                check=False,
            )

    plain = [*URDFTOOL, "lint", "--no-cache"]
    kept = [*URDFTOOL, "lint", "--cache-dir", f"{folder}/kept"]
    number = f"{len(files)} files"
    for what, command in (
        (f"lint of {number}, no cache (at most 4.0)", plain),
        (f"lint of {number}, nothing changed (at most 1.0)", kept),
        (f"lint -j 1 of {number}, no cache", [*plain, "-j", "1"]),
    ):
        medians = in_turn({"urdftool": run([*command, *files]), "check_urdf": check_each})
        yield row(what, medians, "urdftool", "check_urdf")


def _beside_simcheck(files: list[str], simcheck: str) -> Iterator[str]:
    medians = in_turn(
        {
            "urdftool": run([*URDFTOOL, "lint", "--no-cache", *files]),
            "simcheck": run([simcheck, "check", "--static-only", "--no-cache", *files]),
        },
        rounds=3,
    )
    yield row(f"lint of {len(files)} files (at most 0.05)", medians, "urdftool", "simcheck")


def _of_one(folder: str) -> Iterator[str]:
    """One small file: with nothing kept, to be kept, and kept."""
    new, kept = f"{folder}/new", f"{folder}/one"
    sides: dict[str, Callable[[], None]] = {
        "kept": run([*URDFTOOL, "lint", "--cache-dir", kept, str(TEN_LINKS)]),
        "keeping": _fresh(new, run([*URDFTOOL, "lint", "--cache-dir", new, str(TEN_LINKS)])),
        "--no-cache": run([*URDFTOOL, "lint", "--no-cache", str(TEN_LINKS)]),
    }
    medians = in_turn(sides)
    for side in ("kept", "keeping"):
        yield row("lint of one small file", medians, side, "--no-cache")


def _fresh(folder: str, call: Callable[[], None]) -> Callable[[], None]:
    def with_nothing() -> None:
        shutil.rmtree(folder, ignore_errors=True)
        call()

    return with_nothing
