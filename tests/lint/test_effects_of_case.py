"""A finding has those effects of its rule that hold in its case."""

import pytest

from urdftool import check
from urdftool.rules import get_rule

MASS = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
)
KEPT = '<mujoco><compiler discardvisual="false"/></mujoco>'


def box(tag, text="0.1 0 0.1"):
    return f'<{tag}><geometry><box size="{text}"/></geometry></{tag}>'


def readers(path, rule):
    return [list(finding.effects) for finding in check(path, select=[rule])]


@pytest.mark.parametrize(
    ("inside", "has"),
    [
        (box("collision"), {"mujoco", "drake"}),
        (box("visual"), {"drake"}),
        (f"{box('visual')}</link>{KEPT}<link name='b'>", {"mujoco", "drake"}),
        ('<visual><geometry><sphere radius="0"/></geometry></visual>', set()),
    ],
)
def test_a_reader_is_named_where_it_does_what_is_said(write, inside, has):
    path = write("r.urdf", f'<robot name="r"><link name="a">{MASS}{inside}</link></robot>')
    (found,) = readers(path, "non-positive-dimension")
    silent = "urdfdom, gz, gazebo-classic, pybullet, pinocchio"
    assert set(found) == {silent, *has}
    assert found == [key for key in get_rule("non-positive-dimension").effects if key in found]


def test_findings_with_other_effects_are_not_one(write):
    links = "".join(
        f'<link name="{name}">{box("collision" if name in "ab" else "visual")}</link>'
        for name in "abcd"
    )
    path = write("r.urdf", f'<robot name="r">{links}</robot>')
    found = check(path, select=["non-positive-dimension"], grouped=True)
    assert [(f.count, "mujoco" in f.effects) for f in found] == [(2, True), (2, False)]


JOINTED = """<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="{}">
<parent link="a"/><child link="b"/>{}</joint></robot>"""


@pytest.mark.parametrize(
    ("kind", "inside", "has"),
    [
        ("fixed", '<axis xyz="0 1,0 0"/>', {"mujoco"}),
        ("revolute", '<axis xyz="0 1,0 0"/>', {"urdfdom", "mujoco", "pybullet", "drake"}),
        ("revolute", '<axis xyz="0 1 0,5"/>', {"urdfdom", "mujoco", "pybullet", "drake"}),
        ("fixed", '<dynamics damping="x"/>', {"urdfdom", "pybullet"}),
        ("continuous", '<limit lower="x"/>', {"urdfdom", "pybullet", "drake"}),
        ("revolute", '<limit velocity="x"/>', {"urdfdom", "pybullet", "drake"}),
        ("revolute", '<safety_controller k_velocity="x"/>', {"urdfdom"}),
        ("revolute", '<calibration rising="0,1"/>', {"urdfdom"}),
        ("revolute", '<limit jerk="x"/>', set()),
    ],
)
def test_only_readers_that_read_a_number_are_named(write, kind, inside, has):
    path = write("r.urdf", JOINTED.format(kind, inside))
    (found,) = readers(path, "not-a-number")
    assert {key.partition(",")[0] for key in found} == has


@pytest.mark.parametrize(
    ("shape", "rejects"),
    [
        ('<sphere radius="0,1"/>', False),
        ('<sphere radius="x"/>', True),
        ('<sphere radius=""/>', True),
        ('<cylinder radius="0,1" length="1"/>', True),
        ('<cylinder radius="1m" length="1"/>', False),
        ('<box size="1 1 0,1"/>', True),
        ('<box size="1 1 1m"/>', False),
        ('<box size="1 1m 1"/>', True),
        ('<box size="1,0 1 1m"/>', True),
    ],
)
def test_drake_reads_as_far_as_it_can(write, shape, rejects):
    link = f'<link name="a"><collision><geometry>{shape}</geometry></collision></link>'
    path = write("r.urdf", f'<robot name="r">{link}</robot>')
    (finding,) = check(path, select=["not-a-number"])
    assert finding.effects["drake"].startswith("rejects" if rejects else "reads")
