"""What a finding says of readers, and how much it matters, depends on its case."""

import json

import pytest

from tests.conftest import FIXTURES
from urdftool import check
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings
from urdftool.report.json_text import format_json

MASS = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
)
INERTIAL = (
    '<inertial><mass value="{}"/>'
    '<inertia ixx="{}" ixy="0" ixz="0" iyy="{}" iyz="0" izz="{}"/></inertial>'
)
LINK = f'<link name="{{}}">{MASS}</link>'
JOINT = '<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/>{}</joint>'
LIMIT = '<limit lower="{}" upper="{}" effort="1" velocity="1"/>'
BLUE = (
    '<visual><geometry><box size="1 1 1"/></geometry>'
    '<material name="blue"><color rgba="0 0 1 1"/></material></visual>'
)


STL = FIXTURES / "meshes" / "cube.stl"


def robot(*parts, root='name="r"'):
    return f"<robot {root}>{''.join(parts)}</robot>"


def one(path, rule, **options):
    (found,) = check(path, select=[rule], **options)
    return found


def swing(inside, kind="revolute"):
    return robot(LINK.format("a"), LINK.format("b"), JOINT.format("j", kind, "a", "b", inside))


@pytest.mark.parametrize(("rpy", "count"), [("0 0 0", 0), ("0.0 -0 0", 0), ("0 0 0.5", 1)])
def test_an_axis_turned_by_0_is_not_reported(write, rpy, count):
    path = write("r.urdf", swing(f'<axis xyz="0 0 1" rpy="{rpy}"/>', "continuous"))
    assert len(check(path, select=["unknown-attribute"])) == count


def test_a_default_is_taken_for_a_misspelt_attribute_that_has_one(write):
    path = write("r.urdf", swing('<limit lover="-1" upper="1" effort="1" velocity="1"/>'))
    assert any("default" in says for says in one(path, "unknown-attribute").effects.values())
    path = write("s.urdf", swing('<limit lower="-1" upper="1" efort="1" velocity="1"/>'))
    assert not one(path, "unknown-attribute").effects  # most readers require it


@pytest.mark.parametrize(
    ("root", "level"), [('name="r"', "error"), ('name="r" xmlns:drake="http://drake"', "info")]
)
def test_what_another_reader_alone_reads_is_a_remark_in_its_files(write, root, level):
    capsule = '<collision><geometry><capsule radius="1" length="1"/></geometry></collision>'
    path = write("r.urdf", robot(f'<link name="a">{MASS}{capsule}</link>', root=root))
    found = one(path, "feature-needs-newer-version")
    assert found.severity.label == level
    assert found.effects["urdfdom, gz, gazebo-classic, pinocchio"] == (
        "drop the collisions of the link, at least from this one on"
    )
    path = write(
        "w.urdf", robot(LINK.format("a"), JOINT.format("j", "fixed", "world", "a", ""), root=root)
    )
    found = one(path, "unknown-parent-link")
    assert found.severity.label == level
    assert "loads the robot" in found.effects["drake"]


@pytest.mark.parametrize(
    ("attributes", "words", "pybullet"),
    [
        ("", "neither lower nor upper", "load the joint without limits"),
        ('upper="1"', "no lower", "take 0"),
        ('lower="-1"', "no upper", "takes -1"),
    ],
)
def test_bounds_that_are_not_written(write, attributes, words, pybullet):
    path = write("r.urdf", swing(f'<limit {attributes} effort="1" velocity="1"/>'))
    (found,) = check(path, select=["limit-without-bounds"], targets=["newton"])
    assert words in found.message
    assert bool(check(path, select=["limit-without-bounds"])) is (words != "no lower")
    assert [says for key, says in found.effects.items() if "pybullet" in key] == [pybullet]


@pytest.mark.parametrize(
    ("links", "joints", "gazebo"),
    [
        ("a", [("a", "a")], "reject the robot: no root link found"),
        ("ab", [("b", "b")], "load the robot without"),
        ("ab", [("a", "b"), ("b", "b")], "crash"),
        ("abc", [("c", "c")], None),
    ],
)
def test_a_joint_of_a_link_to_itself(write, links, joints, gazebo):
    parts = [LINK.format(name) for name in links]
    parts += [JOINT.format(f"j{n}", "fixed", *ends, "") for n, ends in enumerate(joints)]
    effects = one(write("r.urdf", robot(*parts)), "joint-to-itself").effects
    said = [says for key, says in effects.items() if "gz" in key]
    assert said == [] if gazebo is None else said[0].startswith(gazebo)


