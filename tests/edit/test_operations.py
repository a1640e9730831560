"""Each operation on an arm with its files, with its proof, and the way back."""

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

import urdftool
from tests.assets import make_png
from tests.edit.robots import (
    ARM,
    ARM_SRDF,
    CONTROLLERS,
    GRIPPER,
    GRIPPER_SRDF,
    LIMITS,
    list_numbers,
)
from urdftool.compare.conventions import mirror_robot
from urdftool.errors import ModelError


@pytest.fixture
def arm(write):
    write("in/arm.srdf", ARM_SRDF)
    write("in/controllers.yaml", CONTROLLERS)
    write("in/joint_limits.yaml", LIMITS)
    return urdftool.load(write("in/arm.urdf", ARM))


@pytest.fixture
def plain(write):
    """Return the arm without files around it."""
    return urdftool.load(write("plain/arm.urdf", ARM))


def read_again(edited, write, name="again/arm.urdf"):
    return urdftool.load(write(name, edited.data.decode()))


OPERATIONS = {
    "prefix": lambda robot: robot.prefix("l_"),
    "merge_fixed": lambda robot: robot.merge_fixed(),
    "merge_frames": lambda robot: robot.merge_fixed(frames=True),
    "root": lambda robot: robot.change_root("wheel"),
    "move_frames": lambda robot: robot.change_root("wheel", move_frames=True),
    "mirror_xz": lambda robot: robot.mirror("xz"),
    "mirror_yz": lambda robot: robot.mirror("yz"),
    "mirror_xy": lambda robot: robot.mirror("xy"),
    "zero": lambda robot: robot.change_zero({"shoulder": 0.5, "slide": 0.05, "follower": 1.0}),
    "sign": lambda robot: robot.reverse_sign(["shoulder", "slide", "follower"]),
    "cut": lambda robot: robot.cut("wheel"),
    "round": lambda robot: robot.round_numbers(1e-6),
}


@pytest.mark.parametrize("name", OPERATIONS)
def test_an_operation_is_proved(plain, name):
    edited = OPERATIONS[name](plain)
    differences = [d.title for p in edited.proofs for d in p.comparison.differences]
    assert edited.is_proved, differences
    assert edited.data != ARM.encode()
    assert b"<!-- an arm -->" in edited.data


BACK = {
    "root": (OPERATIONS["root"], lambda robot: robot.change_root("base")),
    "mirror": (OPERATIONS["mirror_xz"], lambda robot: robot.mirror("xz")),
    "sign": (
        OPERATIONS["sign"],
        lambda robot: robot.reverse_sign(["shoulder", "slide", "follower"]),
    ),
}


@pytest.mark.parametrize("name", BACK)
def test_there_and_back_is_every_byte(plain, write, name):
    there, back = BACK[name]
    result = back(read_again(there(plain), write))
    text = result.data.decode().replace('    <axis xyz="1 0 0"/>\n', "")  # the default, written
    assert text == ARM


def test_zero_and_back_has_equal_numbers(plain, write):
    there = plain.change_zero({"shoulder": 0.5, "slide": 0.05, "follower": 1.0})
    back = read_again(there, write).change_zero(
        {"shoulder": -0.5, "slide": -0.05, "follower": -1.0}
    )
    pairs = zip(ET.fromstring(ARM).iter(), ET.fromstring(back.data).iter(), strict=True)
    for x, y in pairs:
        assert x.tag == y.tag
        for name, value in y.attrib.items():
            numbers = [float(w) if re.match(r"[-.\d]", w) else w for w in value.split()]
            old = [float(w) if re.match(r"[-.\d]", w) else w for w in x.get(name, "0 0 0").split()]
            assert numbers == (pytest.approx(old, abs=1e-14) if name != "name" else old)


def test_root_twice_by_another_link(plain, write):
    robot = read_again(plain.change_root("wheel"), write)
    result = read_again(robot.change_root("camera"), write).change_root("base")
    assert result.is_proved
    assert "__" not in result.data.decode()


