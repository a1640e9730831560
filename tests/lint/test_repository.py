"""All robots of a folder: by name, content, configuration, launch files and CMake."""

import subprocess
from pathlib import Path

import pytest

from tests.conftest import XACRO

HEAD = '<robot name="{}" xmlns:xacro="http://www.ros.org/wiki/xacro">'
MACRO = '<xacro:macro name="leg" params="n"><link name="${n}"/></xacro:macro>'
WRONG = (
    '<link name="b"/><joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
    '<axis xyz="0 0 0"/></joint>'
)
ONLY = ("--select", "zero-axis", "--format", "concise")


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package with a part, two robots that include it, and a robot by its name."""
    monkeypatch.chdir(tmp_path)
    files = {
        "package.xml": "<package><name>arm</name></package>",
        "urdf/leg.xacro": HEAD.format("leg") + MACRO + "</robot>",
        "urdf/one.xacro": HEAD.format("one")
        + '<xacro:include filename="leg.xacro"/><xacro:leg n="a"/></robot>',
        "urdf/two.xacro": HEAD.format("two")
        + '<xacro:arg name="wrong" default="false"/>'
        + '<xacro:include filename="$(find arm)/urdf/leg.xacro"/><xacro:leg n="a"/>'
        + f'<xacro:if value="$(arg wrong)">{WRONG}</xacro:if></robot>',
        "three.urdf": '<robot name="three"><link name="a"/></robot>',
        "urdf/part.xacro": HEAD.format("part").replace(' name="part"', "")
        + '<link name="x"/></robot>',
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    return tmp_path


def last(result):
    return result.err.splitlines()[-1]


def listed(urdftool, *words):
    return [
        line for line in urdftool("lint", ".", "--list", *words).out.splitlines() if line[0] != " "
    ]


def test_robots_by_name_and_content(package, urdftool):
    result = urdftool("lint", ".", *ONLY)
    assert result.code == 0
    assert last(result) == ("checked 3 robots (3 variants), 1 file belongs to them, 0 not checked")
    assert "urdf/part.xacro: skipped, has links, but its <robot> has no name" in result.err


def test_list(package, urdftool):
    result = urdftool("lint", ".", "--list")
    assert (result.code, result.err) == (0, "")
    assert result.out.splitlines() == [
        "three.urdf  (by its name)",
        "urdf/one.xacro  (its <robot> has a name and links, and no file includes it)",
        "  includes urdf/leg.xacro",
        "urdf/two.xacro  (its <robot> has a name and links, and no file includes it)",
        "  includes urdf/leg.xacro",
        "urdf/part.xacro  (no robot includes it)",
    ]


def test_a_file_of_the_configuration_is_a_robot(package, urdftool):
    (package / "urdftool.toml").write_text('[lint]\nrobots = ["urdf/part.xacro"]\n')
    assert "urdf/part.xacro  (named by ./urdftool.toml)" in " ".join(listed(urdftool)).replace(
        str(package), "."
    )
    (package / "urdftool.toml").write_text('[[lint.variants]]\nfile = "urdf/part.xacro"\n')
    assert any("urdf/part.xacro  (named by" in line for line in listed(urdftool))
    (package / "urdftool.toml").write_text('[lint]\nrobots = ["urdf/none.xacro"]\n')
    result = urdftool("lint", ".")
    assert result.code == 2
    assert "lint.robots: file urdf/none.xacro does not exist" in result.err


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "launch/arm.launch.py",
            'Command(["xacro ", FindPackageShare("arm"), "/urdf/two.xacro", " wrong:=true"])',
        ),
        (
            "launch/arm.launch",
            '<launch><param command="xacro $(find arm)/urdf/two.xacro wrong:=true"/></launch>',
        ),
        ("CMakeLists.txt", "xacro_add_xacro_file(urdf/two.xacro two.urdf REMAP wrong:=true)"),
    ],
)
def test_arguments_of_launch_files_are_variants(package, urdftool, name, text):
    (package / name).parent.mkdir(exist_ok=True)
    (package / name).write_text(text)
    result = urdftool("lint", ".", *ONLY)
    assert result.code == 1
    assert "[zero-axis]" in result.out
    assert "  with wrong=true" in urdftool("lint", ".", "--list").out


def test_two_launch_files_are_two_variants(package, urdftool):
    for name, value in (("a", "true"), ("b", "false")):
        (package / f"{name}.launch.py").write_text(
            f'Command(["xacro ", FindPackageShare("arm"), "/urdf/two.xacro wrong:={value}"])'
        )
    result = urdftool("lint", ".", *ONLY)
    assert "checked 3 robots (4 variants)" in last(result)
    assert "wrong=true" in result.out


def test_a_launch_file_that_computes_its_path_is_said(package, urdftool):
    (package / "a.launch.py").write_text('Command(["xacro ", choose(), "/two.xacro"])')
    result = urdftool("lint", ".", "--list")
    assert "paths of descriptions that are computed, and not followed: a.launch.py:1" in result.err


def test_a_robot_that_is_not_checked_fails_and_is_named(package, urdftool):
    (package / "urdf/leg.xacro").write_text(HEAD.format("leg") + "<oops></robot>")
    result = urdftool("lint", ".", *ONLY)
    assert result.code == 2
    assert last(result).endswith("2 not checked: urdf/one.xacro, urdf/two.xacro")
    assert "urdf/leg.xacro: skipped" not in result.err  # it belongs to robots that stopped


def test_a_file_that_is_not_well_formed_fails(package, urdftool):
    (package / "urdf/broken.xacro").write_text("<robot>")
    assert urdftool("lint", ".", *ONLY).code == 2
    (package / "urdftool.toml").write_text('[lint]\nexclude = ["urdf/broken.xacro"]\n')
    assert urdftool("lint", ".", *ONLY).code == 0


@pytest.mark.parametrize("mark", ["COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE"])
def test_folders_that_builds_ignore_are_skipped(package, urdftool, mark):
    folder = package / "install"
    folder.mkdir()
    (folder / "copy.urdf").write_text((package / "three.urdf").read_text())
    assert any("install/copy.urdf" in line for line in listed(urdftool))
    (folder / mark).touch()
    assert not any("install/copy.urdf" in line for line in listed(urdftool))


def test_files_that_include_each_other_end(package, urdftool):
    for one, other in (("a", "b"), ("b", "a")):
        (package / f"urdf/{one}.xacro").write_text(
            HEAD.format(one)
            + f'<xacro:include filename="{other}.xacro"/><link name="{one}"/></robot>'
        )
    assert urdftool("lint", ".", "--list").code == 0


@pytest.fixture
def committed(package):
    def git(*words):
        subprocess.run(
            ["git", "-c", "user.name=a", "-c", "user.email=a@b.c", *words],
            cwd=package, check=True, capture_output=True,
        )  # fmt: skip

    git("init", "-q")
    git("add", ".")
    git("commit", "-qm", "all")
    return package


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("urdf/leg.xacro", ["urdf/one.xacro", "urdf/two.xacro"]),
        ("urdf/one.xacro", ["urdf/one.xacro"]),
        ("urdf/part.xacro", []),
        ("package.xml", ["three.urdf", "urdf/one.xacro", "urdf/two.xacro"]),
    ],
)
def test_changed_files_concern_the_robots_that_include_them(committed, urdftool, name, expected):
    path = committed / name
    path.write_text(path.read_text().replace("</", " </", 1))
    lines = listed(urdftool, "--changed-since", "HEAD")
    assert [line.partition("  ")[0] for line in lines if "no robot" not in line] == expected


def test_a_moved_manifest_concerns_all_robots_and_a_configuration_those_below(tmp_path, urdftool):
    def select(root, change):
        root.mkdir()
        for name in ("a/r.urdf", "b/r.urdf"):
            (root / name).parent.mkdir()
            (root / name).write_text('<robot name="r"><link name="a"/></robot>')
        (root / "p").mkdir()
        (root / "p/package.xml").write_text("<package><name>p</name></package>")
        git = ["git", "-c", "user.name=a", "-c", "user.email=a@b.c"]
        for words in (["init", "-q"], ["add", "."], ["commit", "-qm", "all"]):
            subprocess.run([*git, *words], cwd=root, check=True)
        change(root)
        lines = urdftool("lint", root, "--list", "--changed-since", "HEAD").out.splitlines()
        return {line.partition("r.urdf")[0][-2] for line in lines if "no robot" not in line}

    assert select(tmp_path / "1", lambda root: (root / "p").rename(root / "q")) == {"a", "b"}
    assert select(tmp_path / "2", lambda root: (root / "p/x").write_text("")) == set()
    for number, name in enumerate(("urdftool.toml", ".urdftool.toml", "pyproject.toml"), 3):
        write = lambda root, name=name: (root / "a" / name).write_text("")  # noqa: E731
        assert select(tmp_path / str(number), write) == {"a"}


def test_changed_since_needs_a_revision(committed, urdftool):
    for words, said in ((["v9"], "git knows no revision 'v9'"), (["--output=x"], "not a revision")):
        result = urdftool("lint", ".", f"--changed-since={words[0]}")
        assert result.code == 2
        assert said in result.err
    assert not (committed / "x").exists()


@pytest.mark.parametrize("prefix", ["package://arm/", "file://$(find arm)/", "$(find arm)/"])
def test_a_mesh_that_does_not_exist_is_found_in_each_way_of_writing(package, urdftool, prefix):
    (package / "urdf/one.xacro").write_text(
        HEAD.format("one") + '<link name="a"><visual><geometry>'
        f'<mesh filename="{prefix}meshes/gone.stl"/></geometry></visual></link></robot>'
    )
    result = urdftool("lint", ".", "--select", "mesh-not-found", "--format", "concise")
    assert result.code == 1
    assert "mesh file of link 'a' does not exist" in result.out


def test_included_files_are_found_where_they_are_installed_from(package, urdftool):
    (package / "CMakeLists.txt").write_text(
        "install(DIRECTORY source/parts DESTINATION share/${PROJECT_NAME})"
    )
    (package / "source/parts").mkdir(parents=True)
    (package / "source/parts/head.xacro").write_text(
        HEAD.format("head") + '<link name="head"/></robot>'
    )
    (package / "urdf/one.xacro").write_text(
        HEAD.format("one")
        + '<xacro:include filename="$(find arm)/parts/head.xacro"/><link name="a"/></robot>'
    )
    lines = urdftool("lint", ".", "--list").out.splitlines()
    assert "  includes source/parts/head.xacro" in lines
    assert not any(line.startswith("source/parts/head.xacro") for line in lines)  # no robot


def test_what_the_search_does_not_follow_is_in_the_last_line(package, urdftool, tmp_path):
    elsewhere = tmp_path.parent / f"{tmp_path.name}-elsewhere"
    elsewhere.mkdir()
    (package / "linked").symlink_to(elsewhere)
    (package / "own").symlink_to(package / "urdf")
    (package / "a.launch.py").write_text('Command(["xacro ", choose(), "/two.xacro"])')
    line = last(urdftool("lint", ".", *ONLY))
    assert line.endswith("; computed paths not followed: a.launch.py:1; links not followed: linked")
    assert "which are not followed: linked" in urdftool("lint", ".", "--list").err


NEAR = '<robot name="r"><link name="a"/></robot>'
TWICE = '<robot name="r"><link name="a"/><link name="a"/></robot>'


@pytest.fixture
def linked(tmp_path, monkeypatch):
    """Return a folder with links to a file elsewhere, to nothing, and to its own file."""
    for name, text in (("p/a.urdf", NEAR), ("q/b.urdf", TWICE)):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path / "p")
    for name, target in (("b.urdf", "../q/b.urdf"), ("gone.sdf", "no.sdf"), ("own.urdf", "a.urdf")):
        Path(name).symlink_to(target)
    return tmp_path


@pytest.mark.parametrize("command", [["lint", ".", *ONLY], ["fmt", ".", "--check"]])
def test_links_to_files_that_are_not_followed_are_named(linked, urdftool, command):
    result = urdftool(*command)
    assert "links not followed: b.urdf, gone.sdf\n" in result.err


def test_where_only_links_are_they_are_named(linked, urdftool):
    Path("a.urdf").unlink()
    result = urdftool("lint", ".")
    assert result.code == 2
    assert result.err.splitlines()[0].endswith("; links not followed: b.urdf, own.urdf")


def test_a_link_within_a_repository_is_followed(linked, urdftool):
    (linked / ".git").mkdir()
    result = urdftool("lint", ".", "--select", "duplicate-link-name")
    assert result.code == 1
    assert "b.urdf:1:" in result.out
    assert last(result).endswith("0 not checked; links not followed: gone.sdf")


def test_endings_in_capitals_are_found(tmp_path, urdftool, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("A.URDF").write_text(TWICE)
    Path("part.Xacro").write_text(HEAD.format("x") + '<link name="l"/></robot>')
    Path("M.SDF").write_text(
        "<sdf version='1.7'><model name='m'><link name='l'/></model></sdf>", "utf-8"
    )
    listed = urdftool("lint", ".", "--list").out
    assert [line.split()[0] for line in listed.splitlines()] == ["A.URDF", "part.Xacro", "M.SDF"]


def test_a_typo_in_macros_of_a_robot_that_stops_before_them_is_named(write, urdftool):
    write("package.xml", "<package><name>p</name></package>")
    wheel = """<xacro:macro name="wheel" params="n"><link name="${n}"/>
      <joint name="j" type="fixed"><parent lnik="a"/></joint></xacro:macro>"""
    write("urdf/wheel.urdf.xacro", XACRO.format(wheel))
    includes = """<xacro:include filename="$(find elsewhere)/a.xacro"/>
      <xacro:include filename="wheel.urdf.xacro"/><xacro:wheel n="w"/>"""
    write("urdf/car.urdf.xacro", XACRO.format(includes))
    result = urdftool("lint", ".", "--format", "concise")
    assert result.code == 2
    assert "urdf/wheel.urdf.xacro:" in result.out
    assert "has the unknown attribute 'lnik'; write link [unreached-typo]" in result.out
