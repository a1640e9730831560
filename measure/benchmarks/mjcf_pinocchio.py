"""example-robot-data: MuJoCo on the export against Pinocchio on the description."""

from __future__ import annotations

import math
import time
from pathlib import Path

import numpy as np
import pinocchio as pin
from mjcf_robots import Export, example_folder, example_robots, export

from urdftool.formats.mjcf.compiled import Compiled

COLUMNS = ("frames", "mass matrix", "gravity", "centroid", "limits", "collision")
BOUND = {
    "frames": 1e-9, "mass matrix": 1e-8, "gravity": 1e-8, "centroid": 1e-8, "limits": 1e-9,
    "collision": 1e-6,
}  # fmt: skip
CONFIGURATIONS = 10


def table(folder: Path, only: str) -> str:
    """One row a robot, and what is equal of how many."""
    rows, notes, totals = [], [], dict.fromkeys((*COLUMNS, "compiles", "all"), 0)
    packages = {"example-robot-data": example_folder().parent}
    robots = [path for path in example_robots(folder) if only in str(path)]
    for path in robots:
        start = time.perf_counter()
        made = export(path, folder / f"out_{len(rows)}", packages, actuators="none", base="fixed")
        seconds = time.perf_counter() - start
        name = path.stem
        if made.model is None or made.robot is None:
            rows.append(f"| {name} | {seconds:.2f} | {made.message} |")
            continue
        try:
            compiled = Compiled(made.model, made.robot.tree.roots[0].name)
        except Exception as error:  # the table says what happened
            rows.append(f"| {name} | {seconds:.2f} | {error} |")
            continue
        clean = not compiled.warnings
        worst = compare(path, made, compiled)
        cells = [_cell(worst[column], BOUND[column]) for column in COLUMNS]
        totals["compiles"] += clean
        for column in COLUMNS:
            totals[column] += worst[column] <= BOUND[column]
        equal = clean and all(worst[column] <= BOUND[column] for column in COLUMNS)
        totals["all"] += equal
        own = "<collision_checking" in path.read_text(encoding="utf-8", errors="replace")
        said = made.rules | _said(made)
        verdict = (
            "equal" if equal else "announced" if said else "other reading" if own else "DIFFERS"
        )
        rows.append(f"| {name} | {seconds:.2f} | {' | '.join(cells)} | {verdict} |")
        if not equal:
            why = ["Pinocchio puts <collision_checking> in the place of <collision>"] if own else []
            notes.append(f"- {name}: {', '.join(sorted(said) or why)}")
    head = f"| robot | s | {' | '.join(COLUMNS)} | verdict |"
    count = len(robots)
    sums = " | ".join(f"**{totals[column]}**" for column in COLUMNS)
    foot = f"| **{count}** | | {sums} | **{totals['all']} equal** |"
    lines = [head, "|---" * (len(COLUMNS) + 3) + "|", *rows, foot, ""]
    lines.append(f"{totals['compiles']} of {count} compile in MuJoCo without a warning.")
    return "\n".join([*lines, *notes])


def _said(made: Export) -> set[str]:
    losses = made.written.losses if made.written is not None else []
    return {loss.code for loss in losses if loss.severity > 1 and loss.code != "lossy-nonconvex"}


def _cell(value: float, bound: float) -> str:
    text = f"{value:.0e}" if value else "0"
    return text if value <= bound else f"**{text}**"


def compare(path: Path, made: Export, compiled: Compiled) -> dict[str, float]:
    """The largest difference of each kind."""
    model = pin.buildModelFromUrdf(str(path))
    data = model.createData()
    worst = dict.fromkeys(COLUMNS, 0.0)
    names = [name for j, name in enumerate(model.names) if j and model.joints[j].nv == 1]
    dofs = compiled.get_dofs(names)
    columns = [model.joints[model.getJointId(name)].idx_v for name in names]
    if min(dofs, default=0) < 0:
        worst["limits"] = math.inf
    present = [i for i, dof in enumerate(dofs) if dof >= 0]
    random = np.random.default_rng(1)
    geometry = _geometry(path, model)
    for index in range(CONFIGURATIONS):
        q, positions = _configuration(model, names, random, zero=index == 0)
        compiled.pose(positions)
        pin.framesForwardKinematics(model, data, q)
        root = data.oMf[model.getFrameId(made.robot.tree.roots[0].name, pin.FrameType.BODY)]
        for frame, placed in zip(model.frames, data.oMf, strict=True):
            if frame.type == pin.FrameType.BODY:
                found = compiled.frame(frame.name)
                expected = (root.inverse() * placed).homogeneous
                apart = math.inf if found is None else abs(found - expected).max()
                worst["frames"] = max(worst["frames"], apart)
        if present:
            _dynamics(
                model,
                data,
                q,
                compiled,
                [columns[i] for i in present],
                [dofs[i] for i in present],
                worst,
            )
        _centroid(model, data, q, root, compiled, worst)
        if index < 2:
            worst["collision"] = max(
                worst["collision"], _collision(geometry, model, data, q, root, compiled)
            )
    worst["limits"] = max(worst["limits"], _limits(model, names, compiled))
    return worst


