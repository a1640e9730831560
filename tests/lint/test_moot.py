"""What a reader does with a defect is not said where it rejects the robot for another one."""

import pytest

from urdftool import check
from urdftool.lint.moot import in_singular

LINK = (
    '<link name="{0}"><inertial><mass value="1"/>'
    '<inertia ixx="{1}" ixy="0" ixz="0" iyy="{1}" iyz="0" izz="{1}"/></inertial></link>'
)
JOINT = (
    '<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/>'
    '<axis xyz="0 0 1"/>{3}</joint>'
)
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def robot(*parts):
    return f'<robot name="r">{"".join(parts)}</robot>'


def effects(path, rule, *others):
    found = check(path, select=[rule, *others])
    return {name for f in found if f.rule == rule for key in f.effects for name in key.split(", ")}


def test_urdfdom_takes_no_inertia_of_a_robot_that_it_rejects(write):
    links = LINK.format("a", 0.01), LINK.format("b", 1)
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", "")))
    alone = effects(path, "placeholder-inertia")
    assert {"gz", "gazebo-classic", "mujoco", "pinocchio", "drake"} <= alone
    beside = effects(path, "placeholder-inertia", "missing-limit")
    assert beside == alone - {"gz", "gazebo-classic", "pinocchio"}


def test_a_rejection_stays_with_its_own_finding(write):
    links = LINK.format("a", 0.01), LINK.format("b", 1)
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", "")))
    assert {"urdfdom", "gz", "pinocchio"} <= effects(path, "missing-limit", "placeholder-inertia")


def test_without_another_defect_all_is_said(write):
    links = LINK.format("a", 0.01), LINK.format("b", 1)
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", LIMIT)))
    alone = effects(path, "placeholder-inertia")
    assert alone == effects(path, "placeholder-inertia", "missing-limit")


@pytest.mark.parametrize(
    ("several", "one"),
    [
        ("take it as written", "takes it as written"),
        ("pass it on", "passes it on"),
        ("have no link", "has no link"),
        ("apply the unit", "applies the unit"),
        ("accept it: nothing", "accepts it: nothing"),
        ("display: nothing", "displays: nothing"),
    ],
)
def test_a_verb_in_singular(several, one):
    assert in_singular(several) == one


def test_drake_loads_nothing_of_a_file_with_a_comma(write):
    links = LINK.format("a", 0.01), LINK.format("b", 1)
    limit = LIMIT.replace('effort="1"', 'effort=",5"')
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", limit)))
    assert "drake" in effects(path, "placeholder-inertia")
    assert not {"drake", "gz", "mujoco"} & effects(path, "placeholder-inertia", "not-a-number")
    assert "drake" in effects(path, "not-a-number")


def test_an_effect_of_another_case_rejects_nothing(write):
    mass = '<inertial><mass value="0"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    light = f'<link name="c">{mass}</inertial></link>'
    links = LINK.format("a", 0.01), LINK.format("b", 1), light
    fixed = JOINT.format("k", "b", "c", "").replace("revolute", "fixed")
    path = write("r.urdf", robot(*links, JOINT.format("j", "a", "b", LIMIT), fixed))
    alone = effects(path, "placeholder-inertia")
    assert "gz" in alone
    assert "gz" in effects(path, "placeholder-inertia", "zero-mass")