def test_link_frames_stay_and_no_link_changes(plain):
    edited = plain.change_root("wheel")
    links = re.findall(r"<link.*?</link>", ARM, re.DOTALL)
    assert len(links) == 5
    assert all(link in edited.data.decode() for link in links)


def test_zero_shifts_everything(arm):
    edited = arm.change_zero({"shoulder": 0.5})
    text = edited.data.decode()
    assert list_numbers(text, 'lower="(.*?)" upper="(.*?)" effort="30"') == [-1.5, 1.5]
    soft = 'soft_lower_limit="(.*?)" soft_upper_limit="(.*?)"'
    assert list_numbers(text, soft) == pytest.approx([-1.4, 1.4])
    assert list_numbers(text, 'rising="(.*?)"') == pytest.approx([-0.4])
    assert list_numbers(text, 'min">(.*?)<.*?max">(.*?)<') == [-1.5, 1.5]
    assert list_numbers(text, 'initial_value">(.*?)<') == [0.0]
    files = {name: data.decode() for name, data in edited.files.items()}
    assert 'name="shoulder" value="0"' in files["arm.srdf"]
    assert "min_position: -1.5" in files["joint_limits.yaml"]
    assert "shoulder: 0\n" in files["joint_limits.yaml"]
    assert edited.is_proved


def test_a_joint_without_bounds_gets_none(write):
    text = ARM.replace('<limit lower="-1.0" upper="2" ', "<limit ").replace(
        'soft_lower_limit="-0.9" soft_upper_limit="1.9" ', ""
    )
    robot = urdftool.load(write("turns/arm.urdf", text))
    for edited in (robot.change_zero({"shoulder": 0.5}), robot.reverse_sign(["shoulder"])):
        assert edited.is_proved
        assert '<limit effort="30" velocity="3"/>' in edited.data.decode()


def test_sign_exchanges_limits(arm):
    edited = arm.reverse_sign(["shoulder"])
    text = edited.data.decode()
    assert '<axis xyz="0 -1 0"/>' in text
    assert list_numbers(text, 'lower="(.*?)" upper="(.*?)" effort="30"') == [-2.0, 1.0]
    assert 'falling="-0.1"' in text
    assert list_numbers(text, 'min">(.*?)<.*?max">(.*?)<') == [-2.0, 1.0]
    limits = edited.files["joint_limits.yaml"].decode()
    assert "min_position: -2.0" in limits
    assert "max_position: 1.0" in limits
    assert edited.is_proved


def test_a_prefix_reaches_all_files(arm):
    edited = arm.prefix("l_")
    text = edited.data.decode()
    assert not re.search(r'(name|link|reference|joint)="(base|upper|tool|shoulder|slide)"', text)
    assert 'name="l_gray"' in text
    assert 'name="l_shoulder_motor"' in text
    assert 'name="l_arm_system"' in text
    assert [(n.code, n.location.line) for n in edited.notes] == [
        ("edit-text", 65),
        ("edit-file", 66),
    ]
    files = {name: data.decode() for name, data in edited.files.items()}
    assert 'base_link="l_base" tip_link="l_tip"' in files["arm.srdf"]
    assert "joints: [l_shoulder, 'l_slide']  # both" in files["controllers.yaml"]
    assert "l_shoulder: {p: 1.0}" in files["controllers.yaml"]
    assert "  l_shoulder:\n    has" in files["joint_limits.yaml"]
    assert edited.is_proved


