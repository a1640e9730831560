import json
import os
import subprocess

import jsonschema
import pytest

from tests.conftest import FIXTURES, ROOT

SCHEMA = json.loads((ROOT / "docs" / "schemas" / "diff.json").read_text())
ROBOT = """<robot name="r">
<link name="base"/>
<link name="arm"><inertial><origin xyz="0 0 1"/><mass value="{mass}"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial></link>
<joint name="j" type="revolute"><parent link="base"/><child link="arm"/>
<origin xyz="0 0 {height}"/><axis xyz="0 0 1"/><limit upper="{upper}" effort="1" velocity="1"/>
</joint></robot>
"""


def text(mass=2, height=0.5, upper=1):
    return ROBOT.format(mass=mass, height=height, upper=upper)


def git(*words):
    env = {
        **os.environ,
        **{
            f"GIT_{who}_{what}": "a"
            for who in ("AUTHOR", "COMMITTER")
            for what in ("NAME", "EMAIL")
        },
        "GIT_CONFIG_GLOBAL": os.devnull,
    }
    subprocess.run(["git", *words], check=True, capture_output=True, env=env)


@pytest.fixture
def repository(write, xacro_file):
    git("init", "-q", ".")
    write("package.xml", "<package><name>robot_pkg</name></package>")
    write("urdf/size.xacro", "<robot xmlns:xacro='x'><xacro:property name='h' value='1'/></robot>")
    include = '<xacro:include filename="$(find robot_pkg)/urdf/size.xacro"/>'
    mesh = '<visual><geometry><mesh filename="file://$(find robot_pkg)/m.stl"/></geometry></visual>'
    body = (
        f'{include}<xacro:arg name="p" default=""/><link name="$(arg p)a"/><link name="b">{mesh}'
        '</link><joint name="j" type="fixed"><parent link="$(arg p)a"/><child link="b"/>'
        '<origin xyz="0 0 ${h}"/></joint>'
    )
    path = xacro_file("urdf/arm.urdf.xacro", body)
    git("add", ".")
    git("commit", "-q", "-m", "first")
    return path


def test_what_changed_is_said_and_exit_1(urdftool, write):
    old, new = write("old.urdf", text()), write("new.urdf", text(3, 0.512, 1.5))
    result = urdftool("diff", old, new)
    assert result.code == 1
    assert result.out == (
        "link 'arm'\n"
        "  mass: 2 → 3 kg (+50 %)\n"
        "joint 'j'\n"
        "  origin: xyz 0 0 0.5 → xyz 0 0 0.512 (moved 12 mm)\n"
        "  limit upper: 1 → 1.5 rad\n"
    )
    assert result.err == "old.urdf → new.urdf: 3 changes in 2 parts\n"


def test_the_same_robot_is_exit_0(urdftool, write):
    other = text().replace("\n", "  ").replace('xyz="0 0 0.5"', 'xyz="0 0 5e-1" rpy="0 0 0"')
    result = urdftool("diff", write("a.urdf", text()), write("b.urdf", other))
    assert (result.code, result.out) == (0, "")
    assert result.err == (
        "a.urdf → b.urdf: no differences (meshes by their names, not by content)\n"
    )


def test_numbers_that_differ_look_different(urdftool, write):
    result = urdftool("diff", write("a.urdf", text(3)), write("b.urdf", text(3.0000002)))
    assert result.out == "link 'arm'\n  mass: 3 → 3.0000002 kg (+6.67e-06 %)\n"


def test_a_tolerance(urdftool, write):
    old, new = write("old.urdf", text()), write("new.urdf", text(2.0001, 0.50001))
    assert urdftool("diff", old, new).code == 1
    assert urdftool("diff", old, new, "--tolerance", "1e-3").code == 0


@pytest.mark.parametrize("command", ["diff", "verify"])
@pytest.mark.parametrize("value", ["nan", "inf"])
def test_a_tolerance_is_a_finite_number(urdftool, write, command, value):
    path = write("a.urdf", text())
    result = urdftool(command, path, path, "--tolerance", value)
    assert result.code == 2
    assert f"'{value}' is not a finite number" in result.err


