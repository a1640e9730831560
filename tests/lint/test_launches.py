"""Descriptions and arguments in launch files of Python and XML, and in CMake."""

import pytest

from urdftool.lint.launches import UNKNOWN, read_uses

ROS2 = """
def generate_launch_description():
    DeclareLaunchArgument("prefix", default_value='"left_"')
    prefix = LaunchConfiguration("prefix")
    name = LaunchConfiguration("robot_name")
    {}
"""
COMMAND = """Command([
        PathJoinSubstitution([FindExecutable(name="xacro")]), " ",
        PathJoinSubstitution([FindPackageShare("arm"), "urdf", "arm.urdf.xacro"]), " ",
        "prefix:=", prefix, " ", "use_sim:=true", " name:=", name])"""
ARM = "/ws/arm/urdf/arm.urdf.xacro"
PYTHON = {
    "Command of substitutions": (
        COMMAND,
        [(ARM, {"prefix": "left_", "use_sim": "true"}, ["name"])],
    ),
    "process_file with mappings": (
        'p = os.path.join(get_package_share_directory("arm"), "urdf", "arm.urdf.xacro")\n'
        '    xacro.process_file(p, mappings={"a": "b c", "c": choose(), "d": ""}).toxml()',
        [(ARM, {"a": "b c", "d": ""}, ["c"])],
    ),
    "a path with operators": (
        'Command(["xacro ", str(get_package_share_path("arm") / "urdf/arm.urdf.xacro")])',
        [(ARM, {}, [])],
    ),
    "an f-string": (
        'share = get_package_share_directory("arm")\n'
        '    Command(f"xacro {share}/urdf/arm.urdf.xacro a:=1")',
        [(ARM, {"a": "1"}, [])],
    ),
    "a computed path": (
        'Command(["xacro ", choose(), "/a.xacro"])',
        [(UNKNOWN + "/a.xacro", {}, [])],
    ),
    "a name with two values": (
        'x = "a.xacro"\n    x = "b.xacro"\n    Command(["xacro ", x, ".xacro"])',
        [(UNKNOWN + ".xacro", {}, [])],
    ),
    "a package that is not found": (
        'Command(["xacro ", FindPackageShare("none"), "/a.xacro"])',
        [(UNKNOWN + "/a.xacro", {}, [])],
    ),
    "a document that is parsed": (
        'p = os.path.join(get_package_share_directory("arm"), "urdf", "arm.xacro.urdf")\n'
        "    doc = xacro.parse(open(p))\n"
        '    xacro.process_doc(doc, mappings={"prefix": "l_"})',
        [
            ("/ws/arm/urdf/arm.xacro.urdf", {"prefix": "l_"}, []),
            ("/ws/arm/urdf/arm.xacro.urdf", {}, []),
        ],
    ),
    "a file that is opened": (
        'p = os.path.join(get_package_share_directory("arm"), "urdf", os.environ["M"] + ".urdf")\n'
        "    with open(p) as file:\n        text = file.read()",
        [(f"/ws/arm/urdf/{UNKNOWN}.urdf", {}, [])],
    ),
    "choices without a default": (
        'DeclareLaunchArgument("size", choices=["s", "l"])\n'
        '    DeclareLaunchArgument("sim", default_value="true", choices=["true", "false"])\n'
        '    Command(["xacro a.xacro size:=", LaunchConfiguration("size"), " sim:=",'
        ' LaunchConfiguration("sim")])',
        [("a.xacro", {"size": size, "sim": "true"}, []) for size in "sl"],
    ),
    "more choices than are tried": (
        'DeclareLaunchArgument("n", choices=["1", "2", "3", "4", "5", "6"])\n'
        '    DeclareLaunchArgument("m", choices=["1", "2", "3", "4", "5", "6"])\n'
        '    Command(["xacro a.xacro n:=", LaunchConfiguration("n"), " m:=",'
        ' LaunchConfiguration("m")])',
        [("a.xacro", {}, ["n", "m"])],
    ),
    "a function that is called with the context": (
        'kind = DeclareLaunchArgument("kind", choices=["a", "b"])\n'
        "    OpaqueFunction(function=run, args=[LaunchConfiguration(kind.name), choose()])\n"
        "def run(context, arm, other):\n"
        "    arm_name = context.perform_substitution(arm)\n"
        '    grip = LaunchConfiguration("prefix").perform(context)\n'
        '    p = os.path.join(get_package_share_directory("arm"), arm_name, arm_name + ".xacro")\n'
        '    xacro.process_file(p, mappings={"g": grip, "o": other})',
        [(f"/ws/arm/{kind}/{kind}.xacro", {"g": '"left_"'}, ["o"]) for kind in "ab"],
    ),
    "a configuration of MoveIt": (
        'MoveItConfigsBuilder("arm").robot_description(file_path="config/arm.urdf.xacro",'
        ' mappings={"a": "b"}).robot_description_semantic(file_path="config/arm.srdf")',
        [("/ws/arm_moveit_config/config/arm.urdf.xacro", {"a": "b"}, [])],
    ),
    "a configuration of MoveIt in a named package": (
        'MoveItConfigsBuilder("arm", package_name="motion").robot_description("arm.urdf")',
        [("/ws/motion/arm.urdf", {}, [])],
    ),
    "no description": ('Command(["echo ", "hello"])', []),
}