@pytest.mark.parametrize(
    ("part", "mujoco", "pybullet"),
    [
        ('<origin xyz="0 0 0 0"/>', "rejects the file: too much data", "takes the first 3"),
        ('<origin xyz="0 0"/>', "rejects the file: not enough data", "takes 0 0 0"),
        ('<axis xyz="0 1"/>', "rejects the file: not enough data", "rejects the robot"),
    ],
)
def test_a_vector_of_a_wrong_length(write, part, mujoco, pybullet):
    effects = one(write("r.urdf", swing(part, "continuous")), "wrong-arity").effects
    assert effects["mujoco"] == mujoco
    assert effects["pybullet"] == pybullet
    assert effects["urdfdom, gz, gazebo-classic, pinocchio"] == "reject the robot"


def test_a_wrong_vector_of_a_visual_and_of_a_color(write):
    shape = '<visual><geometry><box size="1 1"/></geometry>{}</visual>'
    path = write("r.urdf", robot(f'<link name="a">{shape.format("")}</link>'))
    assert one(path, "wrong-arity").effects["mujoco"].startswith("ignores it")
    color = BLUE.replace("0 0 1 1", "0 0 1")
    effects = one(
        write("c.urdf", robot(f'<link name="a">{MASS}{color}</link>')), "wrong-arity"
    ).effects
    assert effects["mujoco"].startswith("rejects")
    assert effects["urdfdom, gz, gazebo-classic, pinocchio"] == "load the robot without the color"


@pytest.mark.parametrize(
    ("text", "says"),
    [("1 ", "read it as intended"), ("1kg", "rejects the file"), ("nan", None)],
)
def test_mujoco_and_text_that_is_no_number(write, text, says):
    path = write("r.urdf", swing(LIMIT.format(text, 2)))
    effects = one(path, "not-a-number").effects
    assert [effect for key, effect in effects.items() if "mujoco" in key] == [says] * bool(says)


@pytest.mark.parametrize(
    ("start", "case"),
    [("\n", "accept it"), ("<!-- a -->\n", "reject the file"), ("a ", "reject the file")],
)
def test_what_stands_before_the_declaration(write, start, case):
    path = write("r.urdf", f'{start}<?xml version="1.0"?><robot name="r"><link name="a"/></robot>')
    found = one(path, "content-before-declaration")
    assert [says for key, says in found.effects.items() if "mujoco" in key] == [case]
    assert found.effects["xacro"].startswith("rejects the file")


def test_a_link_without_friction_needs_a_block_and_one_without_a_color_does_not(write):
    foot = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
    text = robot(
        LINK.format("base"),
        f'<link name="left_caster">{MASS}{foot}</link>',
        f'<link name="arm">{BLUE}</link>',
        JOINT.format("j", "revolute", "base", "left_caster", LIMIT.format(-1, 1)),
        JOINT.format("k", "fixed", "base", "arm", ""),
    )
    found = check(write("r.urdf", text), select=["missing-gazebo-tags"], targets=["gazebo-classic"])
    assert [(f.name, f.severity.label, list(f.effects)) for f in found] == [
        ("left_caster", "warning", ["gz, gazebo-classic"]),
    ]


def test_a_joint_that_its_limits_lock_needs_no_plugin(write):
    for bounds, count in ((LIMIT.format(0, 0), 0), (LIMIT.format(0, 1), 1)):
        text = swing(bounds).replace("</robot>", '<transmission name="t"/></robot>')
        path = write("r.urdf", text)
        found = check(path, select=["missing-control-plugin"], targets=["gazebo-classic"])
        assert len(found) == count


