"""``lint --fix`` of what stands beside a robot: the same promises as for the robot itself."""

import json
import os
import random
import re
import shutil
import struct
from pathlib import Path
from xml.parsers import expat

import pytest

from tests.conftest import FIXTURES

RULES = FIXTURES / "rules"
INVERTED = RULES / "inverted-mesh" / "meshes" / "arm_bad.stl"
MANIFEST = (
    b'<package format="3">\r\n\t<name>cart</name>\r\n\t<depend>tf2</depend>\r\n</package>\r\n'
)
ROBOT = """<robot name="r">
  <link name="base">
    <collision>
      <geometry><mesh filename="{}"/></geometry>
    </collision>
  </link>
</robot>
"""
FIX = ("--fix", "--unsafe-fixes", "--fix-meshes", "--no-cache", "--exit-zero")


@pytest.fixture
def cart(write):
    """A package with two robots that use a mesh of another package, as lines with CR LF."""
    write("mesh_store/package.xml", "<package><name>mesh_store</name></package>")
    write("mesh_store/hull.stl", INVERTED.read_bytes())
    write("cart/package.xml", MANIFEST)
    names = ("cart/urdf/a.urdf", "cart/urdf/b.urdf")
    return [write(name, ROBOT.format("package://mesh_store/hull.stl")) for name in names]


DECLARED = (
    "--select",
    "undeclared-mesh-dependency",
    "--target",
    "ros2",
    "-p",
    "mesh_store=mesh_store",
)


def test_what_two_robots_want_of_one_file_is_done_once(cart, urdftool):
    shown = urdftool("lint", *cart, *DECLARED, "--diff", "--no-cache")
    assert shown.code == 1
    assert shown.out.count("+++ cart/package.xml") == 1
    assert Path("cart/package.xml").read_bytes() == MANIFEST
    result = urdftool("lint", *cart, *DECLARED, *FIX)
    said = "Fixed 1 in 1 file: undeclared-mesh-dependency × 1\nchanged: cart/package.xml\n"
    assert result.err.startswith(said)
    wanted = b"</depend>\r\n\t<exec_depend>mesh_store</exec_depend>\r\n"
    assert Path("cart/package.xml").read_bytes() == MANIFEST.replace(b"</depend>\r\n", wanted)
    assert "Nothing to fix." in urdftool("lint", *cart, *DECLARED, *FIX).err


def test_a_manifest_that_is_a_link_stays_one_and_one_that_is_read_only_is_left(
    cart, urdftool, monkeypatch
):
    os.rename("cart/package.xml", "cart/real.xml")
    os.symlink("real.xml", "cart/package.xml")
    real = os.access
    with monkeypatch.context() as patch:
        patch.setattr(os, "access", lambda p, mode: mode != os.W_OK and real(p, mode))
        result = urdftool("lint", cart[0], *DECLARED, *FIX)
    assert result.code == 2
    assert "cart/package.xml: not fixed, because the file is read-only" in result.err
    assert Path("cart/real.xml").read_bytes() == MANIFEST
    assert urdftool("lint", cart[0], *DECLARED, *FIX).code == 0
    assert os.path.islink("cart/package.xml")
    assert b"<exec_depend>" in Path("cart/real.xml").read_bytes()


def test_a_package_that_is_not_there_is_not_declared(cart, urdftool):
    shutil.rmtree("mesh_store")
    result = urdftool("lint", cart[0], *DECLARED[:4], *FIX)
    assert "Nothing to fix." in result.err
    assert Path("cart/package.xml").read_bytes() == MANIFEST


def test_a_mesh_of_another_package_is_left(cart, urdftool):
    before = Path("mesh_store/hull.stl").read_bytes()
    os.remove(cart[1])
    result = urdftool(
        "lint", cart[0], "--select", "inverted-mesh", "-p", "mesh_store=mesh_store", *FIX
    )
    assert Path("mesh_store/hull.stl").read_bytes() == before
    assert "1 fix was not applied to mesh_store/hull.stl, outside of cart" in result.err


def test_a_mesh_that_another_robot_names_is_not_turned(write, urdftool):
    write("arm.stl", INVERTED.read_bytes())
    path = write("r.urdf", ROBOT.format("arm.stl"))
    other = write("other.urdf", ROBOT.format("arm.stl"))
    words = ("lint", path, "--select", "inverted-mesh", *FIX)
    result = urdftool("-v", *words)
    assert Path("arm.stl").read_bytes() == INVERTED.read_bytes()
    assert "other.urdf refers to 'arm.stl' too" in result.err
    os.remove(other)
    assert "Fixed 1" in urdftool(*words).err
    turned = Path("arm.stl").read_bytes()
    assert turned[:84] == INVERTED.read_bytes()[:84]
    for at in range(84, len(turned), 50):
        old, new = (struct.unpack_from("<12f", d, at) for d in (INVERTED.read_bytes(), turned))
        assert new == (*(-v for v in old[:3]), *old[3:6], *old[9:12], *old[6:9])


