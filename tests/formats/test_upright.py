"""Robots with y up are turned; joints that are too weak for home start where they hold."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.plan import make_plan
from urdftool.formats.written import Written
from urdftool.model.load import load

LEG = """<link name="foot_{n}"><inertial><mass value="0.2"/>
<inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial>
<collision><origin xyz="{down}"/><geometry><sphere radius="0.02"/></geometry></collision></link>
<joint name="hip_{n}" type="revolute"><parent link="trunk"/><child link="foot_{n}"/>
<origin xyz="{at}"/><axis xyz="{axis}"/>
<limit lower="-1" upper="1" effort="40" velocity="9"/></joint>
"""


def write_robot(folder: Path, *, up: int, origin: str = "") -> Path:
    """Write a quadruped of four straight legs whose axis ``up`` (1 or 2) points up."""
    legs = ""
    for n in range(4):
        x, side = (0.2, -0.2)[n // 2], (0.1, -0.1)[n % 2]
        at = f"{x} {-side} 0" if up == 2 else f"{x} 0 {side}"
        down, axis = ("0 0 -0.3", "0 1 0") if up == 2 else ("0 -0.3 0", "0 0 1")
        legs += LEG.format(n=n, at=at, down=down, axis=axis)
    path = folder / "quadruped.urdf"
    path.write_text(
        f'<robot name="q">{origin}<link name="trunk"><inertial><mass value="5"/>'
        '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>'
        '<collision><geometry><box size="0.4 0.1 0.1"/></geometry></collision></link>'
        f"{legs}</robot>"
    )
    return path


@pytest.mark.parametrize(
    ("up", "origin", "roll"),
    [(2, "", 0.0), (1, "", math.pi / 2), (1, '<origin rpy="0 0 0"/>', 0.0)],
)
def test_base_is_turned_only_where_y_is_up(
    tmp_path: Path, up: int, origin: str, roll: float
) -> None:
    """A base whose pose the file gives is never turned."""
    written = Written("")
    path = write_robot(tmp_path, up=up, origin=origin)
    base = make_plan(load(path), "q", Options(base="free"), written).robot.base
    assert base is not None
    assert base.is_free
    assert (0.0 if base.origin is None else base.origin.rpy[0]) == pytest.approx(roll)
    assert ("lossy-y-up" in {loss.code for loss in written.losses}) == bool(roll)
    if roll or up == 2:
        assert base.origin is not None
        assert base.origin.xyz[2] == pytest.approx(0.32, abs=1e-6)


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("up", [1, 2])
def test_simulate_measures_the_tilt_from_the_turned_base(tmp_path: Path, up: int) -> None:
    """A robot with y up stands in simulate, too, and its tilt is not that of its z axis."""
    import urdftool

    verdict = urdftool.simulate(load(write_robot(tmp_path, up=up)), engine="mujoco")[0]
    assert verdict.stands, [fault.message for fault in verdict.faults]
    assert verdict.rest.tilt < math.radians(1)
    assert any(verdict.run.settings.upright_rpy) == (up == 1)