def test_json_follows_its_schema(urdftool, write):
    old, new = write("old.urdf", text()), write("new.urdf", text(3, 0.512, 1.5))
    found = json.loads(urdftool("diff", old, new, "--format", "json").out)
    jsonschema.validate(found, SCHEMA)
    assert [change["what"] for change in found["changes"]] == ["mass", "origin", "limit upper"]
    mass = found["changes"][0]
    assert (mass["before"], mass["after"], mass["path"], mass["line"]) == (2, 3, "new.urdf", 3)
    same = json.loads(urdftool("diff", old, old, "--format", "json").out)
    assert same["equal"] is True
    jsonschema.validate(same, SCHEMA)


def test_json_of_elements_that_only_one_format_has_follows_its_schema(urdftool, write):
    model = (
        '<sdf version="1.9"><model name="m"><link name="a">{}'
        "<inertial><mass>1</mass></inertial></link>{}</model></sdf>"
    )
    light = '<light name="l" type="point"/>'
    plugin = '<plugin name="p" filename="f"/><gripper name="g"/>'
    files = write("a.sdf", model.format("", "")), write("b.sdf", model.format(light, plugin))
    found = json.loads(urdftool("diff", *files, "--format", "json").out)
    jsonschema.validate(found, SCHEMA)
    assert {"<light>", "plugin"} <= {change["element"]["kind"] for change in found["changes"]}
    assert {change["what"] for change in found["changes"]} == {"added"}


def test_markdown_is_a_table_in_which_names_are_no_markup(urdftool, write):
    old = write("old.urdf", '<robot name="r"><link name="a"/></robot>')
    new = write("new.urdf", '<robot name="r"><link name="a"/><link name="|&lt;b>`*"/></robot>')
    result = urdftool("diff", old, new, "--format", "markdown")
    assert result.out == (
        "**old.urdf → new.urdf: 1 change in 1 part**\n\n"
        "| part | what | before | after | |\n|---|---|---|---|---|\n"
        "| link '\\|\\<b\\>\\`\\*' | added |  |  |  |\n"
    )


def test_real_robots(urdftool):
    folder = FIXTURES / "robots" / "mira_description" / "urdf"
    result = urdftool("diff", folder / "mira.urdf", folder / "mira_simple.urdf", "--format", "json")
    jsonschema.validate(json.loads(result.out), SCHEMA)
    assert result.code == 1


def test_xacro_arguments_belong_to_the_file_before_them(urdftool, repository):
    result = urdftool("diff", repository, "p:=left_", repository, "p:=right_")
    assert result.code == 1
    assert result.out == "link 'right_a'\n  renamed: left_a → right_a\n"
    assert urdftool("diff", f"HEAD:{repository}", repository, "p:=x_").code == 0
    same = urdftool("diff", repository, repository, "p:=x_")  # the default and these arguments
    assert same.code == 1
    assert same.err.endswith(f"{repository} p:=x_: 1 change in 1 part\n")


def test_a_revision_has_its_includes(urdftool, repository, write):
    assert urdftool("diff", f"HEAD:{repository}", repository).code == 0
    write("urdf/size.xacro", "<robot xmlns:xacro='x'><xacro:property name='h' value='2'/></robot>")
    result = urdftool("diff", f"HEAD:{repository}", repository)
    assert result.code == 1
    assert result.out == ("joint 'j'\n  origin: xyz 0 0 1 → xyz 0 0 2 (moved 1000 mm)\n")
    back = urdftool("diff", repository, f"HEAD:{repository}", "--format", "json")
    (change,) = json.loads(back.out)["changes"]
    assert change["path"] == "HEAD:urdf/arm.urdf.xacro"


def test_a_revision_leaves_the_repository_alone(urdftool, repository, write, tmp_path):
    write("urdf/size.xacro", "<robot xmlns:xacro='x'><xacro:property name='h' value='2'/></robot>")
    status = ["git", "status", "--porcelain"]
    before = subprocess.run(status, capture_output=True, text=True).stdout
    files = {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()}
    urdftool("diff", f"HEAD:{repository}", repository)
    after = {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file() and p in files}
    assert subprocess.run(status, capture_output=True, text=True).stdout == before
    assert after == files


def test_a_path_at_a_revision_may_be_from_the_current_folder(urdftool, repository, monkeypatch):
    monkeypatch.chdir("urdf")
    assert urdftool("diff", "HEAD:arm.urdf.xacro", "arm.urdf.xacro").code == 0
    assert urdftool("diff", "HEAD:./arm.urdf.xacro", "arm.urdf.xacro").code == 0
    assert urdftool("diff", "HEAD:urdf/arm.urdf.xacro", "arm.urdf.xacro").code == 0


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("nothing:urdf/arm.urdf.xacro", "revision 'nothing' does not exist"),
        ("HEAD:gone.urdf", "HEAD:gone.urdf: file 'gone.urdf' does not exist"),
        ("--upload-pack=x:a.urdf", "No such option"),
        (":a.urdf", "'' is not a git revision"),
    ],
)
def test_what_git_does_not_know_is_one_message(urdftool, repository, word, said):
    result = urdftool("diff", word, repository)
    assert result.code == 2
    assert said in result.err


