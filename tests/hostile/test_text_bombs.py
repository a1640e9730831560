"""Small files that would take long or much memory to read: comments, includes, keys, manifests."""

import sys

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="measures processes in /proc")

ROBOT = '<robot name="r"><link name="a"/></robot>'
XACRO = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="$(find p)"/></robot>'
)
PACKAGE = "<package><name>p</name></package>"

MESH = ROBOT.replace(
    '<link name="a"/>',
    '<link name="a"><visual><geometry><mesh filename="m.obj"/></geometry></visual></link>',
)
OBJ = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
WORLD = ROBOT.replace(
    "</robot>",
    '<joint name="j" type="fixed"><parent link="world"/><child link="a"/></joint></robot>',
)
GAZEBO = "".join(
    f'<link name="part_{n}"/><gazebo reference="prat_{n}x"><mu1>1</mu1></gazebo>'
    for n in range(2000)
)
VISUAL = '<visual><geometry><box size="1 1 1"/></geometry></visual>'


def write_includes(count, times):
    files = {}
    for number in range(count):
        include = f"<include><uri>m{number + 1}.sdf</uri><name>n{{}}</name></include>"
        nested = "".join(include.format(n) for n in range(times))
        files[f"m{number}.sdf"] = f'<sdf version="1.9"><model name="m">{nested}</model></sdf>'
    files[f"m{count}.sdf"] = '<sdf version="1.9"><model name="m"><link name="l"/></model></sdf>'
    return {"r.sdf": files.pop("m0.sdf"), **files}


CASES = {
    "includes of SDF": (write_includes(12, 10), "info r.sdf"),
    "comments of CMake": (
        {"r.xacro": XACRO, "package.xml": PACKAGE, "CMakeLists.txt": "#[[\n" * 250_000},
        "expand r.xacro",
    ),
    "installs of CMake": (
        {"r.urdf": ROBOT, "package.xml": PACKAGE, "CMakeLists.txt": "install(" * 130_000},
        "lint r.urdf --no-cache",
    ),
    "a large CMakeLists.txt": (
        {"r.xacro": XACRO, "package.xml": PACKAGE, "CMakeLists.txt": "x" * (30 << 20)},
        "lint r.xacro --no-cache",
    ),
    "comments in a CDATA section": (
        {"r.xacro": XACRO.replace("<link", f"<a><![CDATA[{'<!--' * 500_000}]]></a><link")},
        "lint r.xacro --no-cache --fix --diff --unsafe-fixes",
    ),
    "comments of a manifest": (
        {"r.urdf": ROBOT, "package.xml": PACKAGE + "<!--" * 500_000},
        "lint r.urdf --no-cache",
    ),
    "blanks and comments before a root": (
        {"x.xml": " " * 40 + "x<robot/>", "y.xml": "<!---->" * 9000 + "x<robot/>"},
        "fmt --check .",
    ),
    "includes of a launch file": (
        {"r.urdf": ROBOT, "a.launch": f"<launch>xacro .urdf {'<include a>' * 90_000}</launch>"},
        "lint . --no-cache",
    ),
    "blanks in a file name": (
        {"r.urdf": MESH.replace("m.obj", f" m{' ' * 200_000}b.stl")},
        "lint r.urdf --no-cache",
    ),
    "blanks in a name": (
        {"r.urdf": WORLD.replace('k="a"', f'k=" a{" " * 200_000}b"')},
        "lint r.urdf --no-cache",
    ),
    "dots of TOML": ({"r.urdf": ROBOT, "urdftool.toml": "a." * 20_000 + "b = 1"}, "lint r.urdf"),
    "dots of TOML in quotes": (
        {"r.urdf": ROBOT, "urdftool.toml": '"a b" . ' * 20_000 + "b = 1"},
        "lint r.urdf",
    ),
    "dots of TOML in a table": (
        {"r.urdf": ROBOT, "urdftool.toml": "[lint]\nx = {" + "a." * 20_000 + "b = 1}"},
        "lint r.urdf",
    ),
    "quotes of TOML": (
        {"r.urdf": ROBOT, "urdftool.toml": 'a = "' + '\\"' * 400_000},
        "info r.urdf",
    ),
    "blanks in a license": (
        {
            "r.urdf": ROBOT,
            "package.xml": f"<package><license>{' ' * 300_000}<a/></license></package>",
        },
        "bundle r.urdf -o o",
    ),
    "blanks in an MTL": (
        {"r.urdf": MESH, "m.obj": OBJ, "m.mtl": f"newmtl m\nmap_Kd{' ' * 300_000}\n"},
        "bundle r.urdf -o o",
    ),
    "blank lines in an OBJ": (
        {"r.urdf": MESH, "m.obj": OBJ + "\n" * 300_000},
        "export urdf r.urdf -o o.urdf",
    ),
    "blanks in an image of COLLADA": (
        {"r.urdf": MESH.replace("m.obj", "m.dae"), "m.dae": f"<init_from>{' ' * 300_000}"},
        "lint r.urdf --no-cache",
    ),
    "links in a comment": (
        {"r.urdf": WORLD.replace("<link", f"<!--{'<link ' * 160_000}--><link", 1)},
        "lint r.urdf --no-cache",
    ),
    "includes in a comment of MJCF": (
        {"r.xml": f"<mujoco><!--{'<include ' * 100_000}--><worldbody/></mujoco>"},
        "lint . --no-cache -j 1",
    ),
    "references of Gazebo": (
        {"r.urdf": ROBOT.replace("</robot>", GAZEBO + "</robot>")},
        "lint r.urdf --no-cache",
    ),
    "visuals of a link": (
        {"r.urdf": ROBOT.replace('<link name="a"/>', f'<link name="a">{VISUAL * 4000}</link>')},
        "lint r.urdf --no-cache",
    ),
    "a large TOML": ({"r.urdf": ROBOT, "urdftool.toml": "a = 1\n" * 5_000_000}, "lint r.urdf"),
}