def _configuration(model, names, random, *, zero):
    q, positions = pin.neutral(model), {}
    for name in names:
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 2:
            value = 0.0 if zero else random.uniform(-math.pi, math.pi)
            q[joint.idx_q : joint.idx_q + 2] = math.cos(value), math.sin(value)
        else:
            low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
            low, high = (low, high) if -1e3 < low < high < 1e3 else (-math.pi, math.pi)
            value = 0.0 if zero else random.uniform(low, high)
            q[joint.idx_q] = value
        positions[name] = float(value)
    return q, positions


def _dynamics(model, data, q, compiled, columns, dofs, worst):
    full = pin.crba(model, data, q)
    full = np.triu(full) + np.triu(full, 1).T
    expected = full[np.ix_(columns, columns)] - np.diag(model.armature[columns])
    scale = np.sqrt(np.maximum(np.diag(expected), 0))
    floor = 1e-6 * max(np.diag(expected).max(), 1e-300)
    apart = abs(compiled.mass_matrix(dofs) - expected) / np.maximum(np.outer(scale, scale), floor)
    worst["mass matrix"] = max(worst["mass matrix"], apart.max())
    force = pin.computeGeneralizedGravity(model, data, q)[columns]
    mass = sum(inertia.mass for inertia in model.inertias)
    weight = max(abs(force).max(), 1e-6 * 9.81 * mass, 1e-300)
    worst["gravity"] = max(worst["gravity"], abs(compiled.gravity(dofs) - force).max() / weight)


def _centroid(model, data, q, root, compiled, worst):
    pin.forwardKinematics(model, data, q)
    whole = pin.Inertia.Zero()
    for placed, inertia in zip(data.oMi, model.inertias, strict=True):
        whole += placed.act(inertia)
    whole = root.inverse().act(whole)
    mass, com, tensor = compiled.centroid()
    if whole.mass == 0:
        worst["centroid"] = max(worst["centroid"], mass)
        return
    size = max(abs(whole.inertia).max(), 1e-300)
    apart = (
        abs(mass - whole.mass) / whole.mass * 1e-8 / 1e-12,
        abs(com - whole.lever).max() * 1e-8 / 1e-9,
        abs(tensor - whole.inertia).max() / size,
    )
    worst["centroid"] = max(worst["centroid"], *apart)


def _limits(model, names, compiled):
    worst = 0.0
    mj = compiled.model
    for name in names:
        joint = model.joints[model.getJointId(name)]
        number = compiled.get_id("JOINT", name)
        if number < 0:
            return math.inf
        pairs = [
            (mj.dof_damping[mj.jnt_dofadr[number]], model.damping[joint.idx_v]),
            (mj.dof_frictionloss[mj.jnt_dofadr[number]], model.friction[joint.idx_v]),
        ]
        effort = model.upperEffortLimit[joint.idx_v]
        if 0 < effort < 1e15:  # zero is also what an absent limit reads as
            pairs.append((mj.jnt_actfrcrange[number][1], effort))
        if joint.nq == 1:
            low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
            held = [
                mj.eq_data[e][0] for e in range(mj.neq)
                if mj.eq_obj1id[e] == number and mj.eq_obj2id[e] < 0
            ]  # fmt: skip
            found = (held[-1], held[-1]) if held else tuple(mj.jnt_range[number])
            if abs(low) < 1e15 or mj.jnt_limited[number]:
                pairs += [(found[0], low), (found[1], high)]
        for one, other in pairs:
            worst = max(worst, abs(np.ravel(one)[0] - other) / max(abs(other), 1.0))
    return worst


def _geometry(path, model):
    packages = [
        str(example_folder().parents[1]),
        str(example_folder().parent),
        str(example_folder()),
    ]
    try:
        return pin.buildGeomFromUrdf(model, str(path), pin.GeometryType.COLLISION, packages)
    except Exception:
        return None


def _collision(geometry, model, data, q, root, compiled):
    """The boxes of all collisions, each in the frame of its shape."""
    if geometry is None:
        return math.inf
    placements = geometry.createData()
    pin.updateGeometryPlacements(model, data, geometry, placements, q)
    worst = 0.0
    for number, shape in enumerate(geometry.geometryObjects):
        link = model.frames[shape.parentFrame].name
        index = int(shape.name.rpartition("_")[2])
        body = 0 if link == "world" else compiled.get_id("BODY", link)
        geoms = [
            g for g in range(compiled.model.ngeom)
            if compiled.model.geom_bodyid[g] == body and compiled.model.geom_group[g] == 3
        ]  # fmt: skip
        if index >= len(geoms):
            return math.inf
        shape.geometry.computeLocalAABB()
        box = shape.geometry.aabb_local
        frame = (root.inverse() * placements.oMg[number]).homogeneous
        low, high = _geom_box(compiled, geoms[index], frame)
        worst = max(worst, abs(low - box.min_).max(), abs(high - box.max_).max())
    return worst


def _geom_box(compiled, geom, frame):
    """The box of a geom in another frame than the root's."""
    from urdftool.formats.mjcf.verify_home import get_reaches

    pose = np.linalg.inv(frame) @ compiled.get_geom_frame(geom)
    reaches = np.array([get_reaches(compiled, geom, row) for row in pose[:3, :3]])
    return pose[:3, 3] + reaches[:, 0], pose[:3, 3] + reaches[:, 1]
