"""Robots before and after ``urdftool bundle``, as seven readers load them.

``python -m measure.benchmarks.bundle FOLDER`` bundles robots of example-robot-data, pybullet_data
and the corpus into FOLDER, moves the bundles, and loads each description with every reader in an
empty environment and another working folder. ``URDFTOOL_YOURDFPY`` is a Python with yourdfpy and
``URDFTOOL_NODE`` a folder with ``npm install urdf-loader three jsdom``.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import cast

import urdftool
from urdftool import cli
from urdftool.bundle.yourdfpy_reader import compare_with_source
from urdftool.model.elements import Link

from . import peers
from .robots import CORPUS, bullet_robots, example_robots, manifest, options_of

READERS = Path(__file__).parent / "bundle_readers"
PEERS = str(peers.FOLDER / "bin" / "python")
YOURDFPY = os.environ.get("URDFTOOL_YOURDFPY", sys.executable)
NODE = os.environ.get("URDFTOOL_NODE", "")
COMMANDS: dict[str, list[str]] = {
    "pinocchio": [PEERS, str(READERS / "load.py"), "pinocchio"],
    "mujoco": [PEERS, str(READERS / "load.py"), "mujoco"],
    "pybullet": [PEERS, str(READERS / "load.py"), "pybullet"],
    "yourdfpy": [YOURDFPY, str(READERS / "load.py"), "yourdfpy"],
    "drake": [PEERS, str(READERS / "load.py"), "drake"],
    "urdf-loader": ["node", str(READERS / "load.mjs"), NODE],
}


def robots() -> list[tuple[Path, list[str]]]:
    """List the descriptions, each with its xacro arguments and options."""
    found = [(path, options_of(path)) for path in (*example_robots(), *bullet_robots())]
    for row in manifest():
        path = CORPUS / row["path"]
        if row["error"] and row["check_urdf_rc"] != "0" and row["kind"] != "xacro":
            continue
        arguments = row["xacro_args"].split() if row["xacro_args"] else []
        found.append((path, [*arguments, "--package-path", str(CORPUS)]))
    return found


def bundle_all(folder: Path, options: Sequence[str] = ()) -> list[dict[str, object]]:
    """Bundle every robot; return the source, the new description and the time of each [s]."""
    rows: list[dict[str, object]] = []
    for number, (path, words) in enumerate(robots()):
        made, moved = folder / "made" / str(number), folder / "moved" / str(number)
        moved.parent.mkdir(parents=True, exist_ok=True)
        start = time.perf_counter()
        code = cli.call(["-q", "bundle", str(path), *words, "-o", str(made), *options])
        row: dict[str, object] = {"source": str(path), "words": words, "code": code}
        row["seconds"] = time.perf_counter() - start
        if code == 0:
            made.rename(moved)
            document = json.loads((moved / "bundle.json").read_text("utf-8"))
            row["bundle"] = str(moved / document["description"])
            row["bytes"] = sum(entry["bytes"] for entry in document["files"])
        rows.append(row)
    return rows


def load_all(reader: str, paths: Sequence[str]) -> dict[str, dict[str, object]]:
    """Load descriptions with a reader in an empty environment; return its answers by path."""
    command = [shutil.which(COMMANDS[reader][0]) or COMMANDS[reader][0], *COMMANDS[reader][1:]]
    done = subprocess.run(
        command,
        input="\n".join(paths) + "\n",
        capture_output=True,
        text=True,
        env={"PATH": "/usr/bin:/bin"},
        cwd="/",
        check=False,
    )
    answers = {}
    for line in done.stdout.splitlines():
        if line.startswith("{"):
            answer = json.loads(line)
            answers[answer.pop("path")] = answer
    return answers


def check_urdf(paths: Sequence[str]) -> dict[str, dict[str, object]]:
    """Load descriptions with check_urdf of urdfdom."""
    program = shutil.which("check_urdf")
    answers: dict[str, dict[str, object]] = {}
    for path in paths if program else ():
        done = subprocess.run(
            [str(program), path], capture_output=True, text=True, env={}, cwd="/", check=False
        )
        answers[path] = {"ok": done.returncode == 0, "why": done.stderr[:300]}
    return answers


def measure(folder: Path, options: Sequence[str]) -> list[dict[str, object]]:
    """Bundle all robots, or return the rows of an earlier run in the folder."""
    known = folder / "rows.json"
    if not known.exists():
        known.write_text(json.dumps(bundle_all(folder, options), indent=1), "utf-8")
    rows: list[dict[str, object]] = json.loads(known.read_text("utf-8"))
    return rows


def has_links(path: str) -> bool:
    """Tell whether a description is a robot; a xacro file of macros has no links."""
    return b"<link" in Path(path).read_bytes()


def read(folder: Path, reader: str, paths: Sequence[str]) -> dict[str, dict[str, object]]:
    """Load all descriptions with a reader, or return the answers of an earlier run."""
    known = folder / f"{reader}.json"
    if not known.exists():
        answers = check_urdf(paths) if reader == "check_urdf" else load_all(reader, paths)
        known.write_text(json.dumps(answers, indent=1), "utf-8")
    found: dict[str, dict[str, object]] = json.loads(known.read_text("utf-8"))
    return found


def load_source(row: dict[str, object]) -> urdftool.Robot:
    """Load the source of a row with its xacro arguments and options."""
    words = [str(word) for word in cast("list[str]", row["words"])]
    paths = [words[i + 1] for i, word in enumerate(words) if word == "--package-path"]
    pairs = [word.partition(":=") for word in words if ":=" in word]
    arguments = {name: value for name, _, value in pairs}
    return urdftool.load(str(row["source"]), args=arguments, package_paths=paths)


def compare_all(rows: Sequence[dict[str, object]]) -> list[str]:
    """Compare each bundle with its source: masses by the model, the rest by yourdfpy."""
    found = []
    for row in rows:
        source, path = load_source(row), Path(str(row["bundle"]))
        bundle = urdftool.load(path)
        if [list_masses(one) for one in source.links] != [list_masses(one) for one in bundle.links]:
            found.append(f"{row['source']}: masses differ")
        found += [f"{row['source']}: {one}" for one in compare_with_source(source, path, path.name)]
    return found


def list_masses(link: Link) -> list[object]:
    """Return the mass properties of a link."""
    inertial = link.inertial
    if inertial is None:
        return []
    origin = inertial.origin
    pose = None if origin is None else (origin.xyz, origin.rpy)
    return [link.name, inertial.mass, pose, inertial.inertia and inertial.inertia.six]


def time_all(rows: Sequence[dict[str, object]], folder: Path) -> list[float]:
    """Return the time of bundle relative to ``cp -r`` of its files plus expand, for each row."""
    command = [sys.executable, "-m", "urdftool", "-q"]
    ratios = []
    for number, row in enumerate(rows):
        words = [str(row["source"]), *cast("list[str]", row["words"])]
        times = []
        for run in range(3):
            target = folder / "timed" / f"{number}_{run}"
            target.parent.mkdir(parents=True, exist_ok=True)
            start = time.perf_counter()
            subprocess.run([*command, "bundle", *words, "-o", str(target)], check=False)
            middle = time.perf_counter()
            subprocess.run(["cp", "-r", str(target), f"{target}_copy"], check=False)
            subprocess.run([*command, "expand", *words, "-o", f"{target}.urdf"], check=False)
            times.append((middle - start, time.perf_counter() - middle))
        bundled, copied = (statistics.median(column) for column in zip(*times, strict=True))
        ratios.append(bundled / copied)
    return ratios


def main(words: list[str]) -> int:
    """Bundle the robots, load them with each reader, and print a table."""
    parser = argparse.ArgumentParser(
        prog="python -m measure.benchmarks.bundle", description=__doc__
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--options", default="", help='options of bundle: "--for mujoco"')
    parser.add_argument("--reader", action="append", choices=("check_urdf", *COMMANDS))
    parser.add_argument("--compare", action="store_true", help="compare bundles with sources")
    parser.add_argument("--time", action="store_true", help="time bundle, cp -r and expand")
    arguments = parser.parse_args(words)
    folder = arguments.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    rows = measure(folder, arguments.options.split())
    written = [row for row in rows if "bundle" in row and has_links(str(row["bundle"]))]
    sources = [str(row["source"]) for row in written]
    bundles = [str(row["bundle"]) for row in written]
    print(f"{len(rows)} descriptions, {len(written)} bundles")
    if arguments.compare:
        found = compare_all(written)
        print(f"{len(written)} compared", *found, sep="\n")
        return 0
    if arguments.time:
        ratios = time_all(written[:: max(1, len(written) // 25)], folder)
        print(f"time of bundle: median {statistics.median(ratios):.2f}, most {max(ratios):.2f}")
        return 0
    for reader in arguments.reader or ("check_urdf", *COMMANDS):
        answers = read(folder, reader, [*sources, *bundles])
        before = sum(bool(answers.get(path, {}).get("ok")) for path in sources)
        after = sum(bool(answers.get(path, {}).get("ok")) for path in bundles)
        print(f"{reader:12} before {before:4}   after {after:4}   of {len(written)}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
