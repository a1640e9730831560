"""What an engine says of one robot in one file, as numbers that any other file is compared with.

    python -m measure.benchmarks.fidelity_engines URDF [sdf|mjcf FILE …]

Runs by itself, since engines end the process on some files. The URDF is read by Pinocchio, SDF by
Drake and MJCF by MuJoCo; prints one JSON object a file.
"""

from __future__ import annotations

import json
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np

CONFIGURATIONS = 5


def main(words: list[str]) -> int:
    """Compare each file with the URDF."""
    from .sdf_engines import Source

    urdf, rest = words[0], words[1:]
    tree = ElementTree.parse(urdf).getroot()
    links = list(dict.fromkeys(link.get("name", "") for link in tree.iter("link")))
    children = {child.get("link", "") for child in tree.findall("joint/child")}
    root = next(name for name in links if name not in children)
    links = [name for name in links if name != "world"]
    try:
        source = Source(urdf)
    except Exception as error:  # what the engine does not read cannot be compared
        for _ in rest[::2]:
            print(json.dumps({"reference": _line(error)}))
        return 0
    shapes = {kind: _count(tree, kind) for kind in ("visual", "collision")}
    points = source.configurations(CONFIGURATIONS)
    for form, file in zip(rest[::2], rest[1::2], strict=True):
        try:
            target = _target(form, file, root)
            found = compare(source, target, points, links, root)
            found.update(_shapes(form, file, target, shapes))
        except Exception as error:  # it is said in the table
            print(json.dumps({"load": _line(error)}), flush=True)
            continue
        print(json.dumps(found), flush=True)
    return 0


def _line(error: Exception) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    telling = [line for line in lines if "rror" in line or "violation" in line] or lines
    return telling[0][:200] if telling else type(error).__name__


def _count(tree: ElementTree.Element, kind: str) -> int:
    found = tree.findall(f"link/{kind}/geometry")
    return sum(1 for geometry in found if len(geometry))


def _target(form: str, file: str, root: str) -> Any:
    if form == "sdf":
        from .sdf_engines import Target

        return Target(_bare(file), root)
    return Mujoco(file, root)


def _bare(file: str) -> str:
    """A copy without sensors and plugins, of which Drake refuses what Gazebo only warns of."""
    tree = ElementTree.parse(file)
    for parent in list(tree.iter()):
        for kind in ("sensor", "plugin"):
            for child in parent.findall(kind):
                parent.remove(child)
    copy = f"{file}.bare.sdf"
    tree.write(copy)
    return copy


class Mujoco:
    """An MJCF file in MuJoCo."""

    def __init__(self, path: str, root: str) -> None:
        from urdftool.formats.mjcf.compiled import Compiled

        self.compiled = Compiled(Path(path), root)
        model = self.compiled.model
        self.joints = {
            self.compiled.name("JOINT", number): number
            for number in range(model.njnt)
            if model.jnt_type[number] in (2, 3)
        }

    def state(self, q: dict[str, float], names: list[str], frames: list[str]) -> Any:
        from .sdf_engines import State

        self.compiled.set_pose(q)
        state = State()
        for name in frames:
            frame = self.compiled.get_frame(name)
            if frame is not None:
                state.frames[name] = frame
        state.mass_matrix = self.compiled.compute_mass_matrix(self.compiled.get_dofs(names))
        state.mass, state.center, state.inertia = self.compiled.compute_centroid()
        return state

    def limits(self, name: str) -> dict[str, float]:
        """Range of a joint, and the force it has at most."""
        model, number = self.compiled.model, self.joints[name]
        found = {}
        if model.jnt_limited[number]:
            found["lower"], found["upper"] = map(float, model.jnt_range[number])
        for row in range(model.neq):  # a joint that cannot move is held by an equality
            if model.eq_obj1id[row] == number and model.eq_obj2id[row] < 0:
                found["lower"] = found["upper"] = float(model.eq_data[row][0])
        if model.jnt_actfrclimited[number]:
            found["effort"] = float(model.jnt_actfrcrange[number][1])
        for actuator in range(model.nu):
            if model.actuator_trnid[actuator][0] != number:
                continue
            if model.actuator_forcelimited[actuator]:
                found.setdefault("effort", float(model.actuator_forcerange[actuator][1]))
            elif model.actuator_ctrllimited[actuator] and not model.actuator_biastype[actuator]:
                gear = abs(float(model.actuator_gear[actuator][0]))
                found.setdefault("effort", gear * float(model.actuator_ctrlrange[actuator][1]))
        return found


