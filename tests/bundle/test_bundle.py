"""What ``urdftool bundle`` writes, and what it refuses."""

import hashlib
import json
import os
import shutil
import subprocess
import time
import zipfile

import pytest
import yaml

import urdftool as api
from tests.bundle import files
from tests.conftest import FIXTURES

ARM = FIXTURES / "robots" / "my_robot" / "urdf" / "arm.urdf.xacro"


def inside(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture
def project(write):
    """A package with meshes whose names clash, companions in other folders, and a license."""
    write("p/package.xml", "<package><name>my_arm</name><license>MIT</license></package>")
    write("p/LICENSE.txt", "MIT License")
    write("p/meshes/visual/Link 1.dae", files.dae("../tex/skin-1.png"))
    write("p/meshes/tex/skin-1.png", files.PNG)
    write("p/meshes/collision/link 1.STL", files.stl())
    write("p/meshes/arm.obj", files.obj("mat/arm.mtl"))
    write("p/meshes/mat/arm.mtl", files.mtl("../tex/skin-1.png"))
    write("p/meshes/copy.stl", files.stl())
    return write(
        "p/urdf/arm.urdf",
        files.robot(
            ("package://my_arm/meshes/visual/Link 1.dae", "../meshes/collision/link 1.STL"),
            ("package://my_arm/meshes/arm.obj", "package://my_arm/meshes/copy.stl"),
        ),
    )


def test_everything_is_in_one_folder(urdftool, project, tmp_path):
    result = urdftool("bundle", project, "-o", "out", "--check")
    assert (result.code, result.out) == (0, "")
    assert inside(tmp_path / "out") == {
        *("arm.urdf", "bundle.json", "licenses/my_arm/LICENSE.txt"),
        *("meshes/Link_1.dae", "meshes/skin_1.png", "meshes/link_1_collision.stl"),
        *("meshes/arm.obj", "meshes/arm.mtl"),
    }
    text = (tmp_path / "out" / "arm.urdf").read_text()
    assert 'filename="meshes/Link_1.dae"' in text
    assert text.count('filename="meshes/link_1_collision.stl"') == 2  # equal files are one
    assert "package://" not in text
    assert "<init_from>skin_1.png</init_from>" in (tmp_path / "out/meshes/Link_1.dae").read_text()
    assert "mtllib arm.mtl\n" in (tmp_path / "out/meshes/arm.obj").read_text()
    assert "map_Kd -s 1 1 1 skin_1.png\n" in (tmp_path / "out/meshes/arm.mtl").read_text()


def test_the_manifest_lists_digests_and_sources(urdftool, project, tmp_path):
    urdftool("bundle", project, "-o", "out")
    data = json.loads((tmp_path / "out" / "bundle.json").read_text())
    assert data["source"] == "package://my_arm/urdf/arm.urdf"
    assert data["licenses"] == {"my_arm": ["MIT"]}
    entries = {entry["path"]: entry for entry in data["files"]}
    assert entries["meshes/link_1_collision.stl"] == {
        "path": "meshes/link_1_collision.stl",
        "sha256": hashlib.sha256(files.stl()).hexdigest(),
        "bytes": len(files.stl()),
        "sources": [
            "package://my_arm/meshes/collision/link 1.STL",
            "package://my_arm/meshes/copy.stl",
        ],
    }
    assert entries.keys() == inside(tmp_path / "out") - {"bundle.json"}
    assert str(tmp_path) not in (tmp_path / "out" / "bundle.json").read_text()


def test_the_same_input_gives_the_same_bytes(urdftool, project, tmp_path, monkeypatch):
    assert urdftool("bundle", project, "-o", "a.zip", "--check").code == 0
    shutil.copytree(tmp_path / "p", tmp_path / "deep" / "p")
    os.utime(tmp_path / "deep" / "p" / "meshes" / "copy.stl", (0, 0))
    assert urdftool("bundle", "deep/p/urdf/arm.urdf", "-o", "b.zip").code == 0
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()
    monkeypatch.setenv("TZ", "Asia/Kolkata")
    getattr(time, "tzset", bool)()  # Windows has none
    assert urdftool("bundle", project, "-o", "c.zip").code == 0
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "c.zip").read_bytes()
    with zipfile.ZipFile("a.zip") as archive:
        assert "arm/arm.urdf" in archive.namelist()