def test_diff_says_what_becomes_of_a_binary_file(write, urdftool):
    write("arm.stl", INVERTED.read_bytes())
    path = write("r.urdf", ROBOT.format("arm.stl"))
    size = len(INVERTED.read_bytes())
    words = ("--select", "inverted-mesh", "--unsafe-fixes", "--fix-meshes", "--no-cache")
    shown = urdftool("lint", path, "--diff", *words)
    assert shown.out == f"binary file arm.stl: {size} bytes → {size} bytes\n"
    assert Path("arm.stl").read_bytes() == INVERTED.read_bytes()


def test_a_new_mesh_is_made_with_what_names_it_or_not_at_all(write, urdftool, monkeypatch):
    from urdftool import output

    write("arm#1.stl", INVERTED.read_bytes())
    path = write("r.urdf", ROBOT.format("arm#1.stl"))
    words = ("lint", path, "--select", "unsafe-file-name", *FIX)
    move = os.replace

    def only_meshes(source, target):
        if str(target).endswith(".urdf"):
            raise OSError(28, "No space left on device")
        move(source, target)

    was = {"new.stl": None, path: Path(path).read_bytes()}
    with monkeypatch.context() as patch, pytest.raises(output.OutputError):
        patch.setattr(os, "replace", only_meshes)
        output.rewrite(was, {"new.stl": b"x", path: b"y"})
    assert sorted(os.listdir(".")) == ["arm#1.stl", "r.urdf"]
    shown = urdftool(*words[:4], "--diff", *FIX[1:]).out
    assert f"binary file arm_1.stl: new {len(INVERTED.read_bytes())} bytes\n" in shown
    assert urdftool(*words).code == 0
    assert Path("arm_1.stl").read_bytes() == INVERTED.read_bytes()
    assert 'filename="arm_1.stl"' in Path(path).read_text()
    assert "Nothing to fix." in urdftool(*words).err


def test_no_mesh_is_written_unasked(write, urdftool):
    """Meshes are binary, and kept in git-lfs: what rewrites 130 of them is asked for by name."""
    text = b"solid arm\nfacet normal 0 0 1\nouter loop\n" + b"vertex 0 0 0\n" * 3
    text += b"endloop\nendfacet\nendsolid arm\n"
    write("arm.stl", text)
    write("arm#1.stl", INVERTED.read_bytes())
    path = write("r.urdf", ROBOT.format("arm.stl").replace("collision", "visual"))
    other = write("s.urdf", ROBOT.format("arm#1.stl"))
    words = ("lint", path, other, "--select", "ascii-stl,unsafe-file-name", "--exit-zero")
    before = {p: Path(p).read_bytes() for p in sorted(os.listdir("."))}
    result = urdftool(*words, "--fix")
    assert {p: Path(p).read_bytes() for p in sorted(os.listdir("."))} == before
    assert "1 more finding has a fix that writes mesh files (--fix-meshes)\n" in result.err
    said = "1 more finding has an unsafe fix that writes mesh files (--unsafe-fixes --fix-meshes)\n"
    assert said in result.err
    assert "Nothing to fix." in result.err
    assert "2 more findings have a fix that" in urdftool(*words, "--fix", "--unsafe-fixes").err
    assert {p: Path(p).read_bytes() for p in sorted(os.listdir("."))} == before
    assert "= fix: convert it to binary STL (--fix --fix-meshes)\n" in urdftool(*words).out
    shown = urdftool(*words, "--diff", "--fix-meshes")
    assert shown.out.startswith("binary file arm.stl: ")
    assert "Fixed 1 in 1 file: ascii-stl" in urdftool(*words, "--fix", "--fix-meshes").err
    assert not Path("arm_1.stl").exists()
    assert urdftool(*words, "--fix-meshes").code == 2
    assert "Fix: safe (--fix --fix-meshes)" in urdftool("lint", "--explain", "ascii-stl").out


