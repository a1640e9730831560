"""Conversions to USD as Newton imports them, beside those of other converters.

    python -m tests.benchmarks.usd [--write] [--only NAME] [--keep FILE.json]

It runs where usd-core and Newton are installed. The other converters are in environments of their
own, named by URDFTOOL_USD_CONVERTER, URDFTOOL_URDF2ANY and URDFTOOL_SKROBOT; one that is not named
is left out. Each robot is converted to a folder of its own, and Newton imports the stage on the
processor. The reference is the description itself, by ``urdftool.formats.mechanics``. ``--write``
replaces the part of docs/fidelity.md between the marks.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np

import urdftool
from urdftool.errors import UrdftoolError
from urdftool.formats.mechanics import Mechanics, get_origin_matrix
from urdftool.model.elements import Link, Robot
from urdftool.model.kinematics import add_mimic_positions, get_limits

from .robots import bullet_robots, example_folder, example_robots, resolved

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "fidelity.md"
BEGIN, END = "<!-- usd begins -->", "<!-- usd ends -->"
LIMIT = 120.0
ROWS = ("mass", "center", "inertia", "frames", "joints", "limits", "effort", "velocity",
        "friction, damping", "mimic", "colliders")  # fmt: skip
TOLERANCE = 1e-5
"""Relative; poses and centers of mass in meters, for a link below n others n times as much."""


class Converter(NamedTuple):
    """A converter: its name, and the command that writes a stage into a folder."""

    name: str
    command: Callable[[Path, Path], list[str]]


def ours(urdf: Path, folder: Path) -> list[str]:
    """Return our command."""
    packages = example_folder()
    more = ["--package-path", str(packages.parent)] if packages else []
    return [sys.executable, "-m", "urdftool", "export", "usd", str(urdf), "-o",
            str(folder / "robot.usdc"), "--fix-inertia", "lift", "--force",
            "--format", "json", *more]  # fmt: skip


def converters() -> Iterator[Converter]:
    """Yield the converters that are installed."""
    yield Converter("urdftool", ours)
    places = {name: os.environ.get(name) for name in
              ("URDFTOOL_USD_CONVERTER", "URDFTOOL_URDF2ANY", "URDFTOOL_SKROBOT")}  # fmt: skip
    if place := places["URDFTOOL_USD_CONVERTER"]:
        program = f"{place}/bin/urdf_usd_converter"
        yield Converter(
            "urdf-usd-converter",
            lambda urdf, folder: [program, str(urdf), str(folder), "--no-layer-structure"],
        )
    if place := places["URDFTOOL_URDF2ANY"]:
        tool = f"{place}/bin/urdf2any"
        yield Converter(
            "urdf2any",
            lambda urdf, folder: [tool, str(urdf), "-o", str(folder / "r.usda"), "--fix-base"],
        )
    if place := places["URDFTOOL_SKROBOT"]:
        skrobot = f"{place}/bin/convert-urdf-to-usd"
        yield Converter(
            "scikit-robot",
            lambda urdf, folder: [skrobot, str(urdf), "-o", str(folder / "r.usdc")],
        )


def main(words: list[str]) -> int:
    """Measure all robots, and print or write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--keep", type=Path)
    arguments = parser.parse_args(words)
    import_module("newton")  # it registers its schemas, which must precede the first stage
    kept: dict[str, Any] = {}
    if arguments.keep and arguments.keep.exists():
        kept = json.loads(arguments.keep.read_text("utf-8"))
    found = [*example_robots(), *bullet_robots()]
    for path in found:
        name = "/".join(path.parts[-3:])
        if arguments.only in name and name not in kept:
            kept[name] = measure(path)
            print(name, {k: v.get("wrong", v.get("why")) for k, v in kept[name].items()},
                  file=sys.stderr, flush=True)  # fmt: skip
            if arguments.keep:
                arguments.keep.write_text(json.dumps(kept), "utf-8")
    text = format_part(kept)
    if arguments.write:
        page = PAGE.read_text("utf-8")
        if BEGIN in page:
            page = page[: page.index(BEGIN)] + page[page.index(END) + len(END) :].lstrip("\n")
        PAGE.write_text(page.rstrip("\n") + f"\n\n{BEGIN}\n{text}{END}\n", "utf-8")
    else:
        print(text)
    return 0