def test_an_error_at_a_revision_names_the_revision(urdftool, repository, write):
    write("urdf/arm.urdf.xacro", "<robot name='r'/>")
    write("urdf/size.xacro", "<robot><")
    git("commit", "-q", "-a", "-m", "broken")
    write("urdf/bad.urdf", "<robot")
    git("add", ".")
    git("commit", "-q", "-m", "bad")
    result = urdftool("diff", "HEAD:urdf/bad.urdf", repository)
    assert result.code == 2
    assert result.err.startswith("HEAD:urdf/bad.urdf:1:")
    broken = urdftool("diff", "HEAD~2:urdf/arm.urdf.xacro", "nofile:=1", repository)
    assert "urdftool-" not in broken.err + result.err


def test_outside_a_repository(urdftool, write, monkeypatch):
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", "/")
    result = urdftool("diff", "HEAD:a.urdf", write("a.urdf", text()))
    assert result.code == 2
    assert "not a git repository" in result.err


@pytest.mark.parametrize("words", [[], ["a.urdf"], ["x:=1", "a.urdf"], ["a", "b", "c"], ["-", "-"]])
def test_two_robots_are_wanted(urdftool, words):
    result = urdftool("diff", *words)
    assert result.code == 2
    assert "Try 'urdftool diff --help'" in result.err


def test_what_only_verify_found_is_a_difference(urdftool, write):
    """Elements of a URDF that are in no block, and what holds for a whole robot or its looks."""
    head, tail = "<robot name='r'><link name='a'>", "</link></robot>"
    pairs = {
        "link 'a'\n  contact/lateral_friction/@value: 1 → 2\n": (
            f"{head}<contact><lateral_friction value='{number}'/></contact>{tail}"
            for number in (1, 2)
        ),
        "foo\n  added\n": (head + tail, f"{head}</link><foo x='1'/></robot>"),
        "loop_joint 'l'\n  @type: ball → none\n": (
            f"{head}</link><loop_joint name='l'{kind}/></robot>" for kind in (" type='ball'", "")
        ),
        "joint 'j'\n  foo/@x: 1 → 2\n": (
            f"{head}</link><link name='b'/><joint name='j' type='fixed'><parent link='a'/>"
            f"<child link='b'/><foo x='{number}'/></joint></robot>"
            for number in (1, 2)
        ),
        "robot 'm'\n  gravity: 0 0 -9.81 → 0 0 -1 m/s²\n": (
            f"<mujoco model='m'><option gravity='0 0 {z}'/><worldbody><body name='b'>"
            "<freejoint/><geom size='1'/></body></worldbody></mujoco>"
            for z in (-9.81, -1)
        ),
        "robot 'm'\n  self collide: false → true\n": (
            f"<sdf version='1.10'><model name='m'><self_collide>{word}</self_collide>"
            "<link name='a'/></model></sdf>"
            for word in ("false", "true")
        ),
        "link 'a'\n  base: free → fixed\n": (
            f"<sdf version='1.10'><model name='m'><static>{word}</static><link name='a'/></model>"
            "</sdf>"
            for word in ("false", "true")
        ),
    }
    for out, texts in pairs.items():
        ending = {"<s": "sdf", "<m": "xml"}
        paths = [
            write(f"{name}.{ending.get(text[:2], 'urdf')}", text)
            for name, text in zip("ab", texts, strict=True)
        ]
        result = urdftool("diff", *paths)
        assert (result.code, result.out) == (1, out)


def test_an_attribute_that_is_equal_to_the_name_is_compared(urdftool, write):
    text = "<robot name='r'><link name='a'/><gazebo reference='a'><sensor name='camera' type='{}'/>"
    paths = [
        write(f"{kind}.urdf", text.format(kind) + "</gazebo></robot>")
        for kind in ("camera", "depth")
    ]
    assert urdftool("diff", *paths).out == ("gazebo 'a'\n  sensor[camera]/@type: camera → depth\n")
