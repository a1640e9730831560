"""The row ``runs``: what becomes of a free robot from its start, also before it has settled."""

import pytest

from urdftool.formats.common.losses import DeclaredLosses
from urdftool.formats.mjcf.verify_runs import check_runs

pytestmark = pytest.mark.library("mujoco")

ROBOT = """<mujoco><compiler angle="radian"/><option timestep="{timestep}"/>
<worldbody><geom type="plane" size="0 0 1"/>
<body pos="0 0 {height}"><freejoint/><geom type="box" size="0.1 0.1 0.1" mass="5"/>
{legs}</body></worldbody>{actuators}</mujoco>"""

LEG = """<body pos="{x} {y} -0.1"><joint name="{name}" axis="0 1 0" range="-1 1" limited="true"/>
<geom type="capsule" fromto="0 0 0 {bend} 0 -0.2" size="0.02" mass="0.2"/></body>"""

CORNERS = {"a": (0.1, 0.1), "b": (0.1, -0.1), "c": (-0.1, 0.1), "d": (-0.1, -0.1)}


def make(folder, *, height=0.32, legs=4, bend=0.05, servos=False, timestep=0.002):
    """Write a box on legs that do not stand straight, or without a leg."""
    chosen = list(CORNERS.items())[:legs]
    inside = "".join(LEG.format(x=x, y=y, bend=bend, name=n) for n, (x, y) in chosen)
    driven = "".join(f'<position joint="{n}" kp="200" kv="5"/>' for n, _ in chosen)
    actuators = f"<actuator>{driven}</actuator>" if servos and driven else ""
    path = folder / "model.xml"
    path.write_text(
        ROBOT.format(height=height, legs=inside, actuators=actuators, timestep=timestep)
    )
    return path


def runs(path):
    return check_runs(path, DeclaredLosses(frozenset()), excluded=False)


def test_a_box_on_the_floor_stays(tmp_path):
    check = runs(make(tmp_path, height=0.1, legs=0))
    assert (check.verdict, check.announced) == ("equal", [])


@pytest.mark.parametrize("name", ["model.xml", "model.mjcf"])
def test_a_model_without_a_floor_runs_whatever_its_file_is_called(tmp_path, name):
    path = make(tmp_path, height=0.1, legs=0)
    text = path.read_text().replace('<geom type="plane" size="0 0 1"/>', "")
    (tmp_path / name).write_text(text)
    assert runs(tmp_path / name).verdict == "equal"


def test_servos_hold_the_legs(tmp_path):
    assert runs(make(tmp_path, servos=True)).verdict == "equal"


def test_legs_without_servos_fall(tmp_path):
    check = runs(make(tmp_path))
    assert check.verdict == "announced"
    assert all(text.startswith("falls: ") for text in check.announced)
    assert all(text.endswith("not held: no servo") for text in check.announced)


def test_a_motor_is_no_servo(tmp_path):
    path = make(tmp_path, servos=True)
    path.write_text(path.read_text().replace('kp="200" kv="5"', "").replace("<position", "<motor"))
    assert all(text.endswith("not held: no servo") for text in runs(path).announced)
    assert runs(path).announced


def test_an_arm_without_a_servo_is_not_equal(tmp_path):
    path = make(tmp_path, height=1)
    path.write_text(path.read_text().replace("<freejoint/>", ""))
    check = runs(path)
    assert check.verdict == "announced"
    assert all(text.startswith("joints move by up to ") for text in check.announced)


@pytest.mark.parametrize(("gain", "verdict"), [("0.3", "announced"), ("200", "equal")])
def test_an_arm_whose_servo_is_weak_is_not_equal(tmp_path, gain, verdict):
    path = make(tmp_path, height=1, servos=True)
    weak = path.read_text().replace('kp="200" kv="5"', f'kp="{gain}" kv="0.1"')
    path.write_text(weak.replace("<freejoint/>", ""))
    check = runs(path)
    assert check.verdict == verdict
    assert not [text for text in check.announced if "not held" in text]


def test_a_robot_that_starts_above_the_floor_sags(tmp_path):
    check = runs(make(tmp_path, height=0.125, legs=0))
    assert check.verdict == "announced"
    assert [text.partition(",")[0] for text in check.announced] == ["sags by 0.025 m"] * 2


