import re
import socket
import subprocess
import sys

import pytest

from tests.conftest import FIXTURES
from tests.viewer.robots import ARM
from tests.viewer.serving import free_port, served

BROKEN = ARM.replace("</robot>", "")


@pytest.fixture
def arm(write):
    return write("arm.urdf", ARM)


def test_a_broken_file_at_the_start(urdftool, write):
    result = urdftool("view", write("r.urdf", BROKEN))
    assert result.code == 2
    assert result.out == ""
    assert result.err.startswith("r.urdf:")
    assert len(result.err.splitlines()) == 1


def test_no_link(urdftool, write):
    result = urdftool("view", write("r.urdf", "<robot name='r'/>"))
    assert result.code == 2
    assert "the robot has no links" in result.err


def test_an_occupied_port(urdftool, arm):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        result = urdftool("view", arm, "--port", port)
    assert result.code == 2
    assert result.out == ""
    assert result.err.startswith(f"urdftool: port {port} of 127.0.0.1 is in use")


def test_a_joint_that_is_none(urdftool, arm):
    result = urdftool("view", arm, "--pose", "shouldr=1")
    assert result.code == 2
    assert "did you mean 'shoulder'?" in result.err


@pytest.mark.parametrize("words", [("--size", "80x60"), ("--camera", "30,20")])
def test_what_is_for_pictures_alone(urdftool, arm, words):
    result = urdftool("view", arm, *words)
    assert result.code == 2
    assert "--picture" in result.err


def test_what_is_for_the_page_alone(urdftool, arm, tmp_path):
    result = urdftool("view", arm, "--picture", tmp_path / "x.png", "--port", "8800")
    assert result.code == 2
    assert not (tmp_path / "x.png").exists()


def test_without_viser(urdftool, arm, monkeypatch):
    monkeypatch.setitem(sys.modules, "viser", None)
    result = urdftool("view", arm)
    assert result.code == 2
    assert "pip install 'urdftool[view]'" in result.err


def test_the_address_is_printed_and_ctrl_c_ends_it(arm):
    pytest.importorskip("viser")
    port = free_port()
    with served(arm, port=port, expect=130) as url:
        assert re.fullmatch(rf"http://127\.0\.0\.1:{port}/[\w-]{{22}}/", url)
        with socket.create_connection(("127.0.0.1", port), timeout=5):
            pass


def test_a_picture_needs_neither_viser_nor_a_port(arm, tmp_path):
    pytest.importorskip("PIL")
    code = (
        "import sys; sys.modules['viser'] = None\n"
        "from urdftool import cli; sys.exit(cli.call(sys.argv[1:]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, "view", arm, "--picture", str(tmp_path / "x.png"),
         "--size", "80x60"],
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "x.png").stat().st_size > 200


def test_neither_trimesh_nor_scipy_is_imported_for_shapes(arm):
    code = (
        "import sys\nfrom urdftool.viewer import page\nfrom urdftool.model.load import load\n"
        "from urdftool.drawing.shapes import read_robot_shapes\n"
        "from urdftool.viewer.render_mesh import list_render_meshes\n"
        "list(list_render_meshes(read_robot_shapes(load(sys.argv[1]))))\n"
        "print([n for n in ('trimesh', 'scipy', 'yourdfpy', 'viser') if n in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code, arm], capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stderr


def test_a_mesh_file_is_drawn(urdftool, tmp_path):
    mesh = FIXTURES / "effects" / "robots" / "box_inverted.stl"
    target = tmp_path / "box & <box>.png"
    done = urdftool("view", mesh, "--picture", target, "--size", "80x60")
    assert done.code == 0, done.err
    assert target.read_bytes().startswith(b"\x89PNG")


def test_a_mesh_of_any_name_is_drawn(urdftool, tmp_path):
    mesh = tmp_path / 'a b&"%20é.STL'
    mesh.write_bytes((FIXTURES / "effects" / "robots" / "box_inverted.stl").read_bytes())
    done = urdftool("view", mesh, "--picture", tmp_path / "x.png", "--size", "80x60")
    assert done.code == 0, done.err


@pytest.mark.parametrize("content", [None, b"junk", b""])
def test_a_mesh_file_that_is_none_is_one_message(urdftool, tmp_path, content):
    mesh = tmp_path / "part.stl"
    if content is not None:
        mesh.write_bytes(content)
    done = urdftool("view", mesh, "--picture", tmp_path / "x.png")
    assert done.code == 2
    assert "part.stl" in done.err
    assert len(done.err.splitlines()) == 1
    assert not (tmp_path / "x.png").exists()
