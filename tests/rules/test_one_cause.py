"""What has one cause is one finding, and what stands for free motion is no slip."""

from itertools import pairwise
from pathlib import Path

import pytest

from tests.conftest import FIXTURES
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
    [("limit-in-degrees", "revolute"), ("prismatic-in-millimeters", "prismatic")],
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


SEEN = """<link name="l{0}"><inertial><origin xyz="{1}"/><mass value="{2}"/>
<inertia ixx="0.002" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.002"/></inertial>
<visual><geometry><mesh filename="{3}"/></geometry></visual>
<collision><geometry><mesh filename="{3}"/></geometry></collision></link>
"""


def meshes(count, mesh, com="0 0 0", mass="1"):
    return (
        f"<robot name='r'>{''.join(SEEN.format(n, com, mass, mesh) for n in range(count))}</robot>"
    )


def block(faces):
    """A box of a decimetre as binary STL, with its first triangle as often as is wanted."""
    data = (FIXTURES / "rules" / "ascii-stl" / "meshes" / "arm.stl").read_bytes()
    rows = data[84:] + data[84:134] * faces
    return data[:80] + (len(rows) // 50).to_bytes(4, "little") + rows


def test_dense_visual_meshes_that_collide_are_one_finding_that_names_the_links(write):
    write("dense.stl", block(6000))
    path = write("r.urdf", meshes(5, "dense.stl"))
    (finding,) = check(path, select=("visual-mesh-as-collision",), targets=("moveit",))
    assert finding.severity.label == "warning"
    assert finding.name == "l0"
    assert "so do 'l1', 'l2', 'l3', 'l4'" in finding.message


@pytest.mark.parametrize(
    ("targets", "severity"),
    [((), None), (("mujoco",), None), (("moveit",), "warning"), (("gz", "mujoco"), "warning")],
)
def test_dense_meshes_of_which_readers_take_the_hull_are_off(write, targets, severity):
    write("dense.stl", block(6000))
    robot = meshes(2, "dense.stl").replace("</robot>", JOINED)
    found = check(write("r.urdf", robot), targets=targets)
    names = [f.severity.label for f in found if f.code == "visual-mesh-as-collision"]
    assert names == ([severity] if severity else [])


JOINED = (
    """<joint name="j" type="continuous"><parent link="l0"/><child link="l1"/></joint></robot>"""
)


def test_a_link_of_a_dense_mesh_is_not_named_again_for_another_mesh(write):
    write("dense.stl", block(6000))
    write("plain.stl", block(600))
    both = "".join(
        f'<{kind}><geometry><mesh filename="{name}.stl"/></geometry></{kind}>'
        for kind in ("visual", "collision")
        for name in ("dense", "plain")
    )
    path = write("r.urdf", f'<robot name="r"><link name="a">{both}</link></robot>')
    (finding,) = check(path, select=("visual-mesh-as-collision",), targets=("moveit",))
    assert finding.severity.label == "warning"


@pytest.mark.parametrize(("count", "findings"), [(8, 1), (4, 4)])
def test_many_odd_densities_are_one_remark(write, count, findings):
    write("arm.stl", block(0))
    path = write("r.urdf", meshes(count, "arm.stl", mass="1.6"))
    found = check(path, select=("implausible-density",))
    assert len(found) == findings
    assert all(f"'l{number}'" in "".join(map(str, found)) for number in range(count))


@pytest.mark.parametrize(("count", "findings"), [(8, 1), (4, 4)])
def test_many_centres_just_outside_are_one_remark(write, count, findings):
    write("arm.stl", block(0))
    path = write("r.urdf", meshes(count, "arm.stl", com="0.07 0 0"))
    found = check(path, select=("com-outside-geometry",))
    assert {finding.severity.label for finding in found} == {"info"}
    assert len(found) == findings
    assert all(f"'l{number}'" in "".join(map(str, found)) for number in range(count))


def test_files_of_a_folder_of_another_machine_are_one_finding_with_one_fix(write, tmp_path):
    names = [f"arm_{number}.stl" for number in range(6)]
    for name in names:
        write(f"cart/meshes/{name}", block(0))
    write("cart/package.xml", "<package><name>cart</name></package>")
    robot = meshes(6, "/home/me/cart/meshes/arm_NUMBER.stl")
    for number in range(6):
        robot = robot.replace("NUMBER", str(number), 2)
    path = write("cart/r.urdf", robot)
    (finding,) = check(path, select=("absolute-path",), fixes=True)
    assert "5 more meshes refer to folder /home/me/cart/meshes" in finding.message
    assert len(finding.fix.replacements) == 12


TWO = """<transmission name="t{0}"><type>transmission_interface/SimpleTransmission</type>
<joint name="j{0}"><hardwareInterface>a</hardwareInterface><hardwareInterface>b</hardwareInterface>
</joint></transmission>
"""


def test_several_interfaces_are_one_finding_that_names_the_joints(write):
    text = chain(4, 'lower="-1" upper="1" effort="9" velocity="9"')
    text = text.replace("</robot>", "".join(map(TWO.format, ["l0", "l1", "l2"])) + "</robot>")
    rule = ("several-hardware-interfaces",)
    (finding,) = check(write("r.urdf", text), select=rule, targets=("ros1",))
    assert "joint 'jl0'" in finding.message
    assert "the same applies to 'jl1', 'jl2'" in finding.message


def test_followers_that_are_fixed_are_one_finding(write):
    text = chain(4, "", "fixed").replace("<limit />", '<mimic joint="lead"/>')
    lead = JOINT.format("l4", "end", "revolute", 'lower="0" upper="1"').replace("jl4", "lead")
    text = text.replace("</robot>", LINK.format("end") + lead + "</robot>")
    (finding,) = check(write("r.urdf", text), select=("mimic-dof-mismatch",))
    assert finding.data == {"type": "fixed", "joints": ["jl0", "jl1", "jl2", "jl3"]}


@pytest.mark.parametrize(("joints", "count"), [("a", 1), ("ab", 0)])
def test_transmissions_of_several_joints_have_no_first_interface(write, joints, count):
    interfaces = (
        "<hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>" * 2
    )
    inner = "".join(f'<joint name="{name}">{interfaces}</joint>' for name in joints)
    path = write(
        "r.urdf",
        f"<robot name='r'><link name='l'/><transmission name='t'>{inner}</transmission></robot>",
    )
    found = check(path, select=("several-hardware-interfaces",), targets=("ros1",))
    assert len(found) == count


@pytest.mark.parametrize(("faces", "count"), [(5000, 0), (5001, 1)])
def test_a_visual_mesh_of_few_triangles_may_collide(write, faces, count):
    write("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + "f 1 2 3\n" * faces)
    path = write("r.urdf", meshes(1, "part.obj"))
    assert len(check(path, select=("visual-mesh-as-collision",))) == count


def test_files_of_one_folder_in_another_case_are_one_finding(tmp_path, urdftool):
    (tmp_path / ".git").mkdir()
    (tmp_path / "meshes").mkdir()
    for name in ("a", "b"):
        (tmp_path / "meshes" / f"{name}.stl").write_bytes(block(0))
    shape = '<visual><geometry><mesh filename="meshes/{}"/></geometry></visual>'
    for robot, files in (("one", ("a.STL", "b.STL")), ("two", ("a.STL", "b.stl"))):
        visuals = "".join(map(shape.format, files))
        text = f'<robot name="{robot}"><link name="l">{visuals}</link></robot>'
        (tmp_path / f"{robot}.urdf").write_text(text)
    result = urdftool("lint", tmp_path, "--select", "mesh-case-mismatch", "--format", "concise")
    assert result.code == 1
    assert result.out.count("[mesh-case-mismatch]") == 1
    assert "3 URIs of meshes differ in case from the files in" in result.out
    assert "first 'meshes/a.STL' from 'a.stl'" in result.out
