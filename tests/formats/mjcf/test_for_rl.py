"""``--for rl``: what it adds, and that it keeps the values of the description and of the user."""

import pytest

from tests.formats.mjcf.robots import export, find, tree
from tests.formats.test_standing_pose import quadruped
from tests.formats.test_upright import write_robot
from urdftool.compare.check import is_faithful
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.verify import verify_copy
from urdftool.formats.mjcf.write import write as write_mjcf
from urdftool.model.load import load


def export_for_rl(path, **choices):
    return write_mjcf(load(path), Options(base="free", purpose="rl", **choices).complete())


def test_additions_are_written(write):
    """Effort limits of 30 N·m give an armature of 0.012 kg·m² and a friction loss of 0.15 N·m."""
    model = tree(export_for_rl(write("r.urdf", quadruped())))
    tags = [sensor.tag for sensor in model.find("sensor")]
    assert {tag: tags.count(tag) for tag in tags} == {
        "framelinvel": 1, "gyro": 1, "accelerometer": 1, "framequat": 1,
        "jointpos": 8, "jointvel": 8, "jointactuatorfrc": 8,
    }  # fmt: skip
    texts = [joint for joint in model.iter("joint") if joint.get("armature")]
    assert {joint.get("armature") for joint in texts} == {"0.012"}
    assert {joint.get("frictionloss") for joint in texts} == {"0.15"}
    condims = [geom for geom in model.iter("geom") if geom.get("condim") == "6"]
    assert condims
    assert {geom.get("priority") for geom in condims} == {"1"}
    assert {actuator.tag for actuator in model.find("actuator")} == {"position"}


@pytest.mark.parametrize("adds", [True, False])
def test_additions_are_not_called_equal_to_the_source(write, adds):
    found = load(write("r.urdf", quadruped()))
    choices = {"purpose": "rl"} if adds else {"actuators": "none"}
    options = Options(base="free", **choices).complete()
    checks = verify_copy(found, options, write_mjcf(found, options))
    rows = {check.name: check for check in checks if check.tolerance < 1e-8}
    names = ("joint physics", "surface", "sensors")
    assert {rows[name].verdict == "announced" for name in names} == {adds}
    text = "armature added or changed at 8 of 8 joints (largest: 0.012, of "
    assert [one.startswith(text) for one in rows["joint physics"].announced[:1]] == [True] * adds
    assert is_faithful(checks)


@pytest.mark.parametrize(("radius", "feet"), [(0.02, 4), (0.3, 0)])
def test_a_continuous_joint_moves_a_foot_unless_it_turns_a_wheel(write, tmp_path, radius, feet):
    """Straight legs end in balls; of the height of the robot, they are wheels around their axes."""
    path = write_robot(tmp_path, up=2)
    text = path.read_text().replace('type="revolute"', 'type="continuous"')
    down = "0 0 0" if radius > 0.1 else "0 0 -0.3"
    text = text.replace('xyz="0 0 -0.3"', f'xyz="{down}"').replace('"0.02"', f'"{radius}"')
    model = tree(export_for_rl(write("r.urdf", text)))
    assert sum(geom.get("condim") == "6" for geom in model.iter("geom")) == feet


def test_values_of_description_and_user_are_kept(write):
    text = quadruped().replace(
        'effort="30" velocity="20"/>',
        'effort="30" velocity="20"/><dynamics friction="0.5" damping="0"/>',
    )
    model = tree(export_for_rl(write("r.urdf", text), armature=0.02))
    values = {(j.get("armature"), j.get("frictionloss")) for j in model.iter("joint")}
    assert ("0.02", "0.5") in values
    assert not {"0.012", "0.15"} & {text for pair in values for text in pair}


@pytest.mark.parametrize(("kind", "tag"), [("revolute", "position"), ("continuous", "motor")])
def test_motors_that_do_not_roll_become_servos(write, kind, tag):
    limit = '<limit lower="-1" upper="1" effort="5" velocity="9"/>'
    path = write("r.urdf", (
        '<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>'
        f'<joint name="j" type="{kind}"><parent link="a"/><child link="b"/>{limit}</joint>'
        '<transmission name="t"><type>transmission_interface/SimpleTransmission</type><joint '
        'name="j"><hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>'
        '</joint><actuator name="m"/></transmission></robot>'
    ))  # fmt: skip
    described = tree(export(path))
    assert find(described, "motor", "j") is not None
    written = write_mjcf(load(path), Options(purpose="rl").complete())
    assert find(tree(written), tag, "j") is not None