def test_xacro_is_expanded_with_its_arguments(urdftool, write, tmp_path):
    write("m/a.stl", files.stl())
    text = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n" '
        'default="a"/><link name="$(arg n)"><visual><geometry><mesh filename="m/a.stl"/>'
        "</geometry></visual></link></robot>"
    )
    assert urdftool("bundle", write("r.urdf.xacro", text), "n:=b", "-o", "out").code == 0
    written = (tmp_path / "out" / "r.urdf").read_text()
    assert '<link name="b">' in written
    assert str(tmp_path) not in written
    assert json.loads((tmp_path / "out" / "bundle.json").read_text())["arguments"] == {"n": "b"}


def test_a_ros_package(urdftool, project, tmp_path):
    assert urdftool("bundle", project, "-o", "out", "--uri", "package", "--check").code == 0
    out = tmp_path / "out"
    assert {"package.xml", "CMakeLists.txt", "launch/display.launch.py", "urdf/arm.urdf"} < inside(
        out
    )
    assert '"package://arm_description/meshes/arm.obj"' in (out / "urdf" / "arm.urdf").read_text()
    assert "<license>MIT</license>" in (out / "package.xml").read_text()
    launch = (out / "launch" / "display.launch.py").read_text()
    compile(launch, "launch", "exec")
    assert 'arguments=["-d", str(PACKAGE / "rviz/display.rviz")]' in launch
    view = yaml.safe_load((out / "rviz" / "display.rviz").read_text())["Visualization Manager"]
    root = api.load(out / "urdf" / "arm.urdf").tree.roots[0].name
    assert view["Global Options"]["Fixed Frame"] == root
    assert " rviz " in (out / "CMakeLists.txt").read_text()
    moved = out.rename(tmp_path / "moved")
    assert urdftool("info", moved / "urdf" / "arm.urdf").code == 0
    assert "MESH" not in urdftool("lint", moved / "urdf" / "arm.urdf", "--select", "mesh").out


def test_file_uris(urdftool, project, tmp_path):
    assert urdftool("bundle", project, "-o", "out", "--uri", "file", "--check").code == 0
    uri = (tmp_path / "out" / "meshes" / "arm.obj").as_uri()
    assert uri in (tmp_path / "out" / "arm.urdf").read_text()
    assert urdftool("bundle", project, "-o", "out.zip", "--uri", "file").code == 2


def test_mujoco_keeps_the_folders_of_meshes(urdftool, write, tmp_path):
    write("a.stl", files.stl())
    block = '<mujoco><compiler meshdir="../x" strippath="true" fusestatic="false"/></mujoco>'
    path = write("r.urdf", files.robot(("a.stl", "a.stl"), extra=block))
    assert urdftool("bundle", path, "-o", "out").code == 0
    text = (tmp_path / "out" / "arm.urdf").read_text()
    assert '<compiler meshdir="." strippath="false" fusestatic="false"/>' in text
    assert text.count("<mujoco>") == 1


def test_uris_in_gazebo_blocks(urdftool, project, write, tmp_path):
    write("p/config/pid.yaml", "a: 1")
    inner = (
        "<gazebo><mesh><uri>package://my_arm/meshes/copy.stl</uri></mesh>"
        "<parameters>package://my_arm/config/pid.yaml</parameters>"
        "<uri>file://media/materials/scripts/gazebo.material</uri></gazebo>"
    )
    pair = "../meshes/copy.stl", "../meshes/copy.stl"
    path = write("p/urdf/g.urdf", files.robot(pair, extra=inner))
    result = urdftool("bundle", path, "-o", "out")
    assert result.code == 0
    assert "[external-file]" in result.err
    assert "pid.yaml" in result.err
    assert "<uri>meshes/copy.stl</uri>" in (tmp_path / "out" / "arm.urdf").read_text()
    checked = urdftool("bundle", "out", "--check")
    assert checked.code == 1
    assert "pid.yaml' points out of the bundle [points-out]" in checked.out


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
def test_the_description_is_xml_that_every_reader_takes(urdftool, write, tmp_path, encoding):
    named = {"latin-1": ' encoding="ISO-8859-1"', "utf-16": ' encoding="UTF-16"'}.get(encoding, "")
    text = f'<?xml version="0.0"{named}?>\n<!-- ä --><robot name="r"><link name="a"/></robot>'
    assert urdftool("bundle", write("r.urdf", text.encode(encoding)), "-o", "out").code == 0
    data = (tmp_path / "out" / "r.urdf").read_bytes()
    assert data.startswith('<?xml version="1.0"?>\n<!-- ä -->'.encode())