def test_a_plugin_that_a_condition_leaves_out_is_not_missed(write):
    part = '<gazebo><plugin name="control" filename="gz_ros2_control-system"/></gazebo>'
    gazebo = '<gazebo reference="a"><mu1>1</mu1></gazebo><transmission name="t"/>'
    head = 'name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"'
    for inside, count in ((f'<xacro:if value="false">{part}</xacro:if>', 0), ("", 1)):
        text = swing(LIMIT.format(0, 1)).replace("</robot>", f"{gazebo}{inside}</robot>")
        path = write("r.urdf.xacro", text.replace('name="r"', head, 1))
        assert len(check(path, select=["missing-control-plugin"], targets=["gz"])) == count


OLD = (
    '<gazebo><controller:gazebo_ros_controller_manager xmlns:controller="http://x" '
    'name="c" plugin="libgazebo_ros_controller_manager.so"/></gazebo>'
)


def test_a_plugin_in_an_attribute_is_a_sign_of_gazebo_classic(write):
    kp = '<gazebo reference="a"><kp>1e6</kp></gazebo>'
    line = Settings(select=("no-effect-in-gz", "missing-control-plugin"))
    moved = swing(LIMIT.format(0, 1)).removesuffix("</robot>")
    write("package.xml", "<package><name>p</name><build_type>ament_cmake</build_type></package>")
    report = check_file(write("r.urdf", f"{moved}{kp}{OLD}</robot>"), Options(line))
    assert "gazebo-classic" in report.targets
    assert report.findings == []
    report = check_file(write("s.urdf", f"{moved}{kp}</robot>"), Options(line))
    assert "gz" in report.targets
    assert report.findings == []  # a <gazebo> tag alone may be for either Gazebo


@pytest.mark.parametrize(("name", "count"), [("caster_1", 0), ("suspension", 0), ("elbow", 1)])
def test_what_is_passive_by_its_name_needs_no_transmission(write, name, count):
    text = robot(
        LINK.format("a"),
        LINK.format("b"),
        JOINT.format(name, "continuous", "a", "b", ""),
        '<gazebo><plugin name="c" filename="libgazebo_ros_control.so"/></gazebo>',
    )
    found = check(
        write("r.urdf", text), select=["actuated-joint-without-transmission"], targets=["ros1"]
    )
    assert len(found) == count


XACRO = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" {}>{}<link name="a"/></robot>'


def test_a_file_that_an_argument_names_is_to_be_given(write):
    inside = '<xacro:arg name="part" default="none.xacro"/><xacro:include filename="$(arg part)"/>'
    path = write("r.urdf.xacro", XACRO.format('name="r"', inside))
    assert "pass part:=" in one(path, "include-not-found").message
    found = one(path, "include-not-found", args={"part": "gone.xacro"})
    assert "part:=" not in found.message
    fixed = XACRO.format('name="r"', '<xacro:include filename="gone.xacro"/>')
    assert ":=FILE" not in one(write("s.urdf.xacro", fixed), "include-not-found").message


def test_an_argument_of_the_root_cannot_be_declared_in_it(write):
    inside = '<xacro:arg name="who" default="x"/>'
    found = one(write("r.urdf.xacro", XACRO.format('name="$(arg who)"', inside)), "undeclared-arg")
    assert "pass who:=x" in found.message
    assert "declare it" not in found.message
    (found,) = check("r.urdf.xacro", select=["undeclared-arg"], fixes=True)
    assert found.fix is None


def test_a_placeholder_has_no_links_on_purpose(write):
    assert check(write("r.urdf", "<robot><!-- nothing --></robot>"), select=["no-links"]) == []
    assert len(check(write("e.urdf", "<robot/>"), select=["no-links"])) == 1
    assert len(check(write("s.urdf", '<robot name="r"/>'), select=["no-links"])) == 1
    material = '<robot><material name="red"><color rgba="1 0 0 1"/></material></robot>'
    assert len(check(write("t.urdf", material), select=["no-links"])) == 1


def test_a_brace_that_lost_its_dollar_in_plain_urdf(write):
    found = one(write("r.urdf", robot('<link name="{side}_arm"/>')), "unexpanded-expression")
    assert "xmlns" not in found.message
    assert "namespace" not in found.message
    found = one(write("s.urdf", robot('<link name="${side}_arm"/>')), "unexpanded-expression")
    assert "namespace" in found.message


