"""Conversions to USD as Newton imports them, next to those of other converters.

    python -m measure.benchmarks.usd [--write] [--only NAME] [--keep FILE] [--bullet]

It runs where usd-core and Newton are installed. The other converters are in environments of their
own, named by URDFTOOL_USD_CONVERTER, URDFTOOL_URDF2ANY and URDFTOOL_SKROBOT; one that is not named
is left out. Each robot is converted to a folder of its own, and Newton imports the stage on the
processor. The reference is the description itself, by ``urdftool.mechanics.reference``. ``--write``
replaces a part of docs/measurements/fidelity.md.
"""

from __future__ import annotations

import argparse
import json
import os
import re
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
from urdftool.formats.common.shape_box import ShapeBoxes
from urdftool.mechanics.reference import Mechanics, get_origin_matrix
from urdftool.model.elements import Joint, Link, Mesh, Robot
from urdftool.model.kinematics import (
    add_mimic_positions,
    find_movable_joints,
    follow_mimic_chain,
    get_limits,
    link_poses,
)
from urdftool.model.pose import rotation_from_quaternion

from .robots import bullet_robots, example_folder, example_robots, resolved
from .usd_page import ROWS, format_part, write_part

LIMIT = 120.0
TOLERANCE = 1e-5
"""Relative; poses and centers of mass in meters, for a link below n others n times as much."""

HULL = 0.1
"""Relative to the size, of colliders with meshes: hulls of at most 64 vertices are smaller."""


class Converter(NamedTuple):
    """A converter: its name, and the command that writes a stage into a folder."""

    name: str
    command: Callable[[Path, Path], list[str]]


def build_our_command(urdf: Path, folder: Path) -> list[str]:
    """Return our command."""
    packages = example_folder()
    more = ["--package-path", str(packages.parent)] if packages else []
    return [sys.executable, "-m", "urdftool", "export", "usd", str(urdf), "-o",
            str(folder / "robot.usdc"), "--fix-inertia", "lift", "--force",
            "--format", "json", *more]  # fmt: skip


def list_converters() -> Iterator[Converter]:
    """Yield the converters that are installed."""
    yield Converter("urdftool", build_our_command)
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
    parser.add_argument("--converter", default="", help="only this one; keep results of others")
    parser.add_argument("--bullet", action="store_true", help="robots of pybullet_data instead")
    arguments = parser.parse_args(words)
    import_module("newton")  # it registers its schemas, which must precede the first stage
    kept: dict[str, Any] = {}
    if arguments.keep and arguments.keep.exists():
        kept = json.loads(arguments.keep.read_text("utf-8"))
    found = example_robots() if not arguments.bullet else bullet_robots()
    for path in found:
        name = "/".join(path.parts[-3:])
        if arguments.only not in name:
            continue
        known = kept.setdefault(name, {})
        measure(path, known, arguments.converter)
        print(name, {k: v.get("wrong", v.get("why")) for k, v in known.items()},
              file=sys.stderr, flush=True)  # fmt: skip
        if arguments.keep:
            arguments.keep.write_text(json.dumps(kept), "utf-8")
    tools = [converter.name for converter in list_converters()]
    part = "bullet" if arguments.bullet else "examples"
    if arguments.write:
        write_part(part, kept, tools)
    else:
        print(format_part(part, kept, tools))
    return 0


def measure(path: Path, results: dict[str, dict[str, Any]], only: str = "") -> None:
    """Convert a robot with each converter that has no result, and compare what Newton imports."""
    packages = example_folder()
    try:
        robot = urdftool.load(path, package_paths=[packages.parent] if packages else [])
        Mechanics(robot)
        assert len(robot.tree.roots) == 1
    except (UrdftoolError, AssertionError):
        return
    for converter in list_converters():
        if converter.name in results or only not in ("", converter.name):
            continue
        with TemporaryDirectory(prefix="usd-") as folder:
            results[converter.name] = _measure_one(converter, robot, path, Path(folder))


def _measure_one(converter: Converter, robot: Robot, path: Path, folder: Path) -> dict[str, Any]:
    urdf = path if converter.command is build_our_command else resolved(path, folder / "in")
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
    if converter.command is build_our_command:
        report = json.loads(done.stdout)
        losses = [f["rule"] for f in report.get("findings", []) if f["severity"] != "info"]
    wrong = compare(robot, stages[0])
    size = sum(p.stat().st_size for p in out.rglob("*") if p.is_file())
    invalid = count_errors(stages[0])
    return {**wrong, "losses": sorted(set(losses)), "seconds": seconds, "size": size,
            "invalid": invalid}  # fmt: skip


def count_errors(stage: Path) -> int:
    """Count what the validators of OpenUSD find in a stage."""
    from pxr import Usd, UsdValidation

    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    return len(UsdValidation.ValidationContext(validators).Validate(Usd.Stage.Open(str(stage))))


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
                theirs[links[path]] = _make_matrix(row)
        _compare_poses(robot, ours_, theirs, note)
    _compare_joints(robot, answer["joints"], joints, note)
    expected = sum(c.geometry is not None for link in robot.links for c in link.collisions)
    read = sum(shape["collides"] for shape in answer["shapes"])
    note("colliders", abs(expected - read))
    _compare_shapes(robot, answer, links, note)
    return {row: (bad, count) for row, (bad, count) in counts.items()}