def measure(path: Path) -> dict[str, dict[str, Any]]:
    """Convert a robot with each converter, and compare what Newton imports."""
    packages = example_folder()
    try:
        robot = urdftool.load(path, package_paths=[packages.parent] if packages else [])
        Mechanics(robot)
        assert len(robot.tree.roots) == 1
    except (UrdftoolError, AssertionError):
        return {}
    results = {}
    for converter in converters():
        with TemporaryDirectory(prefix="usd-") as folder:
            results[converter.name] = _measure_one(converter, robot, path, Path(folder))
    return results


def _measure_one(converter: Converter, robot: Robot, path: Path, folder: Path) -> dict[str, Any]:
    urdf = path if converter.command is ours else resolved(path, folder / "in")
    out = folder / "out"
    out.mkdir()
    start = time.perf_counter()
    try:
        done = subprocess.run(converter.command(urdf, out), capture_output=True, text=True,
                              check=False, timeout=LIMIT, cwd=folder)  # fmt: skip
    except subprocess.TimeoutExpired:
        return {"why": "time"}
    seconds = time.perf_counter() - start
    stages = [p for p in out.iterdir() if p.suffix in (".usd", ".usda", ".usdc")]
    if not stages:
        last = (done.stderr or done.stdout).strip().splitlines()[-1:]
        return {"why": f"no stage: {last[0][:160] if last else ''}"}
    losses = []
    if converter.command is ours:
        report = json.loads(done.stdout)
        losses = [f["rule"] for f in report.get("findings", []) if f["severity"] != "info"]
    wrong = compare(robot, stages[0])
    size = sum(p.stat().st_size for p in out.rglob("*") if p.is_file())
    return {**wrong, "losses": sorted(set(losses)), "seconds": seconds, "size": size}


def compare(robot: Robot, stage: Path) -> dict[str, Any]:
    """Compare a robot and Newton's import of a stage; return the rows that differ."""
    from urdftool.formats.usd.newton_child import read_stage

    links, joints = find_names(robot, stage)
    chance = np.random.default_rng(27)
    movable = Mechanics(robot).joints
    configurations = [dict.fromkeys((joint.name for joint in movable), 0.0)]
    for _ in range(5):
        values = {}
        for joint in movable:
            lower, upper = (max(min(bound, 3.0), -3.0) for bound in get_limits(joint))
            values[joint.name] = float(chance.uniform(lower, max(lower, upper)))
        configurations.append(values)
    configurations = [add_mimic_positions(robot, values) for values in configurations]
    label = {name: path for path, name in joints.items()}
    asked = [{label[n]: v for n, v in q.items() if n in label} for q in configurations]
    answer = read_stage(str(stage), asked)
    if "error" in answer:
        return {"why": f"Newton: {answer['error'][:160]}"}
    wrong = {}
    for name, (bad, count) in _compare_all(robot, answer, links, joints, configurations).items():
        if bad:
            wrong[name] = [bad, count]
    return {"wrong": wrong}


def find_names(robot: Robot, stage: Path) -> tuple[dict[str, str], dict[str, str]]:
    """Return links and joints by the paths of their prims, by any name that a converter stores."""
    from pxr import Usd, UsdPhysics

    opened = Usd.Stage.Open(str(stage))
    by_name = {"link": {}, "joint": {}}
    for kind, names in (("link", robot.link), ("joint", robot.joint)):
        for name in names:
            by_name[kind][name] = name
            by_name[kind].setdefault(re.sub(r"\W", "_", name, flags=re.ASCII), name)
    found: dict[str, dict[str, str]] = {"link": {}, "joint": {}}
    for prim in opened.Traverse():
        kind = "joint" if prim.IsA(UsdPhysics.Joint) else "link"
        if kind == "link" and not prim.HasAPI(UsdPhysics.RigidBodyAPI):
            continue
        stored = prim.GetCustomDataByKey(f"urdf:{kind}")
        for name in (stored, prim.GetDisplayName(), prim.GetName()):
            if name and name in by_name[kind]:
                found[kind][str(prim.GetPath())] = by_name[kind][name]
                break
    return found["link"], found["joint"]