def test_missing_meshes_are_refused(urdftool, write, tmp_path):
    write("a.stl", files.stl())
    path = write("r.urdf", files.robot(("a.stl", "gone.stl"), ("gone.dae", "a.stl")))
    result = urdftool("bundle", path, "-o", "out")
    assert result.code == 2
    assert result.err.count("[mesh-not-found]") == 2
    assert not (tmp_path / "out").exists()
    result = urdftool("bundle", path, "-o", "out", "--force", "--check")
    assert result.code == 0
    text = (tmp_path / "out" / "arm.urdf").read_text()
    assert text.count("<visual>") == text.count("<collision>") == 1


def test_missing_textures_are_reported_and_left_out(urdftool, write, tmp_path):
    write("a.dae", files.dae("/home/me/skin.png"))
    material = '<material name="m"><texture filename="gone.png"/></material>'
    path = write("r.urdf", files.robot(("a.dae", "a.dae"), extra=material))
    result = urdftool("bundle", path, "-o", "out")
    assert result.code == 0
    assert "[missing-texture]" in result.err
    assert "[missing-companion]" in result.err
    text = (tmp_path / "out" / "arm.urdf").read_text()
    assert '<material name="m"><color rgba="1 1 1 1"/></material>' in text
    assert "<init_from>skin.png<" in (tmp_path / "out" / "meshes" / "a.dae").read_text()
    checked = urdftool("bundle", "out", "--check")
    assert (checked.code, checked.out) == (0, "")
    said = "out/meshes/a.dae: 'skin.png' is missing in the source [missing-in-source]"
    assert checked.err.splitlines() == [said, "out: complete"]


@pytest.mark.parametrize("name", ["id_rsa", "secret.stl", "secret.dae", "secret.obj", "secret.png"])
def test_only_meshes_and_images_are_copied(urdftool, write, tmp_path, name):
    write(name, "-----BEGIN OPENSSH PRIVATE KEY-----\nabc\n" * 5)
    path = write("r.urdf", files.robot((name, name)))
    result = urdftool("bundle", path, "-o", "out")
    assert result.code == 2
    assert "[invalid-mesh-file]" in result.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("mesh", "data"),
    [
        ("a.obj", files.obj("secret.mtl")),
        ("a.dae", files.dae("secret.png")),
        ("a.gltf", files.gltf_document("secret.bin", "secret.png")),
    ],
)
def test_companions_are_checked_by_content(urdftool, write, tmp_path, mesh, data):
    for name in ("secret.mtl", "secret.png", "secret.bin"):
        write(name, b"password" * 9)
    write(mesh, data)
    path = write("r.urdf", files.robot((mesh, mesh)))
    assert urdftool("bundle", path, "-o", "out").code == 0
    assert not [name for name in inside(tmp_path / "out") if "secret" in name]


def test_links_to_other_files_are_checked_by_content(urdftool, write, tmp_path):
    write("deep/passwd", "root:x:0:0\n" * 9)
    (tmp_path / "a.stl").symlink_to(tmp_path / "deep" / "passwd")
    (tmp_path / "LICENSE").symlink_to(tmp_path / "deep" / "passwd")
    write("b.stl", files.stl())
    assert urdftool("bundle", write("r.urdf", files.robot(("a.stl", "b.stl"))), "-o", "o").code == 2
    assert urdftool("bundle", write("s.urdf", files.robot(("b.stl", "b.stl"))), "-o", "o").code == 0
    assert inside(tmp_path / "o") == {"arm.urdf", "bundle.json", "meshes/b.stl"}