def _compare_bodies(
    robot: Robot, answer: dict[str, Any], links: dict[str, str], note: Callable[[str, float], None]
) -> None:
    """Compare the rigid bodies: links that fixed joints connect count as one."""
    group = robot.tree.bodies
    frames = Mechanics(robot).compute_frames({})
    source: dict[str, list[tuple[float, Any, Any]]] = {}
    for link in robot.links:
        source.setdefault(group[link.name], []).append(_get_inertial(link, frames[link.name]))
    made: dict[str, list[tuple[float, Any, Any]]] = {}
    poses = answer["poses"][0]
    known = [path for path in poses if path in links]
    shift = (
        frames[links[known[0]]] @ np.linalg.inv(_make_matrix(poses[known[0]])) if known else None
    )
    for path, body in answer["bodies"].items():
        if path in links and shift is not None:
            at = shift @ _make_matrix(poses[path])
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


def _get_inertial(link: Link, frame: Any) -> tuple[float, Any, Any]:
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
        note("limits", max(_measure_difference(one, two) for one, two in bounds))
        limit, dynamics = joint.limit, joint.dynamics
        effort = np.inf if limit is None or limit.effort is None else abs(limit.effort)
        note("effort", _measure_difference(effort, found["effort_limit"]))
        velocity = 1e6 if limit is None or not limit.velocity else abs(limit.velocity)
        note("velocity", _measure_difference(velocity, found["velocity_limit"]))
        friction = (dynamics.friction if dynamics else 0.0) or 0.0
        damping = (dynamics.damping if dynamics else 0.0) or 0.0
        both = ((friction, found["friction"]), (damping, found["damping"]))
        note("friction, damping", max(_measure_difference(one, two) for one, two in both))
        note("mimic", _compare_mimic(robot, joint, found["mimic"], names))


def _compare_mimic(
    robot: Robot, joint: Joint, read: tuple[str, float, float] | None, names: dict[str, str]
) -> float:
    movable = find_movable_joints(robot)
    if joint.mimic is None or joint.mimic.joint not in movable:
        return float(read is not None)
    if read is None:
        return 1.0
    leader, factor, offset = follow_mimic_chain(joint, movable)
    if names.get(read[0]) != leader:
        return 1.0
    return max(_measure_difference(factor, read[1]), _measure_difference(offset, read[2]))


def _compare_shapes(
    robot: Robot, answer: dict[str, Any], links: dict[str, str], note: Callable[[str, float], None]
) -> None:
    """Compare the bounding box of the colliders of each rigid body, along the body's axes."""
    group, boxes = robot.tree.bodies, ShapeBoxes(robot)
    poses = link_poses(robot)
    here: dict[str, list[Any]] = {}
    there: dict[str, list[Any]] = {}
    exact: dict[str, bool] = {}
    for link in robot.links:
        top = group[link.name]
        frame = poses[top].invert() @ poses[link.name]
        for shape in link.collisions:
            box = boxes.compute_box(shape, frame)
            exact[top] = exact.get(top, True) and not isinstance(shape.geometry, Mesh)
            if box is not None:
                here.setdefault(top, []).append(box)
    for shape in answer["shapes"]:
        link = links.get(shape["body"]) if shape["body"] else robot.tree.roots[0].name
        if shape["collides"] and shape["bounds"] and link is not None:
            frame = poses[group[link]].invert() @ poses[link]
            turn, shift = np.array(frame.rotation), np.array(frame.translation)
            low, high = np.array(shape["bounds"])
            if np.allclose(np.abs(turn).round(), np.abs(turn), atol=1e-9):
                ends = np.array([turn @ low, turn @ high]) + shift
                there.setdefault(group[link], []).append((ends.min(0), ends.max(0)))
            else:
                there.setdefault(group[link], []).append(None)
    for top, found in here.items():
        got = there.get(top, [])
        if any(box is None for box in got):
            continue  # a box along other axes does not tell the shape
        if not got:
            note("shapes", 1.0)
            continue
        one, two = (np.array([np.min([b[0] for b in many], 0), np.max([b[1] for b in many], 0)])
                    for many in (found, got))  # fmt: skip
        size = max(1e-9, float(np.ptp(one, axis=0).max()))
        allowed = TOLERANCE if exact[top] else HULL
        note("shapes", float(np.abs(one - two).max()) / size * TOLERANCE / allowed)


def _measure_difference(one: float, two: float) -> float:
    if abs(one) >= 1e6 and abs(two) >= 1e6:
        return 0.0  # Newton has no limit there
    return abs(one - two) / max(1.0, abs(one))


def _make_matrix(row: list[float]) -> Any:
    found = np.eye(4)
    x, y, z, w = row[3:]
    found[:3, 3], found[:3, :3] = row[:3], rotation_from_quaternion((w, x, y, z))
    return found


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
