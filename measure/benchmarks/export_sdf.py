"""How faithful `urdftool export sdf` is, and how fast: the table of docs/formats/sdf.md.

    python measure/benchmarks/export_sdf.py [--write docs/formats/sdf.md] [--only NAME]

It wants pin, drake and example-robot-data from PyPI, and asks `ign sdf -k` or `gz sdf -k` where
there is one. Exports are made with --force: what that passed over is announced, and counted so.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import replace
from importlib import metadata
from pathlib import Path

import numpy as np
from sdf_engines import Source, State, Target

from urdftool.compare.check import WITHOUT_DIFFERENCE, is_faithful
from urdftool.errors import UrdftoolError
from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.verify.compare import Pair, compare, read_pair
from urdftool.formats.sdf.verify.loader import run_loads
from urdftool.formats.sdf.write import write
from urdftool.model.elements import Dynamics, Joint, Limit, Robot
from urdftool.model.load import load
from urdftool.refusal import Refused

CONFIGURATIONS = 10
COLUMNS = (
    "written", "without --force", "ign sdf -k at 1.9", "Drake", "frames ≤ 1e-9",
    "mass matrix ≤ 1e-8", "weight ≤ 1e-8", "mass, center, inertia", "limits", "shapes", "all equal",
    "unannounced",
)  # fmt: skip
BEGIN, END = "<!-- fidelity: begin -->", "<!-- fidelity: end -->"


def robots() -> list[Path]:
    """The descriptions of example-robot-data that have a link."""
    files = metadata.distribution("example-robot-data").files or ()
    found = [Path(str(file.locate())) for file in files if file.suffix == ".urdf"]
    return sorted(path for path in found if b"<link" in path.read_bytes())


def measure(path: Path, mode: str, folder: Path) -> dict[str, bool | str]:
    """Every column for one robot."""
    robot = load(path, package_paths=[path.parents[3].parent])
    row: dict[str, bool | str] = {}
    written = None
    options = Options(version="1.12", fixed_joints=mode, uri="file", file="robot.sdf")
    try:
        written = write(robot, options)
        row["without --force"] = True
    except Refused:
        options = replace(options, force=True)
        written = write(robot, options)
    row["written"] = True
    place = folder / "robot.sdf"
    place.write_bytes(written.files["robot.sdf"])  # type: ignore[arg-type]
    pair = read_pair(robot, written, place, options)
    own = compare(pair)
    row["shapes"] = all(
        c.verdict in WITHOUT_DIFFERENCE for c in own if c.name in ("collisions", "visuals")
    )
    row["own"] = all(check.verdict in WITHOUT_DIFFERENCE for check in own)
    row["unannounced"] = not is_faithful(own)
    row["ign sdf -k at 1.9"] = _loads(robot, options, folder)
    _engines(path, pair, place, row)
    kinds = [name for name in COLUMNS[3:10] if not row.get(name)]
    row["all equal"] = bool(row["own"]) and not kinds
    row["why"] = ", ".join(
        dict.fromkeys(
            [t for c in own for t in (*c.differing, *c.announced)][:2]
            + [f"{kind} (engines)" for kind in kinds if row["own"]]
        )
    )
    return row


def _loads(robot: Robot, options: Options, folder: Path) -> bool:
    old = replace(options, version="1.9")
    place = folder / "old.sdf"
    place.write_bytes(write(robot, old).files["robot.sdf"])  # type: ignore[arg-type]
    check = run_loads(robot, old, place)
    return check is not None and check.verdict in WITHOUT_DIFFERENCE


def _engines(path: Path, pair: Pair, place: Path, row: dict[str, bool | str]) -> None:
    source = Source(path)
    root = pair.robot.tree.root
    assert root is not None
    base = "world" if root.name == "world" else _rename(pair, "link", root.name)
    try:
        target = Target(place, base)
    except RuntimeError as error:
        row["why"] = str(error)[:100]
        return
    row["Drake"] = True
    names = [name for name in source.names if _rename(pair, "joint", name) in target.joints]
    links = [link.name for link in pair.robot.links]
    worst: Counter[str] = Counter()
    for q in source.configurations(CONFIGURATIONS):
        one = source.state(q, names)
        two = target.state(
            {_rename(pair, "joint", name): value for name, value in q.items()},
            [_rename(pair, "joint", name) for name in names],
            [_rename(pair, "link", name) for name in links],
        )
        _compare(pair, one, two, links, worst)
    row["frames ≤ 1e-9"] = worst["frames"] <= 1e-9
    row["mass matrix ≤ 1e-8"] = worst["mass matrix"] <= 1e-8
    row["weight ≤ 1e-8"] = worst["weight"] <= 1e-8
    row["mass, center, inertia"] = (
        worst["mass"] <= 1e-12 and worst["centre"] <= 1e-9 and worst["inertia"] <= 1e-8
    )
    made = {joint.name: joint for joint in pair.result.joints}
    row["limits"] = len(names) == len(source.names) and all(
        _same_limits(source.limits(name), made[_rename(pair, "joint", name)].limit)
        for name in names
    )


def _rename(pair: Pair, kind: str, name: str) -> str:
    """Return the name of a link or joint in the exported file."""
    return pair.claims.renamed.get((kind, name), name)


def _compare(pair: Pair, one: State, two: State, links: list[str], worst: Counter[str]) -> None:
    def see(what: str, off: float) -> None:
        worst[what] = max(worst[what], off)  # type: ignore[assignment]

    for name in links:
        if name == "world" and name not in two.frames:
            continue
        there = two.frames.get(_rename(pair, "link", name))
        off = np.inf if there is None else np.abs(one.frames[name] - there).max()
        see("frames", float(off))
    if len(one.weight):
        diagonal = np.diag(one.mass_matrix)
        diagonal = np.maximum(diagonal, 1e-6 * diagonal.max())
        scale = np.sqrt(np.outer(diagonal, diagonal))
        see("mass matrix", float((np.abs(one.mass_matrix - two.mass_matrix) / scale).max()))
        heaviest = max(np.abs(one.weight).max(), 1e-6 * one.mass * 9.81)
        see("weight", float(np.abs(one.weight - two.weight).max() / heaviest))
    see("mass", abs(one.mass - two.mass) / max(one.mass, 1e-30))
    see("centre", float(np.abs(one.center - two.center).max()))
    size = max(float(np.abs(one.inertia).max()), 1e-30)
    see("inertia", float(np.abs(one.inertia - two.inertia).max()) / size)


def _get_limits(joint: Joint) -> dict[str, float]:
    limit, dynamics = joint.limit or Limit(None), joint.dynamics or Dynamics(None)
    return {
        "lower": -np.inf if limit.lower is None else limit.lower,
        "upper": np.inf if limit.upper is None else limit.upper,
        "effort": np.inf if limit.effort is None else limit.effort,
        "velocity": np.inf if limit.velocity is None else limit.velocity,
        "damping": dynamics.damping or 0.0,
        "friction": dynamics.friction or 0.0,
    }


def _same_limits(one: dict[str, float], two: dict[str, float]) -> bool:
    def plain(value: float) -> float:
        return float(np.sign(value) * np.inf) if abs(value) >= 1e15 else value

    return all(
        plain(value) == plain(two[name])
        or abs(value - two[name]) <= 1e-9 * max(abs(value), abs(two[name]))
        for name, value in one.items()
    )


def fidelity(only: str) -> str:
    """The table, kept and lumped."""
    lines = ["| robots | fixed joints | " + " | ".join(COLUMNS) + " |"]
    lines.append("|---" * (len(COLUMNS) + 2) + "|")
    remarks = []
    paths = [path for path in robots() if only in path.as_posix()]
    for mode in ("keep", "lump"):
        counts: Counter[str] = Counter()
        for path in paths:
            with tempfile.TemporaryDirectory() as folder:
                try:
                    row = measure(path, mode, Path(folder))
                except UrdftoolError as error:
                    row = {"why": str(error)}
            counts.update(name for name in COLUMNS if row.get(name))
            name = f"{path.parents[1].name}/{path.stem}"
            print(f"{mode} {name}: {row.get('why') or 'equal'}", file=sys.stderr)
            if not row.get("all equal"):
                remarks.append(f"- {mode}, `{name}`: {row.get('why')}")
        cells = " | ".join(str(counts[name]) for name in COLUMNS)
        lines.append(f"| {len(paths)} | {mode} | {cells} |")
    return "\n".join([*lines, "", "What differs:", "", *remarks])


def speed() -> str:
    """Seconds for one robot from the shell, beside ign sdf -p, and for all in one process."""
    paths = robots()
    tool = shutil.which("urdftool", path=str(Path(sys.executable).parent)) or "urdftool"
    one = next(path for path in paths if path.name == "ur5_robot.urdf")
    share = one.parents[3].parent
    with tempfile.TemporaryDirectory() as folder:
        command = [tool, "-q", "export", "sdf", str(one), "-o", f"{folder}/x.sdf",
                   "--uri", "package", "--package-path", str(share), "--force"]  # fmt: skip
        ours = _seconds(command)
        python = _seconds([sys.executable, "-c", "pass"])
        lines = [
            "| what | seconds |",
            "|---|---|",
            f"| `urdftool export sdf {one.name}` | {ours:.2f} |",
            f"| Python alone | {python:.2f} |",
        ]
        if shutil.which("ign"):
            theirs = _seconds(["ign", "sdf", "-p", str(one)])
            lines.append(f"| `ign sdf -p {one.name}` | {theirs:.2f} |")
        begin = time.perf_counter()
        for path in paths:
            robot = load(path, package_paths=[share])
            write(robot, Options(uri="package", force=True, file="x.sdf"))
        together = time.perf_counter() - begin
        begin = time.perf_counter()
        for path in paths:
            command[4] = str(path)
            subprocess.run(command, capture_output=True, check=False)
        apart = time.perf_counter() - begin
    lines.append(f"| {len(paths)} robots in one process | {together:.2f} |")
    lines.append(f"| {len(paths)} robots, one process each | {apart:.2f} |")
    return "\n".join(lines)


def _seconds(command: list[str], times: int = 7) -> float:
    taken = []
    for _ in range(times):
        begin = time.perf_counter()
        subprocess.run(command, capture_output=True, check=False)
        taken.append(time.perf_counter() - begin)
    return sorted(taken)[times // 2]


def main() -> None:
    """Measure, print, and write into the page where that is wanted."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", type=Path, help="the page whose table is replaced")
    parser.add_argument("--only", default="", help="robots whose path has this in it")
    parser.add_argument("--no-speed", action="store_true")
    arguments = parser.parse_args()
    text = fidelity(arguments.only)
    if not arguments.no_speed:
        text += "\n\n" + speed()
    print(text)
    if arguments.write:
        page = arguments.write.read_text()
        head, _, rest = page.partition(BEGIN)
        _, _, tail = rest.partition(END)
        arguments.write.write_text(f"{head}{BEGIN}\n\n{text}\n\n{END}{tail}")


if __name__ == "__main__":
    main()