def test_json_says_which_files_are_made(write, urdftool):
    write("arm#1.stl", INVERTED.read_bytes())
    path = write("r.urdf", ROBOT.format("arm#1.stl"))
    found = json.loads(
        urdftool("lint", path, "--select", "unsafe-file-name", "--format", "json").out
    )
    (finding,) = found["findings"]
    assert finding["fix"]["files"] == [{"path": "arm_1.stl", "of": "arm#1.stl", "as": "a copy"}]
    sarif = json.loads(
        urdftool("lint", path, "--select", "unsafe-file-name", "--format", "sarif").out
    )
    assert "fixes" not in sarif["runs"][0]["results"][0]


def test_a_mesh_that_cannot_be_read_is_said(write, urdftool):
    write("arm.stl", b"solid arm\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\nendsolid arm\n")
    path = write("r.urdf", ROBOT.format("arm.stl"))
    result = urdftool("lint", path, "--select", "ascii-stl", *FIX)
    assert "not fixed [ascii-stl]" in result.err
    assert "arm.stl cannot be made binary STL" in result.err
    assert "bug" not in result.err


NAMED = """<robot name="r">
  <link name="base"/>
  <link name="upper-arm"/>
  <joint name="j" type="fixed"><parent link="base"/><child link="upper-arm"/></joint>
  <gazebo reference="upper-arm"><mu1>1</mu1></gazebo>
</robot>
"""
GROUPS = '<robot name="r"><group name="g"><link name="upper-arm"/></group></robot>\n'


def test_a_link_has_its_new_name_in_the_srdf_too_unless_a_list_names_it(write, urdftool):
    path = write("r.urdf", NAMED)
    write("r.srdf", GROUPS)
    write("config/sensors.yaml", "frame: upper-arm\n")
    words = ("lint", path, "--select", "not-portable-identifier", *FIX)
    result = urdftool("-v", *words)
    assert Path(path).read_text() == NAMED
    assert "config/sensors.yaml refers to 'upper-arm' too" in result.err
    write("config/sensors.yaml", "frame: upper-arm-2\n")
    assert "Fixed 1 in 2 files" in urdftool(*words).err
    assert Path(path).read_text() == NAMED.replace("upper-arm", "upper_arm")
    assert Path("r.srdf").read_text() == GROUPS.replace("upper-arm", "upper_arm")


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (
            "install(DIRECTORY\n  urdf\n  DESTINATION share/${PROJECT_NAME}\n)\nament_package()\n",
            "install(DIRECTORY\n  urdf\n  meshes\n  DESTINATION share/${PROJECT_NAME}\n)\n"
            "ament_package()\n",
        ),
        (
            "# install(DIRECTORY urdf DESTINATION share/${PROJECT_NAME})\nament_package()",
            "# install(DIRECTORY urdf DESTINATION share/${PROJECT_NAME})\n"
            "install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})\nament_package()",
        ),
        (
            'catkin_package()\ninstall(DIRECTORY urdf DESTINATION x\n PATTERN "*.urdf")',
            'catkin_package()\ninstall(DIRECTORY urdf DESTINATION x\n PATTERN "*.urdf")\n'
            "install(DIRECTORY meshes DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})\n",
        ),
    ],
)
def test_a_folder_is_installed_where_the_others_are(write, urdftool, before, after):
    write("package.xml", "<package><name>cart</name></package>")
    write("CMakeLists.txt", before)
    write("meshes/arm.stl", INVERTED.read_bytes())
    path = write("urdf/r.urdf", ROBOT.format("package://cart/meshes/arm.stl"))
    words = ("--select", "directory-not-installed", "--target", "ros2")
    assert urdftool("lint", path, *words, *FIX).code == 0
    assert Path("CMakeLists.txt").read_text() == after


def _triangles(data):
    rows = (struct.unpack_from("<12f", data, at)[3:] for at in range(84, len(data), 50))
    return [(row[0:3], row[3:6], row[6:9]) for row in rows]


def _volume(triangles):
    return sum(
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
        for a, b, c in triangles
    )


def test_a_mirrored_mesh_is_the_mirror_image_with_its_triangles_turned(write, urdftool):
    here = (RULES / "degenerate-triangles" / "meshes" / "arm.stl").read_bytes()
    write("arm.stl", here)
    mirrored = (
        ROBOT.replace("collision>", "visual>")
        .format("arm.stl")
        .replace("/></geo", ' scale="0.5 -0.5 0.5"/></geo')
    )
    paths = [write(name, mirrored) for name in ("a.urdf", "b.urdf")]
    assert urdftool("lint", *paths, "--select", "mirrored-scale", "--target", "gz", *FIX).code == 0
    for path in paths:  # the second finds what was made for the first
        assert '"arm_mirrored_y.stl" scale="0.5 0.5 0.5"' in Path(path).read_text()
    old, new = _triangles(here), _triangles(Path("arm_mirrored_y.stl").read_bytes())
    wanted = [frozenset((x, -y, z) for x, y, z in triangle) for triangle in old]
    assert sorted(map(sorted, wanted)) == sorted(map(sorted, map(frozenset, new)))
    assert _volume(new) == pytest.approx(_volume(old))