def test_the_step_of_the_model_is_run(tmp_path):
    assert "1 and 5 ms" in runs(make(tmp_path, height=0.1, legs=0, timestep=0.001)).what


@pytest.mark.parametrize(
    ("shape", "low"),
    [
        ('type="sphere" size="0.1"', 0.1),
        ('type="capsule" size="0.1 0.2"', 0.1 + 0.1),
        ('type="cylinder" size="0.1 0.2"', 0.1 + 0.1 * 3**0.5 / 2),
        ('type="ellipsoid" size="0.1 0.2 0.2"', (0.01 * 0.75 + 0.04 * 0.25) ** 0.5),
        ('type="box" size="0.1 0.2 0.2"', 0.1 * 3**0.5 / 2 + 0.1),
    ],
)
def test_the_lowest_point_of_a_turned_shape_is_exact(shape, low):
    """Of shapes that are turned by 60° about y, beside a plane that is not counted."""
    import mujoco

    from urdftool.formats.mjcf.model_motion import compute_lowest_point

    model = mujoco.MjModel.from_xml_string(
        '<mujoco><compiler angle="radian"/><worldbody><geom type="plane" size="0 0 1"/>'
        f'<geom {shape} euler="0 {3.141592653589793 / 3} 0"/></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert compute_lowest_point(mujoco, model, data) == pytest.approx(-low, abs=1e-9)


OBJECT = '<body name="ball" pos="2 0 0.5"><freejoint/><geom size="0.1" mass="1"/></body>'


def test_an_object_that_drops_is_not_the_base_of_an_arm_that_is_held(tmp_path):
    path = make(tmp_path, height=1, servos=True)
    text = (
        path.read_text()
        .replace("<freejoint/>", "")
        .replace('kp="200" kv="5"', 'kp="20" kv="0.4"')
        .replace("</worldbody>", f"{OBJECT}</worldbody>")
    )
    path.write_text(text)
    found = runs(path).announced
    assert found
    assert all(one.startswith("falls: body 'ball' moves by 0.4 m") for one in found)


def test_an_arm_that_sinks_beside_an_object_is_named(tmp_path):
    path = make(tmp_path, height=1)
    resting = OBJECT.replace("0.5", "0.1")
    text = (
        path.read_text()
        .replace("<freejoint/>", "")
        .replace("</worldbody>", f"{resting}</worldbody>")
    )
    path.write_text(text)
    found = runs(path).announced
    assert found
    assert all("joints move by up to" in one and one.endswith("no servo") for one in found)


def test_joints_that_a_tendon_servo_holds_are_held(tmp_path):
    path = make(tmp_path, height=1, legs=1)
    tendon = """<tendon><fixed name="t"><joint joint="a" coef="1"/></fixed></tendon>
<actuator><position tendon="t" kp="0.3" kv="0.1"/></actuator>"""
    text = path.read_text().replace("<freejoint/>", "").replace("</mujoco>", f"{tendon}</mujoco>")
    path.write_text(text)
    found = runs(path).announced
    assert found
    assert not [one for one in found if "no servo" in one]


ARM = """<body pos="0 0.12 0.05"><joint name="arm" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0 0 0 0.2" size="0.01" mass="0.05"/></body>"""


def test_an_arm_that_drops_on_a_robot_that_stands_is_named(tmp_path):
    """The arm is balanced upright, and only the nudge at the start lets it fall."""
    path = make(tmp_path, height=0.1, legs=0)
    short = ARM.replace("0.2", "0.1")
    path.write_text(
        path.read_text().replace("\n</body></worldbody>", f"{short}</body></worldbody>")
    )
    found = runs(path).announced
    assert len(found) == 2
    assert all(one.startswith("stands, its joints sag by up to ") for one in found)
    assert all(one.endswith("'arm' most (at 2 ms); not held: no servo") for one in found[:1])


def test_a_pole_that_is_balanced_upright_is_not_equal(tmp_path):
    path = make(tmp_path, height=1, legs=0)
    text = (
        path.read_text()
        .replace("<freejoint/>", "")
        .replace("\n</body></world", f"{ARM}</body></world")
    )
    path.write_text(text)
    assert all(one.startswith("joints move by up to ") for one in runs(path).announced)
    assert runs(path).verdict == "announced"


@pytest.mark.parametrize(("limit", "holds"), [("3", True), ("0.02", False)])
def test_motors_of_an_arm_get_the_torque_that_gravity_needs(tmp_path, limit, holds):
    """Motors hold nothing by themselves, which the row says; a limit that is too low shows."""
    path = make(tmp_path, height=1, servos=True)
    text = path.read_text().replace("<freejoint/>", "").replace("<position", "<motor")
    path.write_text(
        text.replace('kp="200" kv="5"', f'ctrllimited="true" ctrlrange="-{limit} {limit}"')
    )
    found = runs(path).announced
    assert found[-1] == "4 motors without a servo got the torque that gravity needs"
    assert (len(found) == 1) == holds


def test_a_hand_that_comes_to_rest_on_the_floor_is_named(tmp_path):
    path = make(tmp_path, height=0.1, legs=0)
    arm = ARM.replace('pos="0 0.12 0.05"', 'name="hand" pos="0 0.12 0"').replace("0.2", "0.15")
    path.write_text(path.read_text().replace("\n</body></worldbody>", f"{arm}</body></worldbody>"))
    found = runs(path).announced
    assert found
    assert all("'hand' comes to rest on the ground" in one for one in found)


def test_a_wheel_that_turns_does_not_sag(tmp_path):
    path = make(tmp_path, height=0.1, legs=0)
    wheel = """<body pos="0.2 0 0"><joint name="wheel" axis="0 1 0"/><geom type="cylinder"
size="0.05 0.01" quat="1 1 0 0" mass="0.1"/></body>"""
    text = path.read_text().replace("\n</body></worldbody>", f"{wheel}</body></worldbody>")
    text = text.replace(
        "</worldbody>",
        "</worldbody><actuator><velocity joint='wheel' kv='1' "
        "name='w'/></actuator><keyframe><key name='home' ctrl='9'/></keyframe>",
    )
    path.write_text(text)
    assert not [one for one in runs(path).announced if "sag" in one]


CROSSED = """<mujoco><compiler angle="radian"/><worldbody>
<body name="base" pos="0 0 1">{root}<geom size="0.05"/>{bodies}</body></worldbody>
<actuator>{servos}</actuator>{mimic}</mujoco>"""


def cross(folder, root="", mimic=""):
    """Write two pendulums with limits, whose bobs are at one place."""
    bob = '<joint name="{0}" axis="0 1 0" range="-0.1 0.1"/><geom pos="0 0 -0.2" size="0.05"/>'
    bodies = "".join(f'<body pos="{x} 0 -0.1">{bob.format(n)}</body>' for n, x in BOBS.items())
    servos = "".join(f'<position joint="{n}" kp="2" dampratio="1"/>' for n in BOBS)
    path = folder / "model.xml"
    path.write_text(CROSSED.format(root=root, bodies=bodies, servos=servos, mimic=mimic))
    return path


BOBS = {"a": 0.01, "b": -0.01}


@pytest.mark.parametrize("collides", [True, False])
def test_links_that_do_not_collide_with_each_other_are_not_pushed_apart(tmp_path, collides):
    path, declared = cross(tmp_path), DeclaredLosses(frozenset())
    check = check_runs(path, declared, excluded=True, self_collides=collides)
    assert check.verdict == ("differs" if collides else "equal")


def test_links_that_do_not_collide_with_each_other_rest_on_the_floor(tmp_path):
    path, declared = make(tmp_path, servos=True), DeclaredLosses(frozenset())
    assert check_runs(path, declared, excluded=True, self_collides=False).verdict == "equal"


def test_a_joint_that_follows_is_carried_as_the_one_that_it_follows(tmp_path):
    mimic = '<equality><joint joint1="a" joint2="b" polycoef="0 -1 0 0 0"/></equality>'
    check = runs(cross(tmp_path, "<freejoint/>", mimic))
    assert not check.differing
    assert [text for text in check.announced if "joint 'a' leaves its limits" in text]
