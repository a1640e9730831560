"""Findings and fixes that were wrong on real robots, by their causes."""

import re

import pytest

from tests.conftest import FIXTURES
from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

BOX = "<geometry><box size='.1 .1 .1'/></geometry>"
MASS = (
    '<inertial><mass value="1"/><inertia ixx="0.0017" ixy="0" ixz="0" iyy="0.0017" iyz="0" '
    'izz="0.0017"/></inertial>'
)
XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
MANIFEST = "<package format='3'><name>{}</name>{}</package>"
STL = (
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid a\n"
)


def write(folder, files):
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")


def check(path, *rules, targets=None, packages=None, paths=()):
    settings = Settings(select=rules, targets=targets and frozenset(targets))
    options = Options(settings, fixes=True, packages=packages or {}, package_paths=paths)
    return check_file(path, options), options


def find(path, *rules, **others):
    report, _ = check(path, *rules, **others)
    return [(f.code, f.severity.name, f.message) for f in report.findings]


def fix(path, *rules, **others):
    """Return the file after all fixes, and the findings before."""
    report, options = check(path, *rules, **others)
    done = fix_description(report, options, unsafe=True)
    return done.after.get(str(path), path.read_bytes()).decode(), report.findings


def mesh(uri, part="visual"):
    geometry = f'<geometry><mesh filename="{uri}"/></geometry>'
    return f'<robot name="r"><link name="a"><{part}>{geometry}</{part}></link></robot>'


@pytest.mark.parametrize(
    ("uri", "expected"),
    [
        ("package://p//meshes/a.stl", [("malformed-uri", "INFO")]),
        ("package://p//meshes/gone.stl", [("mesh-not-found", "ERROR")]),
        ("package://p/meshes/go ne.stl", [("mesh-not-found", "ERROR")]),
        ("package:/p/meshes/a.stl", [("malformed-uri", "ERROR")]),
    ],
)
def test_a_missing_file_is_the_cause_and_not_its_slashes(tmp_path, uri, expected):
    write(tmp_path, {"package.xml": MANIFEST.format("p", ""), "meshes/a.stl": STL})
    write(tmp_path, {"r.urdf": mesh(uri)})
    found = find(tmp_path / "r.urdf", "malformed-uri", "mesh-not-found")
    assert [one[:2] for one in found] == expected


def test_an_existing_file_behind_two_slashes_is_not_said_to_be_rejected(tmp_path):
    write(tmp_path, {"package.xml": MANIFEST.format("p", ""), "meshes/a.stl": STL})
    write(tmp_path, {"r.urdf": mesh("package://p//meshes/a.stl", "collision")})
    report, _ = check(tmp_path / "r.urdf", "malformed-uri")
    assert [f.effects for f in report.findings] == [{}]


def test_a_package_wins_over_a_folder_of_its_name(tmp_path):
    call = f'<robot name="r" {XACRO}><xacro:include filename="$(find arm)/a.xacro"/></robot>'
    write(
        tmp_path,
        {
            "models/arm/model.sdf": "",
            "src/arm_v2/package.xml": MANIFEST.format("arm", ""),
            "src/arm_v2/a.xacro": f'<robot {XACRO}><link name="a"/></robot>',
            "robot/r.xacro": call,
        },
    )
    paths = [str(tmp_path / "models"), str(tmp_path / "src")]
    report, _ = check(tmp_path / "robot/r.xacro", paths=paths)
    assert report.error is None
    assert not [f for f in report.findings if f.severity.name == "ERROR"]