def test_nameless_materials_of_a_link_are_one_finding(write):
    visual = BLUE.replace(' name="blue"', "")
    path = write("r.urdf", robot(f'<link name="a">{visual}{visual}</link>'))
    found = one(path, "nameless-material")
    assert found.message.startswith("2 <material>s")
    assert found.effects["pybullet"] == "rejects the robot"


def test_a_binary_stl_by_another_ending_is_renamed(write):
    shape = '<visual><geometry><mesh filename="{}"/></geometry></visual>'
    write("a.stlb", STL.read_bytes())
    path = write("r.urdf", robot(f'<link name="a">{shape.format("a.stlb")}</link>'))
    found = one(path, "unsupported-mesh-format", targets=["gz"])
    assert found.message.endswith("rename it to .stl")
    assert found.effects.keys() == {"pybullet", "isaac"}


def test_json_has_no_control_character():
    text = format_json({"name": "a\u0085b\u009bc\u202ed\x7f", "plain": "é"})
    assert text.isprintable()
    assert "é" in text
    assert json.loads(text) == {"name": "a\u0085b\u009bc\u202ed\x7f", "plain": "é"}


def test_a_name_that_is_missing_matters_to_who_reads_it(write):
    unnamed = '<transmission><type>x</type><joint name="j"/></transmission>'
    path = write("r.urdf", swing(LIMIT.format(0, 1)).replace("</robot>", f"{unnamed}</robot>"))
    assert one(path, "missing-name").effects == {}
    path = write("s.urdf", swing(LIMIT.format(0, 1)).replace('name="j"', ""))
    assert one(path, "missing-name").effects["mujoco"] == "rejects the file"
    path = write("t.urdf", robot(LINK.format("a"), root=""))
    assert one(path, "missing-name").effects["mujoco"] == "accepts it"


@pytest.mark.parametrize(("kind", "meant"), [("revolute", True), ("fixed", False)])
def test_a_transmission_means_a_joint_that_moves(write, kind, meant):
    joint = JOINT.format("left_elbow_joint", kind, "a", "b", LIMIT.format(0, 1))
    drive = (
        '<transmission name="t"><type>x</type><joint name="left_elbw_joint">'
        "<hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>"
        "</joint></transmission>"
    )
    path = write("r.urdf", robot(LINK.format("a"), LINK.format("b"), joint, drive))
    assert ("did you mean" in one(path, "transmission-unknown-joint").message) == meant


SHAPE = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'


def limbs(name, *, same, right_y):
    """Make a robot of two mirrored arms of three links, with a fourth of a name on each."""
    parts = [LINK.format("base")]
    for side, sign in (("left", 1), ("right", -1)):
        above = "base"
        for number, y in enumerate((0.2, 0.1, 0.1)):
            link = f"{side}_{number}"
            parts.append(LINK.format(link))
            inside = f'<origin xyz="0 {sign * y} 0"/><axis xyz="0 1 0"/>{LIMIT.format(-1, 1)}'
            parts.append(JOINT.format(f"{link}_joint", "revolute", above, link, inside))
            above = link
        y = 0.1 if side == "left" else right_y
        inside = f'<origin xyz="0 {y} 0"/><axis xyz="1 0 0"/>{LIMIT.format(0, same)}'
        parts.append(f'<link name="{side}_{name}">{SHAPE}</link>')
        parts.append(
            JOINT.format(f"{side}_{name}_joint", "revolute", above, f"{side}_{name}", inside)
        )
    return robot(*parts)


@pytest.mark.parametrize(("name", "count"), [("gripper", 0), ("elbow", 1)])
def test_grippers_of_equal_limits_are_copies(write, name, count):
    path = write("r.urdf", limbs(name, same=1, right_y=-0.1))
    assert len(check(path, select=["limits-not-mirrored"])) == count


@pytest.mark.parametrize(("y", "count"), [(0.1, 0), (-0.3, 1)])
def test_joints_of_one_origin_on_both_limbs_are_copies(write, y, count):
    path = write("r.urdf", limbs("hand", same=1, right_y=y))
    assert len(check(path, select=["joint-not-mirrored"])) == count


def test_an_effort_of_0_makes_a_joint_passive_in_drake(write):
    text = swing('<limit lower="-1" upper="1" effort="0" velocity="1"/>')
    path = write("s.urdf", text.replace('name="r"', 'name="r" xmlns:drake="http://drake"', 1))
    assert one(path, "zero-effort-limit").severity.label == "info"
    assert one(path, "zero-effort-limit", targets=["gz"]).severity.label == "error"