def test_a_mirrored_copy_keeps_the_suffix_of_the_file(write, urdftool):
    write("arm.STL", (RULES / "degenerate-triangles" / "meshes" / "arm.stl").read_bytes())
    mirrored = (
        ROBOT.replace("collision>", "visual>")
        .format("arm.STL")
        .replace("/></geo", ' scale="1 -1 1"/></geo')
    )
    path = write("a.urdf", mirrored)
    assert urdftool("lint", path, "--select", "mirrored-scale", "--target", "gz", *FIX).code == 0
    assert '"arm_mirrored_y.STL" scale="1 1 1"' in Path(path).read_text()
    assert Path("arm_mirrored_y.STL").exists()


def test_a_text_becomes_the_same_triangles(write, urdftool):
    text = "solid arm\n"
    for triangle in _triangles(INVERTED.read_bytes()):
        corners = "".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in triangle)
        text += f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n"
    write("arm.stl", text + "endsolid arm\n")
    path = write("r.urdf", ROBOT.format("arm.stl"))
    urdftool("lint", path, "--select", "ascii-stl", "--fix", "--fix-meshes")
    assert Path("arm.stl").read_bytes().startswith(b"solid"), "PyBullet would have one more shape"
    assert urdftool("lint", path, "--select", "ascii-stl", *FIX).code == 0
    assert _triangles(Path("arm.stl").read_bytes()) == _triangles(INVERTED.read_bytes())


def test_nobody_is_looked_for_in_a_disk_full_of_files(write, urdftool, monkeypatch):
    from urdftool.rules import cross_file_references

    monkeypatch.setattr(cross_file_references, "_MOST_FILES", 2)
    write("arm.stl", INVERTED.read_bytes())
    write("notes/one.txt", "x")
    path = write("r.urdf", ROBOT.format("arm.stl"))
    result = urdftool("-v", "lint", path, "--select", "inverted-mesh", *FIX)
    assert "too many files around the description" in result.err
    assert Path("arm.stl").read_bytes() == INVERTED.read_bytes()


PIECES = [
    *("", " ", "\n", "\t", "<!-- c -->", "\n  ", "\n\n", "<?pi x?>"),
    "<!-- <depend>mesh_store</depend> -->",
]
NEEDS = [
    *("<depend>tf2</depend>", "<exec_depend>x</exec_depend>", "<run_depend>x</run_depend>"),
    *("<buildtool_depend>catkin</buildtool_depend>", "<license>A &amp; é</license>"),
    *("<export/>", "<export></export>", "<export>\n    <x/>\n  </export>"),
]


@pytest.mark.parametrize("seed", range(40))
def test_random_manifests_get_what_they_lack_and_lose_nothing(cart, urdftool, seed):
    chance = random.Random(seed)
    inside = chance.sample(NEEDS, chance.randrange(len(NEEDS)))
    inside = [i for i in inside if "export" not in i] + [i for i in inside if "export" in i][:1]
    spaced = "".join(
        "".join(chance.choices(PIECES, k=chance.randrange(3))) + piece
        for piece in ("<name>cart</name>", *inside, "")
    )
    how = chance.choice(["", " format='1'", ' format="2"', ' format="3"'])
    mark, end = chance.choice(["", "\ufeff"]), chance.choice(["\n", "\r\n"])
    before = f"{mark}<package{how}>{spaced}</package>".replace("\n", end).encode()
    Path("cart/package.xml").write_bytes(before)
    path = cart[0]
    words = (*DECLARED[:1], "package", "--target", "ros2,gz", *DECLARED[4:], *FIX)
    assert urdftool("lint", path, *words).code == 0
    after = Path("cart/package.xml").read_bytes()
    expat.ParserCreate().Parse(after, True)
    added = re.search(rb"<(run|exec)_depend>mesh_store</(run|exec)_depend>", after)
    assert added is not None
    assert (added[1] == b"run") == (how in ("", " format='1'"))
    rest = re.sub(rb"(\r?\n[ \t]*)?<\w+_depend>mesh_store</\w+_depend>", b"", after)
    assert rest == before
    assert "Nothing to fix." in urdftool("lint", path, *words).err