@pytest.mark.parametrize("share", ["share/${PROJECT_NAME}", "${CATKIN_PACKAGE_SHARE_DESTINATION}"])
@pytest.mark.parametrize(("project", "found"), [("arm", []), ("other", ["wrong-package-in-uri"])])
def test_a_uri_that_resolves_where_cmake_installs_is_right(tmp_path, share, project, found):
    cmake = f"project({project})\ninstall(DIRECTORY meshes DESTINATION {share})\n"
    write(
        tmp_path,
        {
            "p/package.xml": MANIFEST.format("arm_description", ""),
            "p/CMakeLists.txt": cmake,
            "p/meshes/a.stl": STL,
            "p/r.urdf": mesh("package://arm/meshes/a.stl"),
        },
    )
    rules = ("wrong-package-in-uri", "package-not-found", "mesh-not-found")
    assert [one[0] for one in find(tmp_path / "p/r.urdf", *rules)] == found


TIP = '<robot {}><xacro:macro name="tip" params="n"><link name="${{n}}_{}"/></xacro:macro></robot>'


@pytest.mark.parametrize(
    ("includes", "count"),
    [
        ('<xacro:include filename="tip_a.xacro"/><xacro:include filename="tip_b.xacro"/>', 1),
        (
            '<xacro:macro name="use" params="kind"><xacro:include filename="tip_${kind}.xacro"/>'
            '<xacro:tip n="${kind}"/></xacro:macro><xacro:use kind="a"/><xacro:use kind="b"/>',
            0,
        ),
        (
            '<xacro:if value="true"><xacro:include filename="tip_a.xacro"/></xacro:if>'
            '<xacro:unless value="false"><xacro:include filename="tip_b.xacro"/></xacro:unless>',
            0,
        ),
    ],
)
def test_files_of_which_an_include_chooses_one_share_their_macros(tmp_path, includes, count):
    files = {f"tip_{kind}.xacro": TIP.format(XACRO, kind) for kind in "ab"}
    write(
        tmp_path,
        {**files, "r.xacro": f'<robot name="r" {XACRO}><link name="a"/>{includes}</robot>'},
    )
    assert len(find(tmp_path / "r.xacro", "macro-redefined")) == count


CONTROL = """<robot name="r" {}><link name="a"/><link name="b"/><link name="c"/>
<xacro:arg name="gz" default="true"/>
<joint name="one" type="continuous"><parent link="a"/><child link="b"/></joint>
<joint name="two" type="continuous"><parent link="b"/><child link="c"/></joint>
<ros2_control name="s" type="system"><hardware><plugin>mock_components/GenericSystem</plugin>
</hardware><joint name="one"><state_interface name="position"/></joint>{}</ros2_control></robot>"""


@pytest.mark.parametrize(
    ("inside", "count"),
    [
        ("", 1),
        ('<xacro:unless value="$(arg gz)"><joint name="two"/></xacro:unless>', 0),
        ('<xacro:unless value="$(arg gz)"><joint name="${\'tw\'}o"/></xacro:unless>', 0),
        ('<xacro:unless value="$(arg gz)"><joint name="three"/></xacro:unless>', 1),
    ],
)
def test_a_joint_that_a_condition_leaves_out_is_meant(tmp_path, inside, count):
    write(tmp_path, {"r.urdf.xacro": CONTROL.format(XACRO, inside)})
    found = find(tmp_path / "r.urdf.xacro", "joint-outside-ros2-control", targets=("ros2",))
    assert len(found) == count


@pytest.mark.parametrize(
    ("part", "keeps", "rejects"),
    [("visual", "", False), ("collision", "", True), ("visual", "false", True)],
)
def test_mujoco_ignores_a_visual_without_a_shape(tmp_path, part, keeps, rejects):
    kept = f'<mujoco><compiler discardvisual="{keeps}"/></mujoco>' if keeps else ""
    text = f'<robot name="r">{kept}<link name="a"><{part}><geometry/></{part}></link></robot>'
    write(tmp_path, {"r.urdf": text})
    report, _ = check(tmp_path / "r.urdf", "empty-geometry", targets=("mujoco",))
    (finding,) = report.findings
    assert ("mujoco" in finding.effects) is rejects


