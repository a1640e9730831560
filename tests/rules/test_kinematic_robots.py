"""Robots for kinematics or display, and the fields that exporters leave empty."""

from itertools import pairwise

import pytest

from urdftool.api.lint import check

SHAPE = "<visual>{0}</visual><collision>{0}</collision>".format(
    '<geometry><box size="0.1 0.1 0.3"/></geometry>'
)
MASS = (
    '<inertial><mass value="1"/><inertia ixx="0.0083" ixy="0" ixz="0" iyy="0.0083" iyz="0" '
    'izz="0.0017"/></inertial>'
)
JOINT = (
    '<joint name="{0}_joint" type="{1}"><parent link="{2}"/><child link="{0}"/>'
    '<origin xyz="0 0 0.4"/><axis xyz="0 1 0"/>{3}</joint>'
)
EMPTY = '<limit lower="{0}" upper="{1}" effort="{2}" velocity="{3}"/>'
NAMES = ("base", "left_hip", "right_hip", "left_toe", "right_toe", "waist", "neck")


def write(folder, insides, limits=None, kind="revolute"):
    """Write a chain of links with what is in them, and the limits of each joint."""
    limits = limits or {}
    text = "".join(f'<link name="{name}">{insides(name)}</link>' for name in NAMES)
    for above, name in pairwise(NAMES):
        limit = EMPTY.format(*limits.get(name, (-1, 1, 10, 1)))
        text += JOINT.format(name, kind, above, limit)
    path = folder / "robot.urdf"
    path.write_text(f'<robot name="r">{text}</robot>')
    return path


def find(path, *rules, **options):
    return [one for one in check(path, grouped=True, **options) if one.code in rules]


def test_a_robot_without_any_mass_is_one_info(tmp_path):
    rules = "missing-inertial", "zero-effort-limit", "zero-velocity-limit", "missing-collision"
    none = dict.fromkeys(NAMES, (-1, 1, 0, 0))
    path = write(tmp_path, lambda _: SHAPE, none)
    assert not find(path, *rules), "nothing shows that ROS reads it"
    ros = {"targets": ["ros2"]}
    (found,) = find(path, *rules, **ros)
    assert (found.code, found.severity.label, found.kind) == ("missing-inertial", "info", "robot")
    (bare,) = find(
        write(tmp_path, lambda _: SHAPE.partition("<coll")[0], none), *rules, select=rules[:1]
    )
    assert "<inertial> or a <collision>" in bare.message
    (frames,) = find(write(tmp_path, lambda _: "", none), *rules, select=["missing-inertial"])
    assert frames.code == "missing-inertial"


def test_a_robot_without_any_mass_is_rejected_by_a_target_that_needs_it(tmp_path):
    path = write(tmp_path, lambda _: SHAPE)
    for target in ("gz", "mujoco", "pybullet"):
        found = find(path, "missing-inertial", targets=[target])
        assert "error" in {one.severity.label for one in found}


def test_one_link_that_lost_its_mass_is_reported(tmp_path):
    path = write(tmp_path, lambda name: SHAPE + MASS * (name != "waist"))
    (found,) = find(path, "missing-inertial")
    assert (found.name, found.severity.label) == ("waist", "warning")


def test_what_mujoco_does_with_a_robot_without_mass(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    for inside, key in ((SHAPE, "computes"), ("", "rejects")):
        path = write(tmp_path, lambda _, inside=inside: inside)
        (found,) = find(path, "missing-inertial", select=["missing-inertial"])
        assert found.effects["mujoco"].startswith(key)
        if inside:
            model = mujoco.MjModel.from_xml_path(str(path))
            assert model.body_mass[1:].min() == pytest.approx(1000 * 0.1 * 0.1 * 0.3)
        else:
            with pytest.raises(ValueError, match="mass and inertia of moving bodies"):
                mujoco.MjModel.from_xml_path(str(path))


ZERO = (-1, 1, 0, 1)


@pytest.mark.parametrize(
    ("limits", "level"),
    [
        ({"waist": ZERO}, "warning"),  # one joint that lost its effort
        ({"left_toe": ZERO, "right_toe": ZERO}, "info"),  # passive on both sides
        ({"left_toe": ZERO}, "warning"),
        (dict.fromkeys(NAMES, (-1, 1, 0, 0)), "info"),  # as an exporter writes them
        (dict.fromkeys(NAMES, ZERO), "info"),
    ],
)
def test_limits_of_effort_that_are_meant_are_a_remark(tmp_path, limits, level):
    path = write(tmp_path, lambda _: SHAPE + MASS, limits)
    assert len(find(path, "zero-effort-limit")) == (level == "warning")
    (found,) = find(path, "zero-effort-limit", select=["zero-effort-limit"])
    assert found.severity.label == level
    (found,) = find(path, "zero-effort-limit", targets=["gz"])
    assert found.severity.label == "error"


@pytest.mark.parametrize(
    ("bounds", "targets", "count"),
    [((0, 0), [], 0), ((0, 0), ["newton"], 1), ((-1, 1), [], 1), ((0, 1), [], 1)],
)
def test_empty_bounds_of_wheels(tmp_path, bounds, targets, count):
    limits = dict.fromkeys(NAMES, (*bounds, 1, 1))
    path = write(tmp_path, lambda _: SHAPE + MASS, limits, "continuous")
    assert len(find(path, "continuous-with-bounds", targets=targets)) == count
    assert len(find(path, "continuous-with-bounds", select=["continuous-with-bounds"])) == 1
