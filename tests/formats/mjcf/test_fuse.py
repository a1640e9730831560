"""Links that are merged into what they are fixed to; classes of joints and feet; digits."""

import numpy as np
import pytest

from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.verify import verify_copy
from urdftool.formats.mjcf.write import write as write_mjcf
from urdftool.model.load import load
from urdftool.model.numbers import number_text, round_noise

from .robots import BOX, INERTIAL, export, find, joint, link, robot, tree

TURNED = '<origin xyz="0.1 0.2 0.3" rpy="0.3 -0.2 1"/>'
COLLIDES = f"{INERTIAL}<collision>{BOX}</collision>"
LIMIT = '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="5" velocity="1"/>'


def arm(*extra):
    """A base with a plate, on it a joint, and a hand with a camera frame behind it."""
    return robot(
        link("base", COLLIDES), link("plate", COLLIDES), link("mount", ""),
        link("upper", COLLIDES), link("hand", COLLIDES), link("eye", INERTIAL),
        joint("p", "base", "plate", "fixed", TURNED), joint("m", "plate", "mount", "fixed", TURNED),
        joint("j", "mount", "upper", inside=TURNED + LIMIT),
        joint("h", "upper", "hand", "fixed", TURNED), joint("e", "hand", "eye", "fixed", TURNED),
        *extra,
    )  # fmt: skip


def bodies(written):
    return [body.get("name") for body in tree(written).iter("body")]


def test_fixed_links_become_sites(write):
    written = export(write("r.urdf", arm()), fuse=True)
    assert bodies(written) == ["base", "upper"]
    sites = {site.get("name"): site for site in tree(written).iter("site")}
    assert {"plate", "mount", "hand", "eye"} <= sites.keys()
    assert sites["eye"].getparent().get("name") == "upper"
    mass = [float(e.get("mass")) for e in tree(written).iter("inertial")]
    assert mass == [2, 3]


SENSOR = '<gazebo reference="j"><sensor name="eye" type="force_torque"/></gazebo>'
"""A sensor with the name of a merged link, whose site gets another name."""


NEAR = (
    link("near", INERTIAL),
    joint("n", "upper", "near", "fixed", '<origin xyz="1 0 0" rpy="0 0 1e-7"/>'),
)
"""A link whose turn is below that which MuJoCo's compiler rounds away in a site, not in a body."""


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(
    ("base", "more"), [("fixed", ()), ("free", ()), ("free", (SENSOR,)), ("fixed", NEAR)]
)
def test_a_merged_model_is_the_same_robot(write, base, more):
    found, options = load(write("r.urdf", arm(*more))), Options(fuse=True, base=base)
    checks = verify_copy(found, options, write_mjcf(found, options))
    rows = {check.name: check for check in checks}
    assert rows["fused"].verdict == "equal", rows["fused"].differing
    assert rows["fused"].worst < 1e-12


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(
    ("before", "after"),
    [('mass="3"', 'mass="3.001"'), ('<site name="eye"', '<site name="ear"'), ("0.5", "0.51")],
)
def test_a_wrong_merged_model_is_noticed(write, before, after):
    found, options = load(write("r.urdf", arm())), Options(fuse=True)
    written = write_mjcf(found, options)
    assert before in written.text
    written.files[written.main] = written.text.replace(before, after).encode()
    checks = {check.name: check for check in verify_copy(found, options, written)}
    assert checks["fused"].verdict == "differs"


def test_a_force_sensor_keeps_its_body(write):
    sensor = '<gazebo reference="h"><sensor name="ft" type="force_torque"/></gazebo>'
    written = export(write("r.urdf", arm(sensor)), fuse=True)
    assert bodies(written) == ["base", "upper", "hand"]


def test_weightless_links_are_not_merged_with_others(write):
    gravity = '<gazebo reference="hand"><turnGravityOff>1</turnGravityOff></gazebo>'
    assert "hand" in bodies(export(write("r.urdf", arm(gravity)), fuse=True))


def legs(*names):
    parts = [link("base", COLLIDES)]
    for name in names:
        parts += [link(f"{name}_shin", COLLIDES), link(f"{name}_foot", COLLIDES)]
        parts.append(joint(f"{name}_knee_joint", "base", f"{name}_shin", inside=LIMIT))
        parts.append(joint(f"{name}_ankle", f"{name}_shin", f"{name}_foot", "fixed", TURNED))
    return robot(*parts)


def test_joints_of_one_role_share_a_class_with_their_gains(write):
    model = tree(export(write("r.urdf", legs("left", "right")), actuators="position"))
    knees = [e for e in model.iter("joint") if e.get("name")]
    assert [dict(e.attrib) for e in knees] == [
        {"name": f"{side}_knee_joint", "class": "knee"} for side in ("left", "right")
    ]
    (default,) = (e for e in model.iter("default") if e.get("class") == "knee")
    assert default.find("joint").get("range") == "-1 1"
    assert default.find("position").get("kp") == "200"
    assert [dict(e.attrib) for e in model.find("actuator")] == [
        {"name": e.get("name"), "class": "knee", "joint": e.get("name")} for e in knees
    ]


def test_feet_have_a_class_and_collisions_a_name(write):
    model = tree(export(write("r.urdf", legs("left", "right"))))
    assert find(model, "geom", "left_foot_collision").get("class") == "foot"
    assert find(model, "geom", "left_shin_collision").get("class") == "collision"
    (default,) = (e for e in model.iter("default") if e.get("class") == "foot")
    assert default.getparent().get("class") == "collision"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (2.3749999999999997e-06, "2.375e-06"),
        (0.1 + 0.2, "0.3"),
        (3.0000000000000018e-06, "3e-06"),
        (1.5707963267948966, "1.5707963267948966"),
        (0.12345678901234, "0.12345678901234"),
        (-0.0, "0"),
        (7.0, "7"),
    ],
)
def test_numbers_have_no_noise(value, text):
    assert number_text(value) == text
    assert abs(float(text) - value) <= 2e-15 * abs(value)


def test_most_numbers_stay_as_they_are():
    values = np.random.default_rng(1).normal(size=1000)
    assert all(round_noise(float(value)) == value for value in values)