@pytest.mark.parametrize("target", ["dae", "glb"])
def test_images_of_converted_meshes_are_checked_by_content(urdftool, write, tmp_path, target):
    write("secret.png", "root:x:0:0" * 9)
    write("arm.mtl", files.mtl("secret.png"))
    mesh = write("a.obj", files.obj().replace(b"f 1 2 3", b"vt 0 0\nf 1/1 2/1 3/1"))
    path = write("r.urdf", files.robot((mesh, mesh)))
    assert urdftool("bundle", path, "-o", "out", "--meshes", target).code == 0
    for name in inside(tmp_path / "out"):
        assert b"root:x" not in (tmp_path / "out" / name).read_bytes()


@pytest.mark.parametrize("uri", ["/dev/zero", "pipe.stl", "zero.stl", "loop.stl", "folder.stl"])
def test_devices_pipes_and_folders_are_not_read(urdftool, write, tmp_path, uri):
    if not os.path.exists("/dev/zero"):
        pytest.skip("this system has no devices in /dev")
    os.mkfifo(tmp_path / "pipe.stl")
    (tmp_path / "zero.stl").symlink_to("/dev/zero")
    (tmp_path / "loop.stl").symlink_to("loop.stl")
    (tmp_path / "folder.stl").mkdir()
    path = write("r.urdf", files.robot((uri, uri)))
    assert urdftool("bundle", path, "-o", "out").code == 2
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("suffix", ["stl", "obj"])
def test_immense_files_are_not_read(urdftool, write, tmp_path, suffix):
    name = write(f"a.{suffix}", files.stl() if suffix == "stl" else files.obj())
    with open(name, "ab") as stream:
        stream.truncate(3 << 30)  # sparse: takes no space
    result = urdftool("bundle", write("r.urdf", files.robot((name, name))), "-o", "o.zip")
    assert result.code == 2
    assert "3.2 GB" in result.err


def test_a_folder_of_the_user_is_kept(urdftool, project, write, tmp_path):
    write("out/mine.txt", "keep")
    result = urdftool("bundle", project, "-o", "out")
    assert result.code == 2
    assert inside(tmp_path / "out") == {"mine.txt"}
    assert urdftool("bundle", project, "-o", "out", "--overwrite").code == 0
    assert "mine.txt" in inside(tmp_path / "out")
    assert "unlisted-file" in urdftool("bundle", "out", "--check").out


def test_edited_files_of_a_bundle_are_kept(urdftool, project, write, tmp_path):
    assert urdftool("bundle", project, "-o", "out").code == 0
    assert urdftool("bundle", project, "-o", "out").code == 0
    write("out/meshes/arm.obj", files.obj("mine.mtl"))
    result = urdftool("bundle", project, "-o", "out")
    assert result.code == 2
    assert "was edited since it was bundled" in result.err
    assert "mine.mtl" in (tmp_path / "out" / "meshes" / "arm.obj").read_text()
    assert urdftool("bundle", project, "-o", "out", "--overwrite").code == 0


def test_a_binary_file_of_the_user_in_a_bundle_is_kept(urdftool, write, tmp_path):
    write("a.stl", files.stl())
    first = write("r.urdf", files.robot(("a.stl", "a.stl")))
    assert urdftool("bundle", first, "-o", "out").code == 0
    mine = files.stl(7.0)
    write("out/meshes/b.stl", mine)
    write("b.stl", files.stl(2.0))
    second = write("r.urdf", files.robot(("b.stl", "b.stl")))
    result = urdftool("bundle", second, "-o", "out")
    assert result.code == 2
    assert "was not written by urdftool" in result.err
    assert (tmp_path / "out" / "meshes" / "b.stl").read_bytes() == mine