@pytest.mark.parametrize(
    ("uri", "part", "rejects"),
    [("a.stl", "visual", False), ("a.stl", "collision", True)],
)
def test_mujoco_and_drake_do_not_open_the_file_of_a_visual(tmp_path, uri, part, rejects):
    write(tmp_path, {"a.stl": "not a mesh", "r.urdf": mesh(uri, part)})
    report, _ = check(tmp_path / "r.urdf", "corrupt-mesh")
    (finding,) = report.findings
    assert ("mujoco" in finding.effects, "drake" in finding.effects) == (rejects, rejects)


@pytest.mark.parametrize(
    ("inside", "removed"),
    [
        ("<visual><material name='m'/></visual>", True),
        (f"<visual><material name='m'/></visual>{BOX}", False),
        (f"<visual><origin xyz='0 0 0'>{BOX}</origin></visual>", False),
    ],
)
def test_a_visual_whose_shape_is_elsewhere_is_not_removed(tmp_path, inside, removed):
    write(tmp_path, {"r.urdf": f'<robot name="r"><link name="a">{inside}</link></robot>'})
    text, _ = fix(tmp_path / "r.urdf", "empty-geometry")
    assert ("<visual>" not in text) is removed


@pytest.mark.parametrize(
    ("files", "suggested"),
    [
        (("urdf/gripper_140.xacro",), "gripper_140.xacro"),
        (("urdf/gripper_140.xacro", "v2/gripper_85.xacro"), "../v2/gripper_85.xacro"),
        (("urdf/gripper_140.xacro", "v2/gripper_85.xacro", "v3/gripper_85.xacro"), None),
    ],
)
def test_a_file_of_that_name_is_suggested_before_one_of_another(tmp_path, files, suggested):
    text = f'<robot name="r" {XACRO}><xacro:include filename="gripper_85.xacro"/></robot>'
    write(tmp_path, {"package.xml": MANIFEST.format("p", ""), "urdf/r.xacro": text})
    write(tmp_path, dict.fromkeys(files, f"<robot {XACRO}/>"))
    if len(files) == 1:  # numbers are not typos
        text = text.replace("gripper_85", "griper_140")
        write(tmp_path, {"urdf/r.xacro": text})
    report, _ = check(tmp_path / "urdf/r.xacro", "include-not-found")
    assert [f.data["suggestion"] for f in report.findings] == [suggested]


PART = f"""<robot {XACRO}><link name="imu"/><link name="lidar"/>
<joint name="j" type="fixed"><parent link="base"/><child link="imu"/></joint>
<joint name="k" type="fixed"><parent link="top"/><child link="lidar"/></joint></robot>"""
WHOLE = f"""<robot name="r" {XACRO}><link name="base"/><link name="top"/>
<joint name="t" type="fixed"><parent link="base"/><child link="top"/></joint>
<xacro:include filename="sensors.urdf.xacro"/></robot>"""


@pytest.mark.parametrize("included", [False, True])
def test_a_part_says_once_who_includes_it(tmp_path, included):
    write(tmp_path, {"package.xml": MANIFEST.format("p", ""), "sensors.urdf.xacro": PART})
    if included:
        write(tmp_path, {"r.urdf.xacro": WHOLE})
    found = find(tmp_path / "sensors.urdf.xacro", "unknown-parent-link", "missing-name")
    if not included:
        assert [one[1] for one in found] == ["ERROR"] * 3
        return
    ((_, severity, message),) = found
    assert severity == "INFO"
    assert "r.urdf.xacro includes it" in message
    assert "'base' and 'top'" in message
    assert "1 more joint" in message