def _compare_all(
    robot: Robot,
    answer: dict[str, Any],
    links: dict[str, str],
    joints: dict[str, str],
    configurations: list[dict[str, float]],
) -> dict[str, tuple[int, int]]:
    """Count the values of each row that differ, and all of them."""
    counts = {row: [0, 0] for row in ROWS}

    def note(row: str, difference: float) -> None:
        counts[row][0] += not difference <= TOLERANCE
        counts[row][1] += 1

    _compare_bodies(robot, answer, links, note)
    mechanics = Mechanics(robot)
    for values, poses in zip(configurations, answer["poses"], strict=True):
        ours_, theirs = mechanics.compute_frames(values), {}
        for path, row in poses.items():
            if path in links:
                theirs[links[path]] = _matrix(row)
        _compare_poses(robot, ours_, theirs, note)
    _compare_joints(robot, answer["joints"], joints, note)
    expected = sum(c.geometry is not None for link in robot.links for c in link.collisions)
    read = sum(shape["collides"] for shape in answer["shapes"])
    note("colliders", abs(expected - read))
    return {row: (bad, count) for row, (bad, count) in counts.items()}


def _compare_bodies(
    robot: Robot, answer: dict[str, Any], links: dict[str, str], note: Callable[[str, float], None]
) -> None:
    """Compare the rigid bodies: links that fixed joints connect count as one."""
    group = robot.tree.bodies
    frames = Mechanics(robot).compute_frames({})
    source: dict[str, list[tuple[float, Any, Any]]] = {}
    for link in robot.links:
        source.setdefault(group[link.name], []).append(_inertial(link, frames[link.name]))
    made: dict[str, list[tuple[float, Any, Any]]] = {}
    poses = answer["poses"][0]
    known = [path for path in poses if path in links]
    shift = frames[links[known[0]]] @ np.linalg.inv(_matrix(poses[known[0]])) if known else None
    for path, body in answer["bodies"].items():
        if path in links and shift is not None:
            at = shift @ _matrix(poses[path])
            turn = at[:3, :3]
            center = at[:3, 3] + turn @ np.array(body["com"])
            tensor = turn @ np.array(body["inertia"]) @ turn.T
            made.setdefault(group[links[path]], []).append((body["mass"], center, tensor))
    for name, parts in source.items():
        here, there = _combine(parts), _combine(made.get(name, []))
        if not here[0] and not there[0]:
            continue
        note("mass", abs(here[0] - there[0]) / max(here[0], there[0]))
        if here[0] and there[0]:
            size = max(1.0, float(np.abs(here[1]).max()))
            note("center", float(np.abs(here[1] - there[1]).max()) / size)
            largest = max(float(np.abs(here[2]).max()), 1e-30)
            note("inertia", float(np.abs(here[2] - there[2]).max()) / largest)


def _inertial(link: Link, frame: Any) -> tuple[float, Any, Any]:
    part = link.inertial
    if part is None or not part.mass:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    at = frame @ get_origin_matrix(part.origin)
    tensor = np.zeros((3, 3))
    if part.inertia is not None:
        xx, xy, xz, yy, yz, zz = part.inertia.six
        tensor = at[:3, :3] @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ at[:3, :3].T
    return part.mass, at[:3, 3], tensor


def _combine(parts: list[tuple[float, Any, Any]]) -> tuple[float, Any, Any]:
    """Return mass, center and inertia of several bodies as one."""
    mass = sum(part[0] for part in parts)
    if not mass:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    center = sum(weight * at for weight, at, _ in parts) / mass
    tensor = np.zeros((3, 3))
    for weight, at, own in parts:
        arm = at - center
        tensor = tensor + own + weight * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return mass, center, tensor


def _compare_poses(
    robot: Robot, here: dict[str, Any], there: dict[str, Any], note: Callable[[str, float], None]
) -> None:
    shared = [name for name in here if name in there]
    for name in shared[1:]:
        one = np.linalg.inv(here[shared[0]]) @ here[name]
        two = np.linalg.inv(there[shared[0]]) @ there[name]
        depth = max(1, sum(1 for _ in robot.tree.list_ancestors(name)))
        note("frames", float(np.abs(one - two).max()) / max(1.0, np.abs(one).max()) / depth)