@pytest.mark.parametrize(
    "user",
    [
        '<joint name="k" type="revolute"><parent link="c"/><child link="d"/><mimic joint="j"/>'
        '<limit lower="0" upper="1" effort="1" velocity="1"/></joint><link name="d"/>',
        '<transmission name="t"><joint name="j"/></transmission>',
        '<ros2_control name="r"><joint name="j"/></ros2_control>',
        "",
    ],
)
def test_fixed_joints_that_others_name_are_kept(write, user):
    shape = "<visual><geometry><sphere radius='1'/></geometry></visual>"
    text = "".join(f'<link name="{name}">{shape}</link>' for name in "abc") + user
    for name, parent, child in ("iab", "jbc"):
        ends = f'<parent link="{parent}"/><child link="{child}"/>'
        text += f'<joint name="{name}" type="fixed">{ends}</joint>'
    robot = urdftool.load(write("r.urdf", f'<robot name="r">{text}</robot>')).merge_fixed().robot
    assert ("i" in robot.joint, "j" in robot.joint) == (False, bool(user))


def test_merged_masses_are_summed(plain):
    edited = plain.merge_fixed()
    robot = edited.robot
    assert "camera" not in robot.link
    assert "tip" in robot.link  # a frame
    assert robot.link["tool"].mass == pytest.approx(1.2)
    assert len(robot.link["tool"].visuals) == 1
    assert "camera" in plain.merge_fixed(keep=["cam*"]).robot.link


@pytest.fixture
def gripper(write):
    write("hand/gripper.srdf", GRIPPER_SRDF)
    return urdftool.load(write("hand/gripper.urdf", GRIPPER))


def test_attach_then_cut_is_every_byte(arm, gripper, write, tmp_path):
    edited = arm.attach(
        gripper, to="tip", prefix="g_", xyz=(0, 0, 0.1), output=tmp_path / "out" / "robot.urdf"
    )
    assert edited.is_proved
    assert len(edited.proofs) == 2
    robot = edited.robot
    assert robot.tree.get_parent_joint("g_base").parent == "tip"
    assert "g_world" not in robot.link
    assert "<!-- the palm -->" in edited.data.decode()
    assert 'name="g_gray"' in edited.data.decode()
    srdf = edited.files["robot.srdf"].decode()
    assert '<group name="hand"><joint name="g_left"/></group>' in srdf
    assert 'link1="tip" link2="g_base" reason="Adjacent"' in srdf
    assert any(note.code == "edit-world" for note in edited.notes)
    edited.write(tmp_path / "out" / "robot.urdf")
    back = urdftool.load(tmp_path / "out" / "robot.urdf").cut("g_base")
    assert back.is_proved
    assert back.data == ARM.encode()


def test_cut_removes_references(arm, write):
    edited = arm.cut("upper")
    assert set(edited.robot.link) == {"base"}
    text = edited.data.decode()
    assert "<transmission" not in text
    assert "<ros2_control" not in text
    assert 'reference="upper"' not in text
    srdf = edited.files["arm.srdf"].decode()
    assert "<group" not in srdf
    assert {note.code for note in edited.notes} >= {"edit-yaml", "edit-text"}


def test_mirror_exchanges_names(write):
    text = ARM.replace('"upper"', '"l_upper"').replace('"tool"', '"r_tool"')
    edited = urdftool.load(write("two.urdf", text)).mirror(exchange=("l_", "r_"))
    assert edited.is_proved
    assert {"r_upper", "l_tool"} <= set(edited.robot.link)


def test_mirror_mirrors_the_poses_of_sensors(write):
    sensor = '<sensor name="eye" type="camera"><pose>.1 .2 .3 .1 .2 .3</pose></sensor>'
    text = ARM.replace("</robot>", f'<gazebo reference="upper">{sensor}</gazebo></robot>')
    edited = urdftool.load(write("arm.urdf", text)).mirror("xz")
    assert edited.is_proved
    (camera,) = edited.robot.cameras or edited.robot.mounted_sensors
    assert camera.origin.xyz == (0.1, -0.2, 0.3)
    assert camera.origin.rpy == pytest.approx((-0.1, 0.2, -0.3))
    robot = urdftool.load("arm.urdf")
    (image,) = mirror_robot(robot, "xz").cameras or mirror_robot(robot, "xz").mounted_sensors
    assert image.origin.xyz == (0.1, -0.2, 0.3)