@pytest.mark.parametrize("name", CASES)
def test_it_ends_soon(name, zygote, place):
    files, command = CASES[name]
    for file, text in files.items():
        (place.project / file).write_text(text)
    outcome = zygote.run(command.split(), place)
    assert outcome.code in (0, 1, 2)
    assert not place.find_problems(outcome)


def write_link_farm(folder, count=100):
    """Links to the folder that they are in: each path has as many continuations."""
    for number in range(count):
        (folder / f"z{number}").symlink_to(".")


def test_wildcards_over_links_end_soon(zygote, place):
    write_link_farm(place.project)
    text = XACRO.replace("<link", '<xacro:include filename="./*/*/*/*/*/*.zz"/><link')
    (place.project / "r.xacro").write_text(text)
    outcome = zygote.run(["lint", "r.xacro", "--no-cache"], place)
    assert outcome.code in (0, 1, 2)
    assert not place.find_problems(outcome)


def test_the_search_of_packages_over_links_ends_soon(zygote, place):
    write_link_farm(place.project, 200)
    (place.project / "pkg").mkdir()
    (place.project / "pkg" / "package.xml").write_text(PACKAGE)
    (place.project / "pkg" / "r.urdf").write_text(MESH.replace("m.obj", "package://q/m.obj"))
    outcome = zygote.run(["lint", "pkg/r.urdf", "--no-cache"], place)
    assert outcome.code == 1
    assert not place.find_problems(outcome)


@pytest.mark.parametrize(
    "text",
    [
        'tool = "x"',
        "tool.urdftool = 1",
        'tool.urdftool = "lint"',
        '[packages]\na = "\\u0000"',
        "[packages]\na = 1",
        "a = " + "9" * 5000,
        "lint = 1",
        "tool = [[]]",
    ],
)
def test_values_of_other_types_are_messages(text, urdftool, tmp_path, monkeypatch):
    (tmp_path / "r.urdf").write_text(ROBOT)
    (tmp_path / "urdftool.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    done = urdftool("lint", "r.urdf")
    assert done.code == 2
    assert "urdftool.toml" in done.err
    assert "bug" not in done.err


def test_a_key_of_usual_length_is_read(urdftool, tmp_path, monkeypatch):
    (tmp_path / "r.urdf").write_text(ROBOT)
    text = '[tool.urdftool.lint]\nignore = ["multiple-roots"]\n[tool.x]\nt = "a. b. c. d."\n'
    (tmp_path / "pyproject.toml").write_text(
        text + "# " + "." * 300 + "\n" + 'y = """\n....\n"""\n'
    )
    monkeypatch.chdir(tmp_path)
    assert urdftool("lint", "r.urdf").code in (0, 1)
