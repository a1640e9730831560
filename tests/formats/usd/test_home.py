"""Home and servos of a stage: as in MJCF, and compared by the proof."""

import math

import numpy as np
import pytest

from tests.formats.mjcf.robots import export as export_mjcf
from tests.formats.mjcf.robots import find, rules, tree
from tests.formats.test_standing_pose import CORNERS, quadruped
from tests.formats.usd.stages import BOX, export, joint, link, robot, stage_of

pytestmark = pytest.mark.library("pxr")


def read_joint(written, folder, name):
    """The attributes of a joint that a stage sets."""
    stage = stage_of(written, folder / "out")
    prim = stage.GetPrimAtPath(f"/r/joints/{name}")
    return {a.GetName(): a.Get() for a in prim.GetAttributes() if a.HasAuthoredValue()}


@pytest.fixture
def dog(write):
    return write("dog.urdf", quadruped())


def test_home_and_gains_are_those_of_mjcf(dog, tmp_path):
    model = export_mjcf(dog, file="r.xml")
    home = [float(word) for word in find(tree(model), "key", "home").get("qpos").split()]
    gains = {one.joint: one.gain for one in model.planned.joint_actuators}
    names = [f"{leg}_{part}" for leg in CORNERS for part in ("hip", "knee")]
    for name, position in zip(names, home[7:], strict=True):
        joint = read_joint(export(dog, file="r.usda"), tmp_path / name, name)
        degrees = pytest.approx(math.degrees(position), abs=1e-4)
        assert joint["state:angular:physics:position"] == degrees
        assert joint["drive:angular:physics:targetPosition"] == degrees
        stiffness = math.degrees(joint["drive:angular:physics:stiffness"])
        assert stiffness == pytest.approx(gains[name], rel=1e-6)


def test_the_height_of_a_free_root_is_that_of_mjcf_and_noted(dog, write):
    home = find(tree(export_mjcf(dog, file="r.xml")), "key", "home").get("qpos").split()
    (start,) = [one for one in export(dog, file="r.usda").losses if one.code == "lossy-start"]
    assert start.data["height"] == float(home[2]) > 0.3
    assert f"if its root is at z = {float(home[2]):g} m; the stage has it at z = 0" in start.message
    fixed = export(dog, file="r.usda", base="fixed")
    assert "lossy-start" not in rules(fixed)


def test_a_servo_is_critically_damped(dog, tmp_path):
    """A calf of 0.2 kg whose center is in the joint: I = 0.002 kg·m² about the axis.

    The damping is critical for the inertia with the other joints free, which MuJoCo computes.
    """
    mujoco = pytest.importorskip("mujoco")
    joint = read_joint(export(dog, file="r.usda"), tmp_path, "fl_knee")
    stiffness, damping = (
        math.degrees(joint[f"drive:angular:physics:{name}"]) for name in ("stiffness", "damping")
    )
    assert stiffness == pytest.approx(0.002 / 0.002**2, rel=1e-6)
    text = export_mjcf(dog, file="r.xml").files["r.xml"].decode()
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    place = model.jnt_dofadr[model.joint("fl_knee").id]
    push, turn = np.zeros((1, model.nv)), np.zeros((1, model.nv))
    push[0, place] = 1
    mujoco.mj_solveM(model, data, turn, push)
    free = 1 / turn[0, place]
    assert free < 0.0019
    assert damping == pytest.approx(2 * math.sqrt(stiffness * free), rel=1e-3)


@pytest.mark.parametrize(
    ("choices", "stiff"),
    [
        ({}, True),
        ({"actuators": "position"}, True),
        ({"actuators": "none"}, False),
        ({"actuators": "described"}, False),
        ({"actuators": "motor"}, False),
        ({"actuators": "velocity"}, False),
        ({"timestep": 0.02}, True),
    ],
)
def test_the_user_chooses_what_drives(dog, tmp_path, choices, stiff):
    joint = read_joint(export(dog, file="r.usda", **choices), tmp_path, "fl_knee")
    stiffness = math.degrees(joint["drive:angular:physics:stiffness"])
    assert (stiffness > 0) == stiff
    if "timestep" in choices:
        assert stiffness == pytest.approx(0.002 / 0.02**2, rel=1e-6)
    damping = joint["drive:angular:physics:damping"]
    assert (damping > 0) == (stiff or choices["actuators"] == "velocity")


@pytest.mark.parametrize(("leg", "knee"), [("fl", -1.2), ("rr", -1.5)])
def test_pose_and_patterns(dog, tmp_path, leg, knee):
    written = export(dog, file="r.usda", pose={"*_knee": -1.5, "fl_knee": -1.2})
    joint = read_joint(written, tmp_path, f"{leg}_knee")
    assert joint["state:angular:physics:position"] == pytest.approx(math.degrees(knee))
    assert "lossy-standing" not in rules(written)