@pytest.mark.parametrize(
    ("kind", "damping", "says"),
    [
        ("planar", "0.1 0.2 0.3", "reads one for each"),
        ("planar", "0.1 0.2", "rejects"),
        ("continuous", "0.1 0.2 0.3", "rejects"),
        ("continuous", "0.1 N", "reads the leading"),
        ("continuous", "0,1 0.2", "reads the leading"),
    ],
)
def test_drake_reads_three_dampings_of_a_planar_joint(write, kind, damping, says):
    joint = (
        f'<joint name="j" type="{kind}"><parent link="a"/><child link="b"/>'
        f'<dynamics damping="{damping}"/></joint>'
    )
    path = write("r.urdf", robot(f'<link name="a"/><link name="b"/>{joint}'))
    assert one(path, "not-a-number").effects["drake"].startswith(says)


@pytest.mark.parametrize(
    ("least", "targets", "severity"),
    [
        ("0", ["mujoco"], "error"),
        ("0", ["ros2"], None),
        ("2e-14", ["mujoco"], None),
    ],
)
def test_a_thin_part_matters_to_mujoco_alone(write, least, targets, severity):
    thick = INERTIAL.format(1, 0.01, 0.01, 0.01)
    thin = INERTIAL.format(1, 0.01, 0.01, least)
    path = write(
        "r.urdf",
        robot(
            f'<link name="a">{thick}</link><link name="b">{thick}</link>'
            f'<link name="c">{thin}</link>'
            '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'
            '<joint name="k" type="fixed"><parent link="b"/><child link="c"/></joint>'
        ),
    )
    found = check(path, select=["singular-inertia"], targets=targets)
    assert [f.severity.label for f in found] == [severity] * bool(severity)
    assert all("mujoco" in f.effects for f in found)


@pytest.mark.parametrize(
    ("product", "does"), [("0", "accept it"), ("0.01", "reject the model if rounding makes")]
)
def test_a_tilted_rod_may_be_rejected_by_gazebo(write, product, does):
    rod = INERTIAL.format(1, 0.01, 0.01, 0.02 if float(product) else 0)
    rod = rod.replace('ixy="0"', f'ixy="{product}"')
    path = write(
        "r.urdf",
        robot(
            f'<link name="a">{INERTIAL.format(1, 1, 1, 1)}</link>'
            f'<link name="b">{rod}</link>'
            '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'
        ),
    )
    (found,) = check(path, select=["singular-inertia"], targets=["gz"])
    gazebo = [says for readers, says in found.effects.items() if readers.startswith("gz")]
    assert len(gazebo) == 1
    assert gazebo[0].startswith(does)


@pytest.mark.parametrize(
    ("moment", "severity", "rejects"),
    [("0", "error", True), ("9e-15", "error", True), ("2e-14", "warning", False)],
)
def test_mujoco_rejects_an_inertia_below_its_least(write, moment, severity, rejects):
    bad = INERTIAL.format(1, moment, moment, moment)
    path = write(
        "r.urdf",
        robot(
            f'<link name="a"/><link name="b">{bad}</link>'
            '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'
        ),
    )
    found = one(path, "zero-inertia", targets=["mujoco"])
    assert found.severity.label == severity
    assert ("mujoco" in found.effects) == rejects


@pytest.mark.parametrize("rule", ["zero-inertia", "placeholder-inertia"])
def test_the_command_of_a_hint_writes_the_inertia(write, urdftool, rule):
    moment = "0" if rule == "zero-inertia" else "1"
    bad = INERTIAL.format(1, moment, moment, moment)
    shape = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    text = robot(
        f'<link name="a"/><link name="b">{bad}{shape}</link>'
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'
    )
    path = write("r.urdf", text)
    words = one(path, rule).hint.partition("'")[2].partition("'")[0].replace("LINK", "b").split()
    urdftool(*words[1:], path)
    assert check(path, select=[rule]) == []
    missing = text.replace('<box size="0.1 0.1 0.1"/>', '<mesh filename="gone.stl"/>')
    assert one(write("s.urdf", missing), rule).hint == ""