TETRAHEDRON = """v 0 0 0
v 0.1 0 0
v 0 0.2 0
v 0 0 0.3
f 1 3 2
f 1 2 4
f 2 3 4
f 1 4 3
"""


def test_mirror_writes_meshes_with_reversed_faces(write, tmp_path):
    write("in/part.obj", TETRAHEDRON)
    mesh = '<mesh filename="part.obj" scale="2 1 1"/>'
    text = ARM.replace('<box size="0.1 0.2 0.3"/>', mesh)
    robot = urdftool.load(write("in/arm.urdf", text))
    edited = robot.mirror("xz", output=tmp_path / "out" / "arm.urdf")
    assert edited.is_proved
    edited.write(tmp_path / "out" / "arm.urdf")
    from urdftool.geometry.load import load_mesh

    one, two = load_mesh(tmp_path / "in/part.obj"), load_mesh(tmp_path / "out/meshes/part.obj")
    corners = two.vertices[two.faces]
    volume = (corners[:, 0] * _cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(0.1 * 0.2 * 0.3 / 6)
    assert two.vertices.min(axis=0)[1] == pytest.approx(-one.vertices.max(axis=0)[1])
    scaled = robot.mirror("xz", meshes="scale")
    assert 'scale="2 -1 1"' in scaled.data.decode()
    assert scaled.is_proved


def _cross(a, b):
    import numpy as np

    return np.cross(a, b)


def test_paths_of_meshes_follow_the_output(write, tmp_path):
    write("in/meshes/part.obj", TETRAHEDRON)
    text = ARM.replace('<box size="0.1 0.2 0.3"/>', '<mesh filename="meshes/part.obj"/>')
    robot = urdftool.load(write("in/arm.urdf", text))
    edited = robot.prefix("l_", output=tmp_path / "out" / "arm.urdf")
    assert 'filename="../in/meshes/part.obj"' in edited.data.decode()


@pytest.mark.parametrize("folder", ["in", "new/deep"])
def test_a_result_reads_its_image_before_its_folder_exists(write, tmp_path, folder):
    material = '<material name="m"><texture filename="skin.png"/></material></visual>'
    text = ARM.replace('<material name="gray"/></visual>', material, 1)
    path = write("in/arm.urdf", text)
    (tmp_path / "in/skin.png").write_bytes(make_png())
    edited = urdftool.load(path).reverse_sign(["slide"], output=tmp_path / folder / "out.urdf")
    assert edited.is_proved
    (proof,) = edited.proofs
    assert "textures" not in proof.comparison.skipped


def test_xacro_is_expanded(write):
    text = ARM.replace(
        '<robot name="arm">', '<robot name="arm" xmlns:xacro="http://wiki.ros.org/xacro">'
    )
    text = text.replace(
        '<link name="tip"/>', '<xacro:property name="n" value="tip"/><link name="${n}"/>'
    )
    edited = urdftool.load(write("arm.urdf.xacro", text)).change_root("tip")
    assert edited.is_proved
    assert b"xacro:" not in edited.data


BAD = {
    "no link": (lambda r: r.change_root("tipp"), "link 'tipp' does not exist"),
    "no joint": (lambda r: r.change_zero({"elbow": 1}), "joint 'elbow' does not exist"),
    "far": (lambda r: r.change_zero({"shoulder": 1e17}), "a zero at 1e+17 is too far for limits"),
    "nan": (lambda r: r.change_zero({"shoulder": float("nan")}), "'shoulder' is nan, which is not"),
    "text": (lambda r: r.change_zero({"shoulder": "0.5"}), "'shoulder' is '0.5', which is not a"),
    "two": (
        lambda r: r.attach(r, to="tip", xyz=(0, 0)),
        "xyz is (0, 0), which is not three finite",
    ),
    "no position": (lambda r: r.reverse_sign(["camera_mount"]), "'camera_mount' is fixed"),
    "root cut": (lambda r: r.cut("base"), "is the root"),
    "prefix": (lambda r: r.prefix("a b"), "cannot be a prefix"),
    "plane": (lambda r: r.mirror("xw"), "plane 'xw' is not one of"),
    "names": (lambda r: r.mirror(exchange=("x_", "y_")), "no name has 'x_' or 'y_'"),
    "tolerance": (lambda r: r.round_numbers(0.0), "is not between"),
    "clash": (lambda r: r.attach(r, to="tip"), "link 'base' is in both robots"),
    "keep": (lambda r: r.merge_fixed(keep=["nothing"]), "link 'nothing' does not exist"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_an_error(plain, name):
    operation, message = BAD[name]
    with pytest.raises(urdftool.UrdftoolError, match=re.escape(message)):
        operation(plain)


@pytest.mark.parametrize(
    ("old", "new", "operation", "message"),
    [
        ('joint name="slide" type="prismatic"', 'joint name="slide" type="floating"',
         lambda r: r.change_root("wheel"), "floating joint 'slide' is on the way"),
        ('joint name="slide" type="prismatic"', 'joint name="slide" type="planar"',
         lambda r: r.mirror(), "planar joint 'slide' has several positions"),
        ('<mimic joint="slide"', '<mimic joint="shoulder"',
         lambda r: r.mirror("xz", meshes="scale").robot and r.cut("upper"), None),
        ('<link name="tip"/>', '<link name="tip"/><link name="tip"/>',
         lambda r: r.change_root("tip"), "link 'tip' occurs twice"),
        ('child link="tip"', 'child link="wheel"',
         lambda r: r.change_root("wheel"), "child of two joints"),
        ('<joint name="shoulder" type', '<joint name="$(arg p)shoulder" type',
         lambda r: r.prefix("l_"), "is computed"),
        ('<parent link="base"/>', '<parent link="nowhere"/>',
         lambda r: r.change_root("tip"), "link 'nowhere' does not exist"),
        ('size="0.1 0.2 0.3"', 'size="0.1 0.2 0,3"',
         lambda r: r.merge_fixed(), "size of <box> in link 'base' has '0,3' with a comma"),
    ],
)  # fmt: skip
def test_a_robot_that_cannot_be_edited(write, old, new, operation, message):
    assert old in ARM
    robot = urdftool.load(write("bad.urdf", ARM.replace(old, new)))
    if message is None:
        assert operation(robot).is_proved
        return
    with pytest.raises(ModelError, match=re.escape(message)) as error:
        operation(robot)
    assert error.value.path is not None


def test_a_mimic_across_the_cut(write):
    text = ARM.replace('</joint>\n  <link name="camera">', '</joint>\n  <link name="camera">')
    text = text.replace('<limit lower="-1.0"', '<mimic joint="slide"/><limit lower="-1.0"')
    robot = urdftool.load(write("mimic.urdf", text))
    with pytest.raises(ModelError, match="joint 'shoulder' mimics 'slide', which would be cut"):
        robot.cut("tool")


def test_a_mesh_that_cannot_be_mirrored(write):
    text = ARM.replace('<box size="0.1 0.2 0.3"/>', '<mesh filename="missing.stl"/>')
    robot = urdftool.load(write("arm.urdf", text))
    with pytest.raises(urdftool.UrdftoolError, match=r"'missing\.stl' cannot be mirrored"):
        robot.mirror()


def test_a_chain_that_would_lead_up(arm):
    with pytest.raises(ModelError, match="the chain from 'base' to 'tip' would lead up the tree"):
        arm.change_root("tip")


def test_other_formats_are_converted_first(write):
    sdf = '<sdf version="1.9"><model name="m"><link name="a"/></model></sdf>'
    with pytest.raises(ModelError, match="urdftool export urdf"):
        urdftool.load(write("m.sdf", sdf)).change_root("a")


def test_the_input_is_not_overwritten(plain):
    with pytest.raises(urdftool.UrdftoolError, match="is an input"):
        plain.change_root("tip").write(Path(plain.source.path))


FOLLOWER = """<robot name="r"><link name="base"/>{links}
<ros2_control name="c" type="system"><joint name="j3"><param name="mimic">j1</param>{}</joint>
</ros2_control>
<transmission name="t"><joint name="j1"><offset>0.3</offset></joint></transmission></robot>"""
LINKS = "".join(
    f'<link name="l{i}"/><joint name="j{i}" type="revolute"><parent link="base"/>'
    f'<child link="l{i}"/><limit lower="-1" upper="1" effort="1" velocity="1"/>{{}}</joint>'
    for i in (1, 3)
).format("", '<mimic joint="j1" multiplier="2"/>')


@pytest.mark.parametrize(
    ("written", "wanted"),
    [
        ('<param name="multiplier">2</param>', '<param name="multiplier">-2</param>'),
        ("", '<param name="multiplier">-1</param>'),
    ],
)
def test_a_follower_in_ros2_control_has_the_sign_of_its_mimic(urdftool, tmp_path, written, wanted):
    source = tmp_path / "r.urdf"
    source.write_text(FOLLOWER.format(written, links=LINKS))
    result = urdftool("edit", "sign", source, "j1", "-o", tmp_path / "out.urdf")
    assert result.code == 0, result.err
    text = (tmp_path / "out.urdf").read_text()
    assert wanted in text
    assert 'multiplier="-2"' in text
    assert "<offset> of joint 'j1' in a <transmission> is not changed" in result.err
    assert "it is -0.3, with the opposite <mechanicalReduction>" in result.err


def test_a_follower_in_ros2_control_that_needs_an_offset_is_named(urdftool, tmp_path):
    source = tmp_path / "r.urdf"
    source.write_text(FOLLOWER.format('<param name="multiplier">2</param>', links=LINKS))
    result = urdftool("edit", "zero", source, "j1=0.25", "-o", tmp_path / "out.urdf")
    assert result.code == 0, result.err
    assert "follows 'j1' in <ros2_control> without the offset 0.5" in result.err


WORLD_ARM = """<robot name="a">
  <link name="world"/>
  <joint name="weld" type="fixed"><parent link="world"/><child link="ld"/></joint>
  <link name="ld"><inertial><mass value="1"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
</robot>"""


def test_a_prefix_keeps_the_root_world(write):
    edited = urdftool.load(write("a.urdf", WORLD_ARM)).prefix("l_")
    assert edited.robot.tree.root.name == "world"
    assert {"l_ld", "world"} == set(edited.robot.link)
    assert edited.is_proved


@pytest.mark.parametrize("name", ["fixed", "freed"])
def test_a_root_that_becomes_or_was_world_is_a_difference(write, name):
    if name == "freed":
        edited = urdftool.load(write("a.urdf", WORLD_ARM)).mirror("xz", exchange=("world", "map"))
    else:
        text = re.sub('<link name="world"/>|<joint.*</joint>', "", WORLD_ARM)
        edited = urdftool.load(write("a.urdf", text)).prefix("wor")
    found = [d for p in edited.proofs for d in p.comparison.differences]
    assert [d.row for d in found] == ["base"]
    assert "fixed by 'world'" in found[0].values


def test_world_as_the_new_root_is_reported(write):
    away = urdftool.load(write("a.urdf", WORLD_ARM)).change_root("ld")
    assert away.is_proved
    assert "is free" in away.notes[-1].message
    back = read_again(away, write).change_root("world")
    assert back.is_proved
    assert "Gazebo fixes" in back.notes[-1].message