def find(name):
    return None if name == "none" else f"/ws/{name}"


def uses(path, text):
    found = read_uses(path, text, find)
    return [(use.target, dict(use.arguments), list(use.computed)) for use in found]


@pytest.mark.parametrize(("code", "expected"), PYTHON.values(), ids=PYTHON)
def test_python(code, expected):
    assert uses("arm/launch/arm.launch.py", ROS2.format(code)) == expected


@pytest.mark.parametrize("text", ["def f(:", "(" * 10_000, "-" * 20_000 + "1", "\0", "x = " * 3000])
def test_what_is_no_python_has_no_description(text):
    assert uses("a.launch.py", text) == []


def test_nothing_is_executed(tmp_path):
    mark = tmp_path / "mark"
    text = f'Command(["xacro ", open({str(mark)!r}, "w").name, "/a.xacro"])'
    assert uses("a.launch.py", text) == [(UNKNOWN + "/a.xacro", {}, [])]
    assert not mark.exists()


XML = """<launch>
  <arg name="model" default="$(find arm)/urdf/arm.urdf.xacro"/>
  <arg name="limited" default="false"/>
  <arg name="open"/>
  <!-- <param command="xacro comment.xacro"/> -->
  <param name="d" {}/>
</launch>"""
VALUES = {
    "command=\"$(find xacro)/xacro '$(arg model)' l:=$(arg limited) o:=$(arg open)\"": (
        (ARM, {"l": "false"}, ["o"])
    ),
    "value=\"$(command 'xacro $(find-pkg-share arm)/urdf/arm.urdf.xacro a:=1')\"": (
        (ARM, {"a": "1"}, [])
    ),
    'command="xacro $(dirname)/../arm.xacro"': ("arm/launch/../arm.xacro", {}, []),
    'command="xacro $(env ROBOT).xacro"': (UNKNOWN + ".xacro", {}, []),
    'command="xacro a.xacro l:=$(optenv LASER false) m:=$(optenv MORE)"': (
        ("a.xacro", {"l": "false"}, ["m"])
    ),
}


@pytest.mark.parametrize(("value", "expected"), VALUES.items())
def test_xml(value, expected):
    default = ARM, {}, []
    assert uses("arm/launch/arm.launch", XML.format(value)) == [default, expected]


def test_arguments_of_an_included_file_are_not_those_of_this_file():
    given = '<include file="b.launch"><arg name="limited" value="true"/></include>'
    text = XML.format('command="xacro a.xacro l:=$(arg limited)"').replace("</launch>", given)
    assert uses("a.launch", text)[1:] == [("a.xacro", {"l": "false"}, [])]


CMAKE = {
    "xacro_add_xacro_file(urdf/a.xacro a.urdf REMAP p:=1 q:=2)": (
        "/p/urdf/a.xacro",
        {"p": "1", "q": "2"},
    ),
    "add_custom_target(b COMMAND ${X} xacro ${CMAKE_CURRENT_SOURCE_DIR}/b.xacro r:=s -o b.urdf)": (
        "/p/b.xacro",
        {"r": "s"},
    ),
    "xacro_add_files(c.xacro INSTALL DESTINATION urdf)": ("/p/c.xacro", {}),
    "# xacro_add_files(d.xacro)": None,
    "install(DIRECTORY urdf DESTINATION share/${PROJECT_NAME})": None,
}


@pytest.mark.parametrize(("text", "expected"), CMAKE.items())
def test_cmake(text, expected):
    found = [(target, given) for target, given, _ in uses("/p/CMakeLists.txt", text)]
    assert found == ([] if expected is None else [expected])
