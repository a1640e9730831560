"""What has one cause is one finding, and what stands for free motion is no slip."""

from itertools import pairwise
from pathlib import Path

import pytest

from urdftool import check

LINK = '<link name="{0}"><inertial><mass value="1"/></inertial></link>\n'
JOINT = (
    '<joint name="j{0}" type="{2}"><parent link="{0}"/><child link="{1}"/><axis xyz="0 0 1"/>'
    "<limit {3}/></joint>\n"
)


def chain(count, limit, kind="revolute", link=LINK, name="l{}"):
    names = [name.format(number) for number in range(count + 1)]
    links = "".join(map(link.format, names))
    joints = "".join(JOINT.format(one, other, kind, limit) for one, other in pairwise(names))
    return f"<robot name='r'>\n{links}{joints}</robot>"


@pytest.mark.parametrize(
    ("rule", "limit"),
    [
        ("implausible-velocity", 'lower="-1" upper="1" effort="9" velocity="50000"'),
        ("implausible-effort", 'lower="-1" upper="1" effort="50000" velocity="9"'),
    ],
)
def test_one_number_at_many_joints_is_one_finding(write, rule, limit):
    (finding,) = check(write("many.urdf", chain(7, limit)), select=(rule,))
    assert "jl0' (and 6 more) is 5e+04" in finding.message or "50000" in finding.message
    few = check(write("few.urdf", chain(3, limit)), select=(rule,))
    assert [finding.name for finding in few] == ["jl0", "jl1", "jl2"]


def test_an_empty_prefix_is_one_finding(write):
    path = write("r.urdf", chain(7, "", "continuous", name="/l{}"))
    (finding,) = check(path, select=("invalid-frame-name",), fixes=True)
    assert "8 links" in finding.message
    assert finding.fix is None


@pytest.mark.parametrize(
    ("rule", "kind"),
    [("limit-in-degrees", "revolute"), ("prismatic-in-millimetres", "prismatic")],
)
def test_joints_of_frames_at_the_root_may_go_far(write, rule, kind):
    limit = 'lower="-20" upper="20" effort="9" velocity="9"'
    frames = chain(4, limit, kind, link='<link name="{0}"/>\n')
    assert len(check(write("bare.urdf", frames), select=(rule,))) == 4
    frames = frames.replace("</robot>", LINK.format("arm") + "</robot>")
    assert check(write("frames.urdf", frames), select=(rule,)) == []
    heavy = chain(4, limit, kind)
    assert len(check(write("heavy.urdf", heavy), select=(rule,))) == 4


SENSOR = """<gazebo reference="l{0}"><sensor name="s{0}" type="imu">
</sensor></gazebo>
"""


def test_many_sensors_without_a_frame_are_one_finding_and_one_fix(write, urdftool):
    text = chain(6, "", "continuous")
    text = text.replace("</robot>", "".join(map(SENSOR.format, range(6))) + "</robot>")
    path = write("r.urdf", text)
    only = ("--select", "missing-gz-frame-id", "--no-cache")
    result = urdftool("lint", path, "--fix", *only)
    assert result.code == 0, result.err
    for number in range(6):
        assert f"<gz_frame_id>l{number}</gz_frame_id>" in Path(path).read_text()


def test_an_srdf_of_another_description_is_not_compared(write):
    write("arm.urdf", chain(1, "", "continuous"))
    write("arm.srdf", "<robot name='r'><group name='g'><joint name='jl0'/></group></robot>")
    other = write("hand.urdf", chain(1, "", "continuous", name="h{}"))
    assert check(other, select=("srdf-unknown-joint",), targets=("moveit",)) == []
    Path("arm.srdf").rename("both.srdf")
    assert len(check(other, select=("srdf-unknown-joint",), targets=("moveit",))) == 1