def test_a_part_is_not_a_robot_of_its_folder(tmp_path, urdftool, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write(tmp_path, {"package.xml": MANIFEST.format("p", ""), "sensors.urdf.xacro": PART})
    write(tmp_path, {"r.urdf.xacro": WHOLE})
    assert "checked 1 robot (1 variant), 1 file belongs to it" in urdftool("lint", ".").err


def test_a_package_is_suggested_for_a_typo(tmp_path):
    text = f'<robot name="r" {XACRO}><xacro:include filename="$(find studentbot)/a.xacro"/></robot>'
    write(tmp_path, {"package.xml": MANIFEST.format("student_bot", ""), "r.xacro": text})
    write(tmp_path, {"r.urdf": mesh("package://studentbot/meshes/a.stl")})
    for name in ("r.xacro", "r.urdf"):
        ((_, _, message),) = find(tmp_path / name, "package-not-found")
        assert "did you mean 'student_bot'?" in message
    assert not find(tmp_path / "r.urdf", "undeclared-mesh-dependency", targets=("ros2",))


@pytest.mark.parametrize(("name", "count"), [("EXPORT-NAME-V2", 0), ("realsense2_description", 1)])
def test_no_dependency_is_advised_that_cannot_be_a_package(tmp_path, name, count):
    write(tmp_path, {"package.xml": MANIFEST.format("arm", "")})
    write(tmp_path, {"r.urdf": mesh(f"package://{name}/meshes/a.stl")})
    found = find(tmp_path / "r.urdf", "undeclared-mesh-dependency", targets=("ros2",))
    assert len(found) == count


@pytest.mark.parametrize(
    ("use", "declared"),
    [
        ('<link name="$(arg n)"/>', True),
        ('<xacro:if value="$(arg n)"><link name="a"/></xacro:if>', False),
        ('<link name="${$(arg n) + 1}"/>', False),
        ('<xacro:property name="p" value="$(arg n)"/><link name="a${p}"/>', False),
    ],
)
def test_an_argument_that_cannot_be_empty_is_not_declared_empty(tmp_path, use, declared):
    write(tmp_path, {"r.xacro": f'<robot name="r" {XACRO}>{use}</robot>'})
    text, findings = fix(tmp_path / "r.xacro", "undeclared-arg")
    assert [f.code for f in findings] == ["undeclared-arg"]
    assert ("<xacro:arg" in text) is declared


ARM = """<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
<joint name="j"><hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>
</joint><actuator name="m"/></transmission></robot>"""


@pytest.mark.parametrize("depends", [False, True])
def test_a_control_plugin_is_added_if_the_package_depends_on_it(tmp_path, depends):
    needed = "<exec_depend>gazebo_ros_control</exec_depend>" if depends else ""
    write(tmp_path, {"package.xml": MANIFEST.format("p", needed), "r.urdf": ARM})
    text, findings = fix(tmp_path / "r.urdf", "missing-control-plugin", targets=("gazebo-classic",))
    assert len(findings) == 1
    assert ("libgazebo_ros_control.so" in text) is depends


@pytest.mark.parametrize("comment", ["", "<!-- To stabilize simulation -->"])
def test_a_placeholder_with_a_reason_stays(tmp_path, comment):
    inertial = MASS.replace("0.0017", "1").replace("<inertia ", f"{comment}<inertia ")
    link = f"<link name='b'>{inertial}<visual>{BOX}</visual><collision>{BOX}</collision></link>"
    joint = "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>"
    write(tmp_path, {"r.urdf": f"<robot name='r'><link name='a'/>{link}{joint}</robot>"})
    text, findings = fix(tmp_path / "r.urdf", "placeholder-inertia")
    assert len(findings) == 1
    assert ('ixx="1"' in text) is bool(comment)


@pytest.mark.parametrize(("name", "reported"), [("wheel", False), ("caster", True)])
def test_the_friction_that_gazebo_takes_anyway_is_not_missed(tmp_path, name, reported):
    part = f"<link name='{name}'>{MASS}<collision><geometry><sphere radius='.1'/></geometry>"
    text = f"""<robot name="r"><link name="a"/>{part}</collision></link>
    <joint name="j" type="continuous"><parent link="a"/><child link="{name}"/>
    <axis xyz="0 1 0"/></joint><gazebo reference="{name}"><maxContacts>4</maxContacts></gazebo>
    </robot>"""
    write(tmp_path, {"r.urdf": text})
    fixed, findings = fix(tmp_path / "r.urdf", "missing-friction", targets=("gz",))
    assert bool(findings) is reported
    assert "<mu1>1" not in fixed


@pytest.mark.parametrize(("product", "negated"), [("0.00001", 1), ("0", 0)])
def test_the_fix_of_a_mirrored_center_of_mass_mirrors_the_products(tmp_path, product, negated):
    text = (FIXTURES / "rules/com-not-mirrored/bad.urdf").read_text("utf-8")
    text = text.replace('ixx="0.0003867" ixy="0"', f'ixx="0.0003867" ixy="{product}"')
    write(tmp_path, {"r.urdf": text})
    fixed, (finding,) = fix(tmp_path / "r.urdf", "com-not-mirrored")
    assert fixed.count('ixy="-0.00001"') == negated
    assert ("opposite sign of ixy" in finding.message) is bool(negated)


def test_a_mirrored_center_of_mass_has_the_numbers_of_its_file(tmp_path):
    text = (FIXTURES / "rules/com-not-mirrored/bad.urdf").read_text("utf-8")
    write(tmp_path, {"r.urdf": text})
    _, (finding,) = fix(tmp_path / "r.urdf", "com-not-mirrored")
    wrong, twin, right = re.findall(r'xyz="([^"]*)"', finding.message)
    assert f'xyz="{wrong}"' in text
    assert f'xyz="{twin}"' in text
    assert sorted(map(abs, map(float, wrong.split()))) == sorted(
        map(abs, map(float, right.split()))
    )


@pytest.mark.parametrize(
    ("text", "line", "column", "said"),
    [
        ('<robot name="r">\n  <link name="a>\n    <visual/>\n  </link>\n</robot>', 2, 14, "quote"),
        (
            "<robot name='r'>\n  <link name='a\">\n    <visual/>\n  </link>\n</robot>",
            2,
            14,
            "quote",
        ),
        ('<robot name="r"><link name="a"/></robot>\n\0', 2, 1, "NUL byte"),
        ('<robot name="r"><link name="a"/></robot>\n</robot>', 2, 2, "end tag"),
    ],
)
def test_a_damaged_file_says_what_is_in_it(tmp_path, urdftool, text, line, column, said):
    write(tmp_path, {"r.urdf": text})
    result = urdftool("lint", tmp_path / "r.urdf", "--no-cache", "--format", "concise")
    assert result.code == 2
    shown = result.out + result.err
    assert f"r.urdf:{line}:{column}: " in shown
    assert said in shown


@pytest.mark.parametrize(
    ("use", "include", "level"),
    [
        ("$(arg dir)", "$(arg dir)/tool.urdf", "INFO"),
        ("$(arg dir)", "tools/$(arg tool).urdf", "INFO"),
        ("$(arg dir)", "tools/$(arg tool).xacro", "ERROR"),
        ("$(arg dir)", "other.urdf", "ERROR"),
        ("${dir}", "$(arg dir)/tool.urdf", "ERROR"),
    ],
)
def test_a_part_with_arguments_of_a_file_that_includes_it_is_no_error(
    tmp_path, use, include, level
):
    top = f'<robot name="r" xmlns:xacro="x"><xacro:include filename="{include}"/></robot>'
    write(tmp_path, {"tool.urdf": mesh(f"{use}/a.stl"), "top.xacro": top})
    [(_, severity, message)] = find(tmp_path / "tool.urdf", "unexpanded-expression")
    assert severity == level
    assert ("top.xacro: check that" in message) == (level == "INFO")


def test_a_file_with_arguments_that_no_file_includes_is_an_error(tmp_path):
    write(tmp_path, {"tool.urdf": mesh("$(arg dir)/a.stl")})
    [(_, severity, message)] = find(tmp_path / "tool.urdf", "unexpanded-expression")
    assert severity == "ERROR"
    assert "part of" not in message


@pytest.mark.parametrize(("value", "count"), [("0", 0), ("0.5", 1)])
def test_an_unknown_attribute_of_zero_has_no_effect(tmp_path, value, count):
    joint = (
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
        f'<dynamics damping="1" friction="1" spring_stiffness="{value}"/></joint>'
    )
    write(tmp_path, {"r.urdf": f'<robot name="r"><link name="a"/><link name="b"/>{joint}</robot>'})
    assert len(find(tmp_path / "r.urdf", "unknown-attribute")) == count


@pytest.mark.parametrize(("kind", "count"), [("fixed", 0), ("continuous", 1)])
def test_a_sticker_may_be_light(tmp_path, kind, count):
    sticker = MASS.replace('"1"', '"3.6e-06"') + f"<visual>{BOX}</visual>"
    joint = f'<joint name="j" type="{kind}"><parent link="a"/><child link="b"/></joint>'
    links = f'<link name="a">{MASS}</link><link name="b">{sticker.replace(".1", ".05")}</link>'
    write(tmp_path, {"r.urdf": f'<robot name="r">{links}{joint}</robot>'})
    found = find(tmp_path / "r.urdf", "implausible-mass", "implausible-density")
    assert len(found) == count


@pytest.mark.parametrize(("material", "count"), [("", 1), ('<material name="m"/>', 0)])
def test_colors_that_a_material_replaces_are_not_missed(tmp_path, material, count):
    obj = "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    text = mesh("a.obj").replace("</visual>", f"{material}</visual>")
    write(tmp_path, {"r.urdf": text, "a.obj": obj})
    assert len(find(tmp_path / "r.urdf", "missing-mesh-dependency")) == count


@pytest.mark.parametrize(("mass", "count"), [("0", 0), ("1", 1)])
def test_the_marker_of_a_goal_needs_no_collision(tmp_path, mass, count):
    inertial = MASS.replace('"1"', f'"{mass}"')
    text = f'<robot name="r"><link name="a">{inertial}<visual>{BOX}</visual></link></robot>'
    write(tmp_path, {"r.urdf": text})
    assert len(find(tmp_path / "r.urdf", "missing-collision")) == count


def test_advice_does_not_repeat_the_origin_that_is_there(tmp_path):
    """The meshes of visual and collision have different frames, and both origins are equal."""
    corners = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
    files = {
        name: "".join(f"v {x / 5 + dx} {y / 5} {z / 5}\n" for x, y, z in corners)
        + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
        for name, dx in (("see.obj", 0.0), ("touch.obj", 0.9))
    }
    inertial = MASS.replace("<mass", '<origin xyz="0.1 0.1 0.1"/><mass')
    parts = "".join(
        f'<{part}><geometry><mesh filename="{name}"/></geometry></{part}>'
        for part, name in zip(("visual", "collision"), files, strict=True)
    )
    link = f'<link name="a">{inertial}{parts}</link>'
    write(tmp_path, {**files, "r.urdf": f'<robot name="r">{link}</robot>'})
    ((_, _, message),) = find(tmp_path / "r.urdf", "collision-off-visual")
    assert "check its mesh and <origin>" in message


@pytest.mark.parametrize(("targets", "severity"), [(["gz"], "INFO"), (["gz", "ros2"], "WARNING")])
def test_a_frame_of_tf_is_for_ros(tmp_path, targets, severity):
    sensor = '<gazebo reference="a"><sensor name="s" type="imu"/></gazebo>'
    write(tmp_path, {"r.urdf": f'<robot name="r"><link name="a">{MASS}</link>{sensor}</robot>'})
    found = find(tmp_path / "r.urdf", "missing-gz-frame-id", targets=targets)
    assert [level for _, level, _ in found] == [severity]


def _chain(*masses):
    """Return a robot of links on fixed joints, each with a box and a mass, or no inertial."""
    links = "".join(
        f'<link name="l{i}">{MASS if mass else ""}<visual>{BOX}</visual></link>'
        for i, mass in enumerate(masses)
    )
    joints = "".join(
        f'<joint name="j{i}" type="{"fixed" if fixed else "revolute"}"><parent link="l{i}"/>'
        f'<child link="l{i + 1}"/><limit lower="-1" upper="1" effort="9" velocity="9"/></joint>'
        for i, fixed in enumerate((False, True)[: len(masses) - 1])
    )
    return f'<robot name="r">{links}{joints}</robot>'


@pytest.mark.parametrize(
    ("root", "said"), [(True, None), (False, "load nothing: a model must have at least one link")]
)
def test_gazebo_lumps_no_link_of_a_robot_whose_root_has_no_mass(tmp_path, root, said):
    """Run with sdformat 12.3: it writes a model without a link."""
    write(tmp_path, {"r.urdf": _chain(root, False, True)})
    report, _ = check(tmp_path / "r.urdf", "missing-inertial")
    effects = {f.name: f.effects.get("gz, gazebo-classic") for f in report.findings}
    assert effects["l1"] == said


@pytest.mark.parametrize(
    ("part", "compiler", "readers"),
    [
        ("visual", "", []),
        ("visual", '<mujoco><compiler discardvisual="false"/></mujoco>', ["mujoco", "drake"]),
        ("collision", "", ["mujoco", "drake"]),
    ],
)
def test_mujoco_does_not_warn_of_names_of_visuals_that_it_discards(
    tmp_path, part, compiler, readers
):
    shape = f'<{part} name="lid">{BOX}</{part}>'
    robot = f'<robot name="r">{compiler}<link name="a">{MASS}{shape}{shape}</link></robot>'
    write(tmp_path, {"r.urdf": robot})
    report = check_file(tmp_path / "r.urdf", Options(Settings()))
    found = [f for f in report.findings if f.code == "duplicate-geometry-name"]
    assert [list(f.effects) for f in found] == ([readers] if readers else [])


@pytest.mark.parametrize(
    ("look", "said"),
    [
        ('<texture filename="a.png"/>', "texture of material 'gray' differs from the color in"),
        ('<color rgba="1 0 0 1"/>', "color of material 'gray' differs from that in"),
        ('<color rgba="0.8 0.8 0.8 1"/>', ""),
    ],
)
def test_a_texture_beside_a_color_is_no_other_color(tmp_path, look, said):
    top = '<material name="gray"><color rgba="0.8 0.8 0.8 1"/></material>'
    visual = f'<visual>{BOX}<material name="gray">{look}</material></visual>'
    write(tmp_path, {"r.urdf": f'<robot name="r">{top}<link name="a">{visual}</link></robot>'})
    report, _ = check(tmp_path / "r.urdf", "conflicting-material")
    assert [said in f.message for f in report.findings] == [True] * bool(said)
    assert all(("pybullet" in f.effects) is ("texture" not in look) for f in report.findings)


@pytest.mark.parametrize(
    ("name", "severity"), [("drill", None), ("other", "WARNING"), ("", "WARNING")]
)
def test_pinocchio_knows_the_capsules_of_a_link_by_name(tmp_path, name, severity):
    """Run with pinocchio 4.1: a cylinder of that name becomes a capsule."""
    collision = f'<collision name="{name}">' if name else "<collision>"
    tool = f'{collision}{BOX}</collision><collision_checking><capsule name="drill"/>'
    robot = f'<robot name="r"><link name="a">{tool}</collision_checking></link></robot>'
    write(tmp_path, {"r.urdf": robot})
    found = find(tmp_path / "r.urdf", "unknown-element")
    assert [one[1] for one in found] == [severity] * bool(severity)
    assert fix(tmp_path / "r.urdf", "unknown-element")[0] == robot


@pytest.mark.parametrize(("tag", "effects"), [("sensor:camera", False), ("camera", True)])
def test_newton_takes_no_inertia_from_a_file_with_an_undeclared_prefix(tmp_path, tag, effects):
    """Run with Newton 1.8: ParseError, unbound prefix."""
    inertial = MASS.replace('izz="0.0017"', 'izz="0.5"')
    block = f"<gazebo><{tag}/></gazebo>"
    robot = f'<robot name="r"><link name="a">{inertial}</link>{block}</robot>'
    write(tmp_path, {"r.urdf": robot})
    report, _ = check(tmp_path / "r.urdf", "inertia-triangle-inequality")
    (finding,) = report.findings
    assert ("newton" in ", ".join(finding.effects)) is effects


SRDF = (
    '<robot name="r"><group name="g"><link name="a"/><link name="{}"/></group>'
    '<disable_collisions link1="a" link2="{}" reason="Never"/></robot>'
)


@pytest.mark.parametrize(("link", "count"), [("c", 0), ("d", 1)])
def test_an_srdf_is_that_of_the_robot_with_its_links(tmp_path, link, count):
    """Two robots have one name: the SRDF with links of the other is not about this one."""
    write(
        tmp_path,
        {
            "seven.urdf": '<robot name="r"><link name="a"/><link name="b"/></robot>',
            "six_camera.urdf": '<robot name="r"><link name="a"/><link name="c"/></robot>',
            "six.srdf": SRDF.format(link, link),
        },
    )
    found = find(tmp_path / "seven.urdf", "srdf-unknown-link")
    assert len(found) == count
    assert len(find(tmp_path / "six_camera.urdf", "srdf-unknown-link")) == count


PITCH = """<mujoco><asset><mesh name="pitch" file="pitch.stl"{scale}/></asset><worldbody>
<body name="field"><geom type="mesh" mesh="pitch" contype="0" conaffinity="0" mass="1"/></body>
<body name="board" pos="0 10 0"><geom type="box" size="{half} 0.05 0.2"/></body>
<body name="ball"><freejoint/><geom size="0.1"/></body></worldbody></mujoco>"""


@pytest.mark.parametrize(("half", "count"), [("14", 0), ("1", 1)])
def test_a_pitch_of_22_m_is_not_in_millimeters(tmp_path, half, count):
    pytest.importorskip("mujoco")
    trimesh = pytest.importorskip("trimesh")
    trimesh.creation.box((22, 14, 0.1)).export(tmp_path / "pitch.stl")
    write(tmp_path, {"pitch.xml": PITCH.format(half=half, scale="")})
    from urdftool.api.lint import check as check_robot

    found = check_robot(tmp_path / "pitch.xml")  # scenery is off by default
    assert sum(one.code == "mesh-in-millimeters" for one in found) == count


def test_a_slab_that_is_fixed_to_the_world_is_not_in_millimeters(tmp_path):
    pytest.importorskip("mujoco")
    trimesh = pytest.importorskip("trimesh")
    trimesh.creation.box((20, 20, 0.1)).export(tmp_path / "pitch.obj")
    text = PITCH.format(half="1", scale="").replace("pitch.stl", "pitch.obj")
    write(tmp_path, {"pitch.xml": text})
    from urdftool.api.lint import check as check_robot

    assert "mesh-in-millimeters" not in {one.code for one in check_robot(tmp_path / "pitch.xml")}


def check_other(path, *rules):
    """Check a robot in another format than URDF."""
    from urdftool.api.lint import check as check_robot

    return check_robot(path, select=list(rules))


def test_damping_that_mujoco_takes_as_written_is_a_warning(tmp_path):
    pytest.importorskip("mujoco")
    body = '<body><joint name="j" damping="-0.01"/><geom size="0.1"/></body>'
    write(tmp_path, {"r.xml": f"<mujoco><worldbody>{body}</worldbody></mujoco>"})
    (finding,) = check_other(tmp_path / "r.xml", "negative-dynamics")
    assert finding.severity.name == "WARNING"