def _compare_joints(
    robot: Robot,
    read: dict[str, Any],
    names: dict[str, str],
    note: Callable[[str, float], None],
) -> None:
    by_name = {names[path]: joint for path, joint in read.items() if path in names}
    for joint in Mechanics(robot).joints:
        found = by_name.get(joint.name)
        note("joints", float(found is None or found["freedoms"] != 1))
        if found is None or found["freedoms"] != 1:
            continue
        lower, upper = get_limits(joint)
        bounds = ((lower, found["limit_lower"]), (upper, found["limit_upper"]))
        note("limits", max(_differ(one, two) for one, two in bounds))
        limit, dynamics = joint.limit, joint.dynamics
        effort = np.inf if limit is None or limit.effort is None else abs(limit.effort)
        note("effort", _differ(effort, found["effort_limit"]))
        velocity = 1e6 if limit is None or not limit.velocity else abs(limit.velocity)
        note("velocity", _differ(velocity, found["velocity_limit"]))
        friction = (dynamics.friction if dynamics else 0.0) or 0.0
        damping = (dynamics.damping if dynamics else 0.0) or 0.0
        both = ((friction, found["friction"]), (damping, found["damping"]))
        note("friction, damping", max(_differ(one, two) for one, two in both))
        follows = joint.mimic is not None and joint.mimic.joint in robot.joint
        note("mimic", float(follows != (found["mimic"] is not None)))


def _differ(one: float, two: float) -> float:
    if abs(one) >= 1e6 and abs(two) >= 1e6:
        return 0.0  # Newton has no limit there
    return abs(one - two) / max(1.0, abs(one))


def _matrix(row: list[float]) -> Any:
    x, y, z, w = np.array(row[3:]) / np.linalg.norm(row[3:])
    found = np.eye(4)
    found[:3, 3] = row[:3]
    found[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return found


def format_part(kept: dict[str, dict[str, Any]]) -> str:
    """Format the table of all converters."""
    results = {name: found for name, found in kept.items() if found}
    tools = list(dict.fromkeys(tool for found in results.values() for tool in found))
    lines = [
        "## USD, as Newton imports it\n",
        f"{len(results)} robots of example-robot-data and pybullet_data, each converted in a "
        "folder "
        "of its own, and imported by Newton on the processor. Links that fixed joints connect "
        "count "
        "as one body. Tolerances are 1e-5, relative or in meters. Generated by `python -m "
        "tests.benchmarks.usd --write`; urdftool runs with `--fix-inertia lift --force`, "
        "scikit-robot "
        "and urdf2any with a fixed base.\n",
        "| equal | " + " | ".join(tools) + " |",
        "| --- |" + " --- |" * len(tools),
        _format_row("imported", tools, lambda tool: sum(
            "wrong" in found.get(tool, {}) for found in results.values())),
    ]  # fmt: skip
    for row in ROWS:
        lines.append(_format_row(row, tools, lambda tool, row=row: sum(
            "wrong" in found[tool] and row not in found[tool]["wrong"]
            for found in results.values() if tool in found)))  # fmt: skip

    def count_equal(tool: str) -> int:
        return sum(found[tool].get("wrong") == {} for found in results.values() if tool in found)

    lines.append(_format_row("**all equal**", tools, count_equal))
    for key, label, unit in (("seconds", "median time", 1.0), ("size", "median size", 1e3)):
        cells = []
        for tool in tools:
            values = [f[tool][key] for f in results.values() if tool in f and key in f[tool]]
            number = statistics.median(values) / unit if values else 0.0
            cells.append(f"{number:.1f} s" if key == "seconds" else f"{number:.0f} kB")
        lines.append(f"| {label} | " + " | ".join(cells) + " |")
    announced = [name for name, found in results.items()
                 if found["urdftool"].get("wrong") and found["urdftool"].get("losses")]  # fmt: skip
    silent = [name for name, found in results.items()
              if found["urdftool"].get("wrong") != {} and name not in announced]  # fmt: skip
    lines.append(
        f"\nIn {len(announced)} robots a difference of urdftool's stage is one that the export "
        f"reported (`lossy-…`: inertias, moving links without mass, velocity limits of 0, mimics "
        f"without a leader); in {len(silent)} it is not."
    )
    return "\n".join(lines) + "\n"


def _format_row(name: str, tools: list[str], count: Callable[[str], int]) -> str:
    return f"| {name} | " + " | ".join(str(count(tool)) for tool in tools) + " |"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