def test_files_that_are_no_longer_needed_are_removed(urdftool, write, tmp_path):
    write("a.stl", files.stl())
    path = write("r.urdf", files.robot(("a.stl", "a.stl")))
    assert urdftool("bundle", path, "-o", "out").code == 0
    write("r.urdf", '<robot name="arm"><link name="a"/></robot>')
    assert urdftool("bundle", path, "-o", "out", "--check").code == 0
    assert inside(tmp_path / "out") == {"arm.urdf", "bundle.json"}
    assert not (tmp_path / "out" / "meshes").exists()


def test_a_zip_file_of_the_user_is_kept(urdftool, project, tmp_path):
    with zipfile.ZipFile("out.zip", "w") as archive:
        archive.writestr("mine.txt", "keep")
    before = (tmp_path / "out.zip").read_bytes()
    assert urdftool("bundle", project, "-o", "out.zip").code == 2
    assert (tmp_path / "out.zip").read_bytes() == before
    assert urdftool("bundle", project, "-o", "out.zip", "--overwrite").code == 0
    assert urdftool("bundle", project, "-o", "out.zip").code == 0


def test_the_source_is_not_replaced(urdftool, write, tmp_path):
    write("meshes/a.stl", files.stl())
    text = files.robot(("meshes/a.stl", "meshes/a.stl"))
    path = write("arm.urdf", text)
    assert urdftool("bundle", path, "-o", ".", "--overwrite").code == 2
    assert (tmp_path / "arm.urdf").read_text() == text


def test_an_output_is_required(urdftool, project):
    assert "missing option -o" in urdftool("bundle", project).err
    assert "missing option -o" in urdftool("bundle", project, "--check").err


@pytest.mark.program("git")
def test_the_commit_of_the_source(urdftool, project, write, tmp_path):
    def git(*words):
        who = ["-c", "user.name=a", "-c", "user.email=a@example.com"]
        subprocess.run(["git", *who, *words], cwd=tmp_path, check=True, capture_output=True)

    git("init", "-q")
    git("add", "p")
    git("commit", "-qm", "robot")
    head = (tmp_path / ".git" / "refs" / "heads").iterdir().__next__().read_text().strip()
    assert urdftool("bundle", project, "-o", "a").code == 0
    known = json.loads((tmp_path / "a" / "bundle.json").read_text())["repositories"]
    assert known == [{"commit": head, "packages": ["my_arm"], "modified": []}]
    write("p/meshes/copy.stl", files.stl(3.0))
    assert urdftool("bundle", project, "-o", "b").code == 0
    known = json.loads((tmp_path / "b" / "bundle.json").read_text())["repositories"]
    assert known[0]["modified"] == ["package://my_arm/meshes/copy.stl"]


def test_a_robot_of_the_fixtures(urdftool, tmp_path):
    assert urdftool("bundle", ARM, "-o", tmp_path / "out", "--check").code == 0
    before, after = (urdftool("info", p) for p in (ARM, tmp_path / "out" / "my_robot_arm.urdf"))
    rows = [line for line in before.out.splitlines() if not line.startswith("packages")]
    assert after.out.splitlines() == rows


def test_a_file_of_macros_is_refused(urdftool, write):
    path = write(
        "arm.xacro",
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="a"/></robot>',
    )
    result = urdftool("bundle", path, "-o", "out")
    assert result.code == 2
    assert "use a file that calls its macros" in result.err
    assert not os.path.exists("out")


XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="limits" default="$(find arm_config)/limits.yaml"/>
<link name="/base_link"/>
<ros2_control name="c" type="system"><hardware><plugin>p/P</plugin>
<param name="recipe">$(find arm_description)/etc/recipe.txt</param>
<param name="limits">$(arg limits)</param></hardware></ros2_control>
<gazebo><plugin name="p" filename="libp.so">
<parameters>$(find arm_config)/control.yaml</parameters><topic>/rgb/camera_info</topic>
<args>--params-file $(find arm_config)/control.yaml -v</args></plugin></gazebo></robot>"""


def write_packages(write):
    for name in ("arm_description", "arm_config"):
        write(f"ws/src/{name}/package.xml", f"<package><name>{name}</name></package>")
    for name in ("control.yaml", "limits.yaml"):
        write(f"ws/src/arm_config/{name}", "a: 1\n")
    write("ws/src/arm_description/etc/recipe.txt", "a\n")
    write("ws/src/arm_description/urdf/r.urdf.xacro", XACRO)
    return "ws/src/arm_description/urdf/r.urdf.xacro"


def test_no_file_has_an_absolute_path(urdftool, write, tmp_path):
    path = write_packages(write)
    given = f"limits:={tmp_path}/ws/src/arm_config/limits.yaml"
    assert urdftool("bundle", path, given, "-o", "out").code == 0
    found = {inner.name: inner.read_bytes() for inner in (tmp_path / "out").rglob("*.*")}
    assert {"r.urdf", "bundle.json"} <= set(found)
    for content in found.values():
        assert str(tmp_path).encode() not in content
    text = found["r.urdf"].decode()
    assert "<parameters>package://arm_config/control.yaml</parameters>" in text
    assert '<param name="recipe">package://arm_description/etc/recipe.txt</param>' in text
    assert "--params-file package://arm_config/control.yaml -v" in text
    assert '"limits": "package://arm_config/limits.yaml"' in found["bundle.json"].decode()


def test_two_machines_make_the_same_bytes(urdftool, write, tmp_path):
    path = write_packages(write)
    shutil.copytree(tmp_path / "ws", tmp_path / "other" / "ws")
    for source, output in ((path, "one"), (f"other/{path}", "two")):
        assert urdftool("bundle", source, "-o", output).code == 0
    for inner in ("r.urdf", "bundle.json"):
        one, two = (tmp_path / name / inner for name in ("one", "two"))
        assert one.read_bytes() == two.read_bytes()


def test_notes_of_collada_have_no_absolute_path(urdftool, write, tmp_path):
    notes = (
        "<asset><contributor><comments>exported to C:\\Users\\ann\\arm.dae; up=Z</comments>"
        "<source_data>file:///home/ann/arm.max</source_data></contributor></asset>"
    )
    mark = b"<library_images>"
    write("a.dae", files.dae("a.png").replace(mark, notes.encode() + mark))
    write("r.urdf", files.robot(("a.dae", "a.dae")))
    assert urdftool("bundle", "r.urdf", "-o", "out").code == 0
    (made,) = (tmp_path / "out").rglob("*.dae")
    content = made.read_bytes()
    assert b"ann" not in content
    assert b"exported to arm.dae; up=Z" in content
    assert b"<source_data>arm.max<" in content


@pytest.mark.parametrize(
    "uri", ["file:///nfs/ann/hand.stl", r"C:\Users\ann\hand.stl", "/ann/hand.stl"]
)
def test_a_missing_file_of_the_author_is_listed_by_its_name(urdftool, write, tmp_path, uri):
    write("r.urdf", files.robot((uri, uri)))
    assert urdftool("bundle", "r.urdf", "-o", "out", "--force").code == 0
    text = (tmp_path / "out" / "bundle.json").read_text()
    assert json.loads(text)["missing"] == ["hand.stl"]
    assert "ann" not in text


def test_paths_of_a_machine_in_comments_become_names(urdftool, write, tmp_path):
    note = "autogenerated by xacro from {}/me/arm.urdf.xacro | see http://a.org/home/me, /home_link"
    robot = '<link name="/home_link"/>'
    write("r.urdf", f'<robot name="r"><!-- {note.format("/home")} -->{robot}</robot>')
    assert urdftool("bundle", "r.urdf", "-o", "out").code == 0
    text = (tmp_path / "out" / "r.urdf").read_text()
    assert "from arm.urdf.xacro | see http://a.org/home/me, /home_link -->" in text
    assert robot in text


def test_a_source_that_yourdfpy_cannot_read_is_not_a_defect(urdftool, write):
    pytest.importorskip("yourdfpy")
    write("r.urdf", '<robot name="r"><link name="a"><visual><origin xyz="0, 0, 0"/><geometry>'
          '<sphere radius="1"/></geometry></visual></link></robot>')  # fmt: skip
    done = urdftool("bundle", "r.urdf", "-o", "out", "--check")
    assert (done.code, done.out) == (0, "")
    assert "not compared: yourdfpy cannot read the source" in done.err
