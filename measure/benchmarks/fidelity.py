"""What each tool makes of every robot of two packages: the page docs/measurements/fidelity.md.

    pip install -e '.[fidelity]'; make bench-peers
    python -m measure.benchmarks.fidelity [--write] [--only NAME] [--jobs N] [--keep FILE.json]

It takes some minutes. Every file is converted by every tool, and measured by one ruler, which is
none of them: see ``fidelity_engines``. ``--keep`` writes what was measured, and takes from such a
file what is there.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from . import fidelity_page, peers
from .converters import CONVERTERS, Converter
from .robots import bullet_robots, example_folder, example_robots, resolved
from .timing import PYTHON, reason

LIMIT = 180.0


def collections() -> dict[str, dict[str, Path]]:
    """The robots by collection and name."""
    example, bullet = example_folder(), bullet_robots()
    found: dict[str, dict[str, Path]] = {}
    if example is not None:
        root = example / "robots"
        found["example-robot-data"] = {
            path.relative_to(root).as_posix(): path for path in example_robots()
        }
    if bullet:
        data = next(path for path in bullet[0].parents if path.name == "pybullet_data")
        found["pybullet_data"] = {path.relative_to(data).as_posix(): path for path in bullet}
    return found


def measure(path: Path) -> dict[str, dict[str, Any]]:
    """For each tool what the ruler says, or why there is nothing to measure."""
    results: dict[str, dict[str, Any]] = {}
    with tempfile.TemporaryDirectory(prefix="fidelity-") as name:
        folder = Path(name)
        copy = resolved(path, folder / "in")
        files = {}
        for number, converter in enumerate(CONVERTERS):
            if peers.version(converter.package) is None or converter.words(path, folder) is None:
                continue
            out = folder / str(number) / f"x.{'sdf' if converter.form == 'sdf' else 'xml'}"
            out.parent.mkdir()
            results[converter.name] = found = convert(converter, path, copy, out)
            if "why" not in found:
                files[converter.name] = converter.form, out
        measured = _ruled(copy, list(files.values()))
        for name, found in zip(files, measured, strict=True):
            results[name].update(found)
    return results


def convert(converter: Converter, path: Path, copy: Path, out: Path) -> dict[str, Any]:
    """Run a tool; ours with ``--verify``, and past errors of the source where it must."""
    words = converter.words(path if converter.is_ours else copy, out)
    assert words is not None
    done = None
    for more in [["--verify"], ["--verify", "--force"]] if converter.is_ours else [[]]:
        env = {**os.environ, "PYTHONWARNINGS": "ignore"}
        try:
            done = subprocess.run(
                [*words, *more, *(["--format", "json"] if converter.is_ours else [])],
                capture_output=True, text=True, errors="replace", timeout=LIMIT, env=env,
                cwd=out.parent, check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return {"why": f"not done after {LIMIT:.0f} s"}
        if done.returncode in (0, 1) and converter.is_ours:
            return _said(done, forced="--force" in more)
        if done.returncode == 0:
            break
    assert done is not None
    if converter.prints and done.returncode == 0 and "<sdf" in done.stdout:
        out.write_text(done.stdout[done.stdout.index("<sdf") :], "utf-8")
    if done.returncode or not out.exists() or not out.stat().st_size:
        return {"why": reason(done.stderr or done.stdout, done.returncode)}
    return {}


def _said(done: subprocess.CompletedProcess[str], *, forced: bool) -> dict[str, Any]:
    """What our export says of itself: what was lost, and its own verification."""
    told = json.loads(done.stdout)
    losses = [entry for entry in told.get("findings", []) if entry.get("severity") != "info"]
    checks = told.get("checks", [])
    return {
        "forced": forced,
        "losses": sorted({entry["rule"] for entry in losses}),
        "verify": {check["check"]: check["verdict"] for check in checks},
    }


def _ruled(urdf: Path, files: list[tuple[str, Path]]) -> list[dict[str, Any]]:
    """What the engines say of each file; alone where one of several ends the process."""
    if not files:
        return []
    words = [PYTHON, "-W", "ignore", "-m", "measure.benchmarks.fidelity_engines", str(urdf)]
    for form, file in files:
        words += [form, str(file)]
    try:
        done = subprocess.run(
            words, capture_output=True, text=True, cwd=peers.ROOT, timeout=LIMIT, check=False
        )
        lines = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
        code, said = done.returncode, done.stderr
    except subprocess.TimeoutExpired:
        lines, code, said = [], 1, f"not measured after {LIMIT:.0f} s"
    if len(lines) == len(files):
        return lines
    if len(files) > 1:
        return [_ruled(urdf, [file])[0] for file in files]
    return [{"load": f"the engine: {reason(said, code)}"}]


def main(words: list[str]) -> int:
    """Measure all, and print or write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--only", default="", help="robots whose path has this in it")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", type=Path)
    arguments = parser.parse_args(words)
    kept: dict[str, Any] = {}
    if arguments.keep and arguments.keep.exists():
        kept = json.loads(arguments.keep.read_text("utf-8"))
    robots = [
        (f"{collection}/{name}", path)
        for collection, found in collections().items()
        for name, path in found.items()
        if arguments.only in name
    ]
    todo = [(name, path) for name, path in robots if name not in kept]
    with ThreadPoolExecutor(arguments.jobs) as pool:
        results = pool.map(lambda robot: measure(robot[1]), todo)
        for (name, _), found in zip(todo, results, strict=True):
            kept[name] = found
            print(name, file=sys.stderr, flush=True)
            if arguments.keep:
                arguments.keep.write_text(json.dumps(kept), "utf-8")
    text = fidelity_page.page(kept := {name: kept[name] for name, _ in robots})
    if arguments.write:
        page = fidelity_page.PAGE.read_text("utf-8")
        _, mark, part = page.partition("\n<!-- usd ")  # of measure.benchmarks.usd
        fidelity_page.PAGE.write_text(text + mark + part, "utf-8")
        fidelity_page.DATA.write_text(fidelity_page.data(kept), "utf-8")
    else:
        print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
