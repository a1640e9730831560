import json
import zipfile

import pytest

from tests.bundle import files
from urdftool.bundle.manifest import compute_digest


@pytest.fixture
def bundle(urdftool, write, tmp_path):
    """A bundle of one mesh with an image."""
    write("a.dae", files.dae("skin.png"))
    write("skin.png", files.PNG)
    path = write("r.urdf", files.robot(("a.dae", "a.dae")))
    assert urdftool("bundle", path, "-o", "out").code == 0
    return tmp_path / "out"


def seal(bundle):
    """Accept all files of a bundle, so that only their references count."""
    data = json.loads((bundle / "bundle.json").read_text())
    data["files"] = [
        {
            "path": p.relative_to(bundle).as_posix(),
            "sha256": compute_digest(p),
        }
        for p in bundle.rglob("*")
        if p.is_file() and p.name != "bundle.json"
    ]
    (bundle / "bundle.json").write_text(json.dumps(data))


def codes(urdftool, path="out"):
    result = urdftool("bundle", path, "--check")
    assert result.code == bool(result.out)
    return [line.rpartition("[")[2].rstrip("]") for line in result.out.splitlines()]


def test_a_complete_bundle(urdftool, bundle):
    assert codes(urdftool) == []
    seal(bundle)
    assert codes(urdftool) == []


def test_missing_changed_and_unlisted_files(urdftool, bundle):
    (bundle / "meshes" / "skin.png").unlink()
    (bundle / "meshes" / "a.dae").write_bytes(files.dae("other.png"))
    (bundle / "notes.txt").write_text("x")
    assert codes(urdftool) == ["missing-file", "changed-file", "unlisted-file"]


@pytest.mark.parametrize("size", [7, "many", -1])
def test_a_size_that_is_not_that_of_the_file(urdftool, bundle, size):
    manifest = bundle / "bundle.json"
    data = json.loads(manifest.read_text())
    data["files"][0]["bytes"] = size
    manifest.write_text(json.dumps(data))
    assert codes(urdftool) == ["invalid-manifest"]


def test_a_folder_without_manifest_is_not_a_bundle(urdftool, bundle):
    (bundle / "bundle.json").unlink()
    done = urdftool("bundle", str(bundle), "--check")
    assert done.code == 2
    assert "is not a bundle: it has no bundle.json" in done.err


@pytest.mark.parametrize(
    ("written", "code"),
    [
        ("../skin.png", "missing-reference"),
        ("../../skin.png", "points-out"),
        ("/etc/skin.png", "points-out"),
        ("file:///etc/skin.png", "points-out"),
        ("https://example.com/skin.png", "points-out"),
        ("package://x/skin.png", "points-out"),
    ],
)
def test_references_that_point_out(urdftool, bundle, written, code):
    (bundle / "meshes" / "a.dae").write_bytes(files.dae(written))
    seal(bundle)
    assert codes(urdftool) == [code]


@pytest.mark.parametrize("uri", ["../r.urdf", "package://p/meshes/a.dae", "file:///etc/passwd"])
def test_a_description_that_points_out(urdftool, bundle, uri):
    (bundle / "arm.urdf").write_text(files.robot((uri, "meshes/a.dae")))
    seal(bundle)
    assert codes(urdftool) == ["points-out"]


def test_links(urdftool, bundle):
    (bundle / "meshes" / "b.png").symlink_to("/etc/passwd")
    (bundle / "etc").symlink_to("/etc")
    assert sorted(codes(urdftool)) == ["link", "link"]


def test_a_damaged_manifest(urdftool, bundle):
    (bundle / "bundle.json").write_text("{}")
    assert codes(urdftool) == ["invalid-manifest"]


@pytest.mark.parametrize("name", ["../evil.txt", "/evil.txt", "a/../../evil.txt", "C:/evil.txt"])
def test_a_zip_file_that_leaves_its_folder(urdftool, tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    with zipfile.ZipFile("x.zip", "w") as archive:
        archive.writestr("arm/bundle.json", "{}")
        archive.writestr(name, "x")
    result = urdftool("bundle", "x.zip", "--check")
    assert result.code == 2
    assert "outside of its folder" in result.err


def test_other_zip_files(urdftool, write):
    assert urdftool("bundle", write("x.zip", b"PK"), "--check").code == 2
    with zipfile.ZipFile("y.zip", "w") as archive:
        archive.writestr("mine.txt", "x")
    assert "is not a bundle" in urdftool("bundle", "y.zip", "--check").err


TOPICS = """<link name="/base_link"/><gazebo><plugin name="p" filename="libp.so">
<topic>/rgb/high_res/camera_info</topic><ns>/gazebo/command/motor_speed</ns>{}</plugin></gazebo>"""


def test_names_of_links_and_topics_are_no_files(urdftool, bundle):
    path = bundle / "arm.urdf"
    path.write_text(path.read_text().replace("</robot>", TOPICS.format("") + "</robot>"))
    seal(bundle)
    assert codes(urdftool) == []


@pytest.mark.parametrize(
    "value", ["/etc/passwd", "/nowhere/config/control.yaml", "file:///nowhere/a", "package://x/a"]
)
def test_values_that_name_files_outside(urdftool, bundle, value):
    path = bundle / "arm.urdf"
    block = TOPICS.format(f"<parameters>{value}</parameters>")
    path.write_text(path.read_text().replace("</robot>", block + "</robot>"))
    seal(bundle)
    assert codes(urdftool) == ["points-out"]


@pytest.mark.parametrize("command", ["info", "lint", "graph"])
def test_other_commands_say_that_a_bundle_is_a_zip_file(urdftool, bundle, command):
    assert urdftool("bundle", "r.urdf", "-o", "b.zip").code == 0
    result = urdftool(command, "b.zip")
    assert result.code in (1, 2)
    assert "is a zip file, not a USDZ package; extract it" in result.out + result.err
    assert "PK" not in result.out + result.err


def test_files_of_parameters_are_said_to_be_missing(write, urdftool, tmp_path):
    path = write(
        "in/k.urdf",
        '<robot name="k"><link name="a"/><gazebo><plugin name="p" filename="x"><parameters>'
        "config/c.yaml</parameters></plugin></gazebo></robot>",
    )
    write("in/config/c.yaml", "a: 1\n")
    result = urdftool("bundle", path, "-o", tmp_path / "out", "--check")
    assert result.code == 1
    assert "'config/c.yaml' is not bundled" in result.err
    assert "'config/c.yaml' does not exist in the bundle" in result.out
