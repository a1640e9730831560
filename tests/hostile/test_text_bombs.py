"""Small files that would take long or much memory to read: comments, includes, keys, manifests."""

import pytest

from tests.hostile.place import Place
from tests.hostile.zygote import Zygote

ROBOT = '<robot name="r"><link name="a"/></robot>'
XACRO = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="$(find p)"/></robot>'
)
PACKAGE = "<package><name>p</name></package>"


@pytest.fixture(scope="module")
def zygote():
    process = Zygote()
    yield process
    process.close()


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
    "dots of TOML": ({"r.urdf": ROBOT, "urdftool.toml": "a." * 20_000 + "b = 1"}, "lint r.urdf"),
    "dots of TOML in quotes": (
        {"r.urdf": ROBOT, "urdftool.toml": '"a b" . ' * 20_000 + "b = 1"},
        "lint r.urdf",
    ),
    "dots of TOML in a table": (
        {"r.urdf": ROBOT, "urdftool.toml": "[lint]\nx = {" + "a." * 20_000 + "b = 1}"},
        "lint r.urdf",
    ),
    "a large TOML": ({"r.urdf": ROBOT, "urdftool.toml": "a = 1\n" * 5_000_000}, "lint r.urdf"),
}


@pytest.mark.parametrize("name", CASES)
def test_it_ends_soon(name, zygote, tmp_path):
    files, command = CASES[name]
    place = Place(tmp_path)
    for file, text in files.items():
        (place.project / file).write_text(text)
    outcome = zygote.run(command.split(), place)
    assert outcome.code in (0, 1, 2)
    assert not place.find_problems(outcome)


def test_a_key_of_usual_length_is_read(urdftool, tmp_path, monkeypatch):
    (tmp_path / "r.urdf").write_text(ROBOT)
    text = '[tool.urdftool.lint]\nignore = ["multiple-roots"]\n[tool.x]\nt = "a. b. c. d."\n'
    (tmp_path / "pyproject.toml").write_text(
        text + "# " + "." * 300 + "\n" + 'y = """\n....\n"""\n'
    )
    monkeypatch.chdir(tmp_path)
    assert urdftool("lint", "r.urdf").code in (0, 1)
