"""World poses of an MJCF and of its export at random states, in MuJoCo."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

import urdftool as api
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.write import write

STATES = 4
"""Random states of each robot."""

SAME = 1e-8
"""Difference of positions [m], directions and sensors that is rounding; chosen, no source."""

_Objects = dict[str, tuple[str, ...]]

POSES: _Objects = {
    "camera": ("cam_xpos", "cam_xmat"),
    "light": ("light_xpos", "light_xdir"),
    "site": ("site_xpos", "site_xmat"),
    "body": ("xpos", "xmat"),
    "tendon": ("ten_length",),
}
"""Fields of MuJoCo's data by the kind of object."""


class Comparison(NamedTuple):
    """What differs between an MJCF and its export.

    Attributes:
        moved: Joints of the source whose position or start is not that of their body.
        compared: Number of compared values by kind.
        differing: Largest difference by kind and name.
        codes: Codes of the losses of the export.
    """

    moved: int
    compared: dict[str, int]
    differing: dict[str, float]
    codes: set[str]


def compare_file(path: Path) -> Comparison:
    """Export an MJCF to MJCF and compare the poses of its parts at random states.

    Raises:
        ValueError: MuJoCo does not compile the file.
        UrdftoolError: The file is not read or exported.
    """
    source = mujoco.MjModel.from_xml_path(str(path))
    robot = api.load(path)
    written = write(robot, Options(force=True))
    with tempfile.TemporaryDirectory() as name:
        for file, content in written.files.items():
            place = Path(name) / file
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(content if isinstance(content, bytes) else content.read_bytes())
        result = mujoco.MjModel.from_xml_path(str(Path(name) / written.main))
    moved = np.any(source.jnt_pos, axis=1) & (source.jnt_type != int(mujoco.mjtJoint.mjJNT_FREE))
    turned = [bool(np.any(source.qpos0[a])) for a, kind in zip(source.jnt_qposadr, source.jnt_type,
              strict=True) if kind >= int(mujoco.mjtJoint.mjJNT_SLIDE)]  # fmt: skip
    comparison = Comparison(
        int(moved.sum()) + sum(turned), {}, {}, {loss.code for loss in written.losses}
    )
    _compare_states(source, result, comparison)
    return comparison


def _compare_states(source: mujoco.MjModel, result: mujoco.MjModel, comparison: Comparison) -> None:
    """Compare two models at the start and at random states."""
    if (source.nq, source.nv) != (result.nq, result.nv):
        comparison.differing["number of joints"] = float(abs(source.nv - result.nv))
        return
    random = np.random.default_rng(0)
    datas = mujoco.MjData(source), mujoco.MjData(result)
    for number in range(STATES + 1):
        position = source.qpos0.copy()
        if number:
            mujoco.mj_integratePos(source, position, random.normal(0, 0.5, source.nv), 1.0)
        speed = random.normal(0, 1, source.nv) if number else np.zeros(source.nv)
        for model, data in zip((source, result), datas, strict=True):
            mujoco.mj_resetData(model, data)
            data.qpos[:] = position if number else model.qpos0
            data.qvel[:] = speed
            mujoco.mj_forward(model, data)
        for what, name, one, other in _list_pairs((source, datas[0]), (result, datas[1])):
            comparison.compared[what] = comparison.compared.get(what, 0) + one.size
            size = max(1.0, float(abs(one).max(initial=0.0)))
            off = float(abs(one - other).max(initial=0.0)) / size
            if not off <= SAME:
                key = f"{what} {name}"
                comparison.differing[key] = max(off, comparison.differing.get(key, 0.0))


_Model = tuple[mujoco.MjModel, mujoco.MjData]


def _list_pairs(
    source: _Model, result: _Model
) -> Iterator[tuple[str, str, np.ndarray, np.ndarray]]:
    """Yield kind, name and values of what both models have by name; infinity for what is missing.

    Geoms have other names and numbers in an export: each is compared with the nearest one. Meshes
    are left out, whose positions are those of their centers, which MuJoCo computes.
    """
    for what, fields in POSES.items():
        kind = int(getattr(mujoco.mjtObj, f"mjOBJ_{what.upper()}"))
        for number in range(getattr(source[0], f"n{_SHORT.get(what, what)}")):
            name = mujoco.mj_id2name(source[0], kind, number)
            other = mujoco.mj_name2id(result[0], kind, name) if name else -1
            if not name or (what != "tendon" and _is_scenery(source[0], what, number)):
                continue
            for field in fields:
                one = np.atleast_1d(getattr(source[1], field)[number])
                two = np.atleast_1d(getattr(result[1], field)[other]) if other >= 0 else one + 9e9
                yield what, name, one, two
    for number in range(source[0].ngeom):
        there = source[1].geom_xpos[number]
        is_mesh = source[0].geom_type[number] == int(mujoco.mjtGeom.mjGEOM_MESH)
        if source[0].geom_bodyid[number] and result[0].ngeom and not is_mesh:
            apart = np.linalg.norm(result[1].geom_xpos - there, axis=1)
            yield "geom", str(number), np.zeros(1), np.atleast_1d(apart.min())
    for number in range(source[0].nsensor):
        name = mujoco.mj_id2name(source[0], int(mujoco.mjtObj.mjOBJ_SENSOR), number)
        other = (
            mujoco.mj_name2id(result[0], int(mujoco.mjtObj.mjOBJ_SENSOR), name) if name else number
        )
        same = source[0].nsensor == result[0].nsensor or (name and other >= 0)
        if same and source[0].sensor_needstage[number] < int(mujoco.mjtStage.mjSTAGE_ACC):
            yield (
                "sensor",
                name or str(number),
                *(
                    model[1].sensordata[model[0].sensor_adr[n] :][: model[0].sensor_dim[n]]
                    for model, n in ((source, number), (result, other))
                ),
            )


_SHORT = {"camera": "cam"}
_HOLDER = {"camera": "cam_bodyid", "light": "light_bodyid", "site": "site_bodyid"}


def _is_scenery(model: mujoco.MjModel, what: str, number: int) -> bool:
    """Tell whether a part is one of the world."""
    holder = getattr(model, _HOLDER[what])[number] if what in _HOLDER else number
    return bool(holder == 0)