def test_the_home_is_compared(dog):
    import urdftool
    from urdftool.formats.usd.verify import verify_copy

    written = export(dog, file="r.usda")
    source = urdftool.load(dog)
    rows = {check.name: check for check in verify_copy(source, written, newton=False)}
    assert (rows["home"].verdict, rows["actuators"].verdict) == ("equal", "announced")
    text = written.files["r.usda"].decode()
    for name, row in (("state:angular:physics:position = -", "home"),
                      ("angular:physics:targetPosition = -", "home"),
                      ("angular:physics:stiffness = ", "actuators")):  # fmt: skip
        assert name in text
        written.files["r.usda"] = text.replace(name, f"{name}1").encode()
        rows = {check.name: check for check in verify_copy(source, written, newton=False)}
        assert rows[row].verdict == "differs"


@pytest.mark.parametrize("effort", ["", "0", "1e9"])
def test_a_servo_without_effort_limit_has_the_largest_force_of_mjcf(tmp_path, write, effort):
    limit = f'<limit effort="{effort}" velocity="1"/>' if effort else ""
    parts = link("a"), joint("j", "a", "b", "continuous", limit), link("b")
    path = write("r.urdf", robot(*parts))
    made = read_joint(export(path, file="r.usda"), tmp_path, "j")
    assert made["drive:angular:physics:stiffness"] > 0
    (servo,) = tree(export_mjcf(path)).find("actuator")
    largest = float(servo.get("forcerange").split()[1])
    assert made["drive:angular:physics:maxForce"] == pytest.approx(largest)


def test_a_negative_effort_limit_is_reported(write):
    limit = '<limit lower="-1" upper="1" effort="-5" velocity="1"/>'
    path = write("r.urdf", robot(link("a"), joint("j", "a", "b", "revolute", limit), link("b")))
    for written in (export(path, file="r.usda", force=True), export_mjcf(path, force=True)):
        [loss] = [one for one in written.losses if one.code == "lossy-effort"]
        assert "-5 of joint 'j' is negative: 5 is written" in loss.message


BOXES = (
    *(link(name, 1, BOX) for name in ("a", "b", "c")),
    joint("i", "a", "b", "continuous", '<origin xyz="0 0 1"/>'),
    joint("j", "b", "c", "continuous", '<origin xyz="0 0 {}"/>'),
)
SELF = '<gazebo reference="c"><selfCollide>true</selfCollide></gazebo>'


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(
    ("height", "more", "pairs"), [("-0.9", SELF, 1), ("-0.9", "", 0), ("0.5", SELF, 0)]
)
def test_links_that_overlap_at_home_never_collide(write, tmp_path, height, more, pairs):
    from pxr import UsdPhysics

    import urdftool

    path = write("r.urdf", robot(*BOXES, more).replace("{}", height))
    source = urdftool.load(path)
    written = urdftool.export_usd(source, tmp_path / "r.usda", verify=True)
    stage = stage_of(written, tmp_path / "out")
    prim = stage.GetPrimAtPath("/r/a")
    assert rules(written).count("lossy-overlap") == pairs
    assert {check.name: check.verdict for check in written.checks}["contact pairs"] == (
        "announced" if pairs else "none"
    )
    targets = UsdPhysics.FilteredPairsAPI(prim).GetFilteredPairsRel().GetTargets()
    assert [str(target) for target in targets] == ["/r/c"] * pairs
    if pairs:
        mjcf = urdftool.export_mjcf(source, exclude="touching")
        ours, theirs = (
            [loss.message for loss in some.losses if loss.code == "lossy-overlap"]
            for some in (written, mjcf)
        )
        assert ours == theirs


def test_an_effort_of_zero_is_not_written(tmp_path, write):
    import urdftool

    limit = '<limit lower="-1" upper="1" effort="0" velocity="1"/>'
    path = write("r.urdf", robot(link("a"), joint("j", "a", "b", "revolute", limit), link("b")))
    written = urdftool.export_usd(urdftool.load(path), tmp_path / "r.usda", verify=True)
    assert read_joint(written, tmp_path, "j")["drive:angular:physics:maxForce"] > 0
    assert rules(written).count("lossy-effort") == 1
    rows = {check.name: check.verdict for check in written.checks}
    assert rows["limits"] in ("equal", "announced")


@pytest.mark.library("mujoco")
def test_a_slide_without_a_limit_stays_free(write, urdftool, tmp_path):
    write(
        "m.sdf",
        """<sdf version="1.9"><model name="m"><link name="base"/>
<joint name="w" type="fixed"><parent>world</parent><child>base</child></joint>
<link name="cart"><inertial><mass>1</mass><inertia><ixx>.01</ixx><iyy>.01</iyy><izz>.01</izz>
</inertia></inertial><collision name="c"><geometry><box><size>.2 .2 .2</size></box></geometry>
</collision></link><joint name="s" type="prismatic"><parent>base</parent><child>cart</child>
<axis><xyz>1 0 0</xyz></axis></joint></model></sdf>""",
    )
    result = urdftool("export", "usd", "m.sdf", "-o", tmp_path / "out", "--verify")
    (row,) = [line for line in result.out.splitlines() if line.startswith("limits  ")]
    assert row.endswith("announced")
    assert "effort limits added: 1 ('s')" in result.out