def compare(
    source: Any, target: Any, points: list[dict[str, float]], links: list[str], root: str
) -> dict[str, Any]:
    """Counts of what is there and of what is equal, and how far the rest is off."""
    names = [name for name in source.names if name in target.joints]
    wrong: set[str] = set()
    there: set[str] = set()
    matrix = 0.0
    masses, apart = (0.0, 0.0), 0.0
    for q in points:
        one = source.state(q, names)
        two = target.state({n: v for n, v in q.items() if n in names}, names, links)
        base = one.frames[root]
        for name in links:
            if name not in two.frames or name not in one.frames:
                continue
            there.add(name)
            expected = np.linalg.solve(base, one.frames[name])
            if np.abs(expected - two.frames[name]).max() > 1e-5:
                wrong.add(name)
        if names and len(names) == len(source.names):
            scale = np.sqrt(np.maximum(np.diag(one.mass_matrix), 0))
            floor = 1e-6 * max(float(np.diag(one.mass_matrix).max()), 1e-300)
            size = np.maximum(np.outer(scale, scale), floor)
            matrix = max(matrix, float((np.abs(one.mass_matrix - two.mass_matrix) / size).max()))
        masses = float(one.mass), float(two.mass)
        if one.mass > 0 and abs(two.mass / one.mass - 1) < 1e-6:
            largest = max(float(np.abs(one.inertia).max()), 1e-300)
            apart = max(apart, float(np.abs(one.inertia - two.inertia).max()) / largest)
    bounds, efforts = _limits(source, target, names)
    return {
        "links": [len(there - wrong), len(links)], "misplaced": sorted(wrong)[:3],
        "joints": [len(names), len(source.names)], "matrix": matrix, "mass": masses,
        "inertia": apart, "ranges": bounds, "efforts": efforts,
    }  # fmt: skip


def _limits(source: Any, target: Any, names: list[str]) -> tuple[list[int], list[int]]:
    ranges, efforts = [0, 0], [0, 0]
    for name in source.names:
        given = source.limits(name)
        made = target.limits(name) if name in names else {}
        if "lower" in given and abs(given["lower"]) < 1e15:
            ranges[1] += 1
            ranges[0] += all(_near(given[end], made.get(end)) for end in ("lower", "upper"))
        if 0 < given["effort"] < 1e15:
            efforts[1] += 1
            efforts[0] += _near(given["effort"], made.get("effort"))
    return ranges, efforts


def _near(one: float, two: float | None) -> bool:
    return two is not None and abs(one - two) <= 1e-5 * max(1.0, abs(one))


def _shapes(form: str, file: str, target: Any, wanted: dict[str, int]) -> dict[str, Any]:
    """How many shapes there are to see and to touch, of how many."""
    if form == "sdf":
        tree = ElementTree.parse(file).getroot()
        found = {kind: len(tree.findall(f".//{kind}/geometry")) for kind in wanted}
    else:
        model = target.compiled.model
        geoms = [g for g in range(model.ngeom) if model.geom_type[g] != 0]  # 0 is a floor
        touching = sum(bool(model.geom_contype[g] or model.geom_conaffinity[g]) for g in geoms)
        found = {"collision": touching, "visual": len(geoms) - touching}
    return {kind: [min(found[kind], count), count] for kind, count in wanted.items()}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
