"""Joints whose effort limit is too low at home; joints that turn against each other."""

import pytest

from tests.formats.mjcf.robots import export
from tests.formats.test_standing_pose import FLAT, body, turn
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.plan import make_plan
from urdftool.formats.written import Written
from urdftool.model.load import load

TORSO = (
    '<link name="torso"><inertial><origin xyz="0.1 0 0.3"/><mass value="4"/>'
    '<inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial></link>'
)


def weak(effort):
    """Return a robot on two large feet, with a torso of 4 kg 0.1 m before its waist."""
    feet = [
        body(f"{side}_foot", 6, FLAT.replace("0.2 0.1", "0.6 0.2")) for side in ("left", "right")
    ]
    hips = [
        turn(f"{side}_hip", "base", f"{side}_foot", f"0 {y} -0.2", (-1, 1))
        for side, y in (("left", 0.2), ("right", -0.2))
    ]
    waist = turn("waist", "base", "torso", "0 0 0", (-1, 1)).replace(
        'effort="30"', f'effort="{effort}"'
    )
    return f'<robot name="r">{body("base", 4)}{"".join(feet)}{TORSO}{"".join(hips)}{waist}</robot>'


@pytest.mark.parametrize(("effort", "is_moved"), [(5, False), (3, True), (0, False)])
def test_a_weak_waist_starts_where_it_holds(write, effort, is_moved):
    """The waist requires 4 kg · 9.81 m/s² · 0.1 m = 3.92 N·m at zero; tan x = (0.1 - d)/0.3."""
    written = Written("")
    plan = make_plan(load(write("r.urdf", weak(effort))), "r", Options(base="free"), written)
    losses = [loss for loss in written.losses if loss.code == "lossy-weak-joint"]
    assert len(losses) == is_moved
    assert bool(plan.home.positions["waist"]) == is_moved
    if is_moved:
        angle = plan.home.positions["waist"]
        assert losses[0].data["force"] == pytest.approx(4 * 9.81 * 0.1)
        # about 0.8 of the effort, at a step of 0.02 rad; negative turns the torso backward
        arm = abs(0.1 + 0.3 * angle)
        assert angle < 0
        assert 4 * 9.81 * arm <= 1.01 * 0.8 * effort


@pytest.mark.parametrize(("mass", "armature"), [(0.1, 0), (0, 1e-4)])
def test_joints_on_one_line_get_an_armature(write, mass, armature):
    """A link without mass between two joints on one line turns without moving mass."""
    between = body("between", mass) if mass else '<link name="between"/>'
    parts = [
        body("base", 1), between, body("tip", 1),
        turn("a", "base", "between", "0 0 0", (-1, 1)),
        turn("b", "between", "tip", "0 0 0", (-1, 1)),
    ]  # fmt: skip
    path = write("r.urdf", f'<robot name="r">{"".join(parts)}</robot>')
    plan = make_plan(load(path), "r", Options(), Written(""))
    found = {joint.name: joint.dynamics and joint.dynamics.armature for joint in plan.robot.joints}
    assert {name: value or 0 for name, value in found.items()} == {"a": armature, "b": armature}
    assert ("lossy-armature" in {one.code for one in export(path).losses}) == bool(armature)
