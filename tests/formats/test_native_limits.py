"""MuJoCo and OpenUSD on hostile files: a message within limits of processor time and memory.

Processor time and memory are those of the command with its processes, as the system measured them.
"""

import json
import os
import subprocess
import sys
from contextlib import nullcontext

import pytest

from tests.cases import list_cases
from tests.conftest import ROOT
from tests.formats import native_bombs as bombs
from urdftool.errors import ModelError, SourceError
from urdftool.formats.mjcf import read as read_mjcf
from urdftool.formats.usd import read as read_usd
from urdftool.model.elements import Mesh
from urdftool.workspace import Workspace

pytestmark = [
    pytest.mark.library("mujoco", "pxr"),
    pytest.mark.skipif(sys.platform != "linux", reason="other systems have fewer limits"),
]

PROCESSOR = 20.0  # s
MEMORY = 1000  # MB

_MEASURE = """
import json, resource, subprocess, sys
command = [sys.executable, "-m", "urdftool", *sys.argv[1:]]
done = subprocess.run(command, capture_output=True, text=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps([done.returncode, done.stdout, done.stderr, used.ru_utime + used.ru_stime,
                  used.ru_maxrss // 1000]))
"""


def run(*words):
    """Run a command; gives its exit code and what it printed, within the limits."""
    command = [sys.executable, "-c", _MEASURE, *map(str, words)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=True)
    code, out, err, processor, memory = json.loads(done.stdout)
    assert processor < PROCESSOR
    assert memory < MEMORY
    assert "Traceback" not in err
    assert "bug in urdftool" not in err
    return code, out, err


def read(path):
    from urdftool.formats.detect import read_other_format
    from urdftool.source.document import read_file
    from urdftool.source.packages import Packages

    return read_other_format(read_file(path), Packages(path))


def write(folder, name, suffix, text):
    path = folder / f"{name.replace(' ', '_')}{suffix}"
    path.write_text(text)
    return path


@pytest.mark.parametrize("name", bombs.COUNTED_MJCF)
def test_elements_are_counted_before_mujoco_reads_them(tmp_path, name, monkeypatch):
    monkeypatch.delattr("urdftool.formats.mjcf.read.call_with_limits")
    path = write(tmp_path, name, ".xml", bombs.COUNTED_MJCF[name])
    with pytest.raises(ModelError, match="more than 40000 elements") as error:
        read(path)
    assert error.value.line == 1


def test_attached_models_are_counted(tmp_path, monkeypatch):
    monkeypatch.delattr("urdftool.formats.mjcf.read.call_with_limits")
    with pytest.raises(ModelError, match="more than 40000 elements"):
        read(bombs.write_attached(tmp_path))


@pytest.mark.parametrize("name", bombs.COUNTED_USD)
def test_prims_are_counted_before_openusd_composes_them(tmp_path, name):
    path = write(tmp_path, name, ".usda", bombs.COUNTED_USD[name])
    with pytest.raises(ModelError, match="more than 100000 prims"):
        read(path)


def test_prims_of_layers_are_counted(tmp_path):
    with pytest.raises(ModelError, match="more than 100000 prims"):
        read(bombs.write_layers(tmp_path))


@pytest.mark.parametrize("name", list_cases(bombs.LARGE_MJCF, 3))
def test_the_memory_of_mujoco_is_limited(tmp_path, name):
    path = write(tmp_path, name, ".xml", bombs.LARGE_MJCF[name])
    code, _, err = run("info", path)
    assert code == 2
    assert "640 MiB of memory" in err or "Could not allocate memory" in err
    assert str(path) in err


@pytest.mark.slow
def test_the_memory_of_openusd_is_limited(tmp_path):
    code, _, err = run("info", bombs.write_arrays(tmp_path))
    assert code == 2
    assert "arrays.usdc" in err
    assert run("info", bombs.write_instancer(tmp_path))[0] == 0  # its arrays are not read


@pytest.mark.slow
@pytest.mark.parametrize("name", bombs.SLOW_MJCF)
def test_the_processor_time_of_mujoco_is_limited(tmp_path, monkeypatch, name):
    limits = read_mjcf.LIMITS._replace(processor=1.0)
    monkeypatch.setattr(read_mjcf, "_add_memory", lambda *_: limits)
    path = write(tmp_path, name, ".xml", bombs.SLOW_MJCF[name])
    with pytest.raises(ModelError, match="1 s of processor time"):
        read(path)


@pytest.mark.slow
def test_the_processor_time_of_openusd_is_limited(tmp_path, monkeypatch):
    monkeypatch.setattr(read_usd, "LIMITS", read_usd.LIMITS._replace(processor=1.0))
    with pytest.raises(ModelError, match="1 s of processor time"):
        read(bombs.write_bodies(tmp_path))


COMMANDS = (
    *("info {}", "lint {} --no-cache", "graph {} -o -", "inertia robot {}", "verify {0} {0}"),
    *("diff {0} {0}", "export urdf {} -o o/r.urdf", "export sdf {} -o o", "export mjcf {} -o o"),
    *("export usd {} -o o.usda", "bundle {} -o o", "collision {} -o o.urdf", "simulate {}"),
    "view {} --picture p.png",
)


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_ends_with_a_message(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    for path in (
        write(tmp_path, "hfield", ".xml", bombs.LARGE_MJCF["hfield"]),
        write(tmp_path, "replicate", ".xml", bombs.COUNTED_MJCF["replicate"]),
        write(tmp_path, "references", ".usda", bombs.COUNTED_USD["references"]),
        bombs.write_arrays(tmp_path),
    ):
        code, out, err = run(*command.format(path).split())
        assert code in (1, 2) if command.startswith("lint") else code == 2
        assert path.name in out + err
        assert not list(tmp_path.glob("o*"))


def crash(*_):
    """End the process as a library does."""
    os.abort()


def test_a_crash_of_mujoco_is_a_message(tmp_path, monkeypatch):
    monkeypatch.setattr("urdftool.formats.mjcf.read.compile_text", crash)
    with pytest.raises(ModelError, match="MuJoCo crashes on the model"):
        read(write(tmp_path, "m", ".xml", bombs.mjcf()))


def test_trusted_input_has_no_limits_but_time(tmp_path, monkeypatch):
    from urdftool.formats.reading import choose_limits
    from urdftool.limited import Limits

    limits = Limits(3.0, 2.0, 1)
    assert choose_limits(limits, Workspace()) == limits
    monkeypatch.setenv("URDFTOOL_TRUST", "1")
    assert choose_limits(limits, Workspace()) == Limits(3.0)


_OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


def test_mujoco_gets_the_contents_of_files(tmp_path):
    """Equal names in several folders, folders of settings, and those of an attached model."""
    from urdftool.formats.mjcf.read import read as read_mjcf

    for folder, size in (("one", 1), ("two", 2), ("sub/meshes", 3)):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "m.obj").write_text(_OBJ.replace("1 0 0", f"{size} 0 0"))
    child = '<compiler meshdir="meshes"/><asset><mesh file="m.obj"/></asset>'
    (tmp_path / "sub" / "child.xml").write_text(
        bombs.mjcf(before=child).replace("</body>", '<geom type="mesh" mesh="m"/></body>')
    )
    main = write(
        tmp_path,
        "main",
        ".xml",
        '<mujoco><asset><mesh file="m.obj"/><mesh name="n" file="../two/./m.obj"/>'
        '<model name="c" file="sub/child.xml"/></asset><compiler meshdir="one"/><worldbody>'
        '<body name="a"><geom type="mesh" mesh="m"/><geom type="mesh" mesh="n"/>'
        '<attach model="c" body="b" prefix="c_"/></body></worldbody></mujoco>',
    )
    view = Workspace().with_record()
    robot = read_mjcf(main, workspace=view).robot
    shapes = [one.geometry for link in robot.links for one in (*link.visuals, *link.collisions)]
    files = {shape.filename for shape in shapes if isinstance(shape, Mesh)}
    assert files == {"one/m.obj", "one/../two/m.obj", "sub/meshes/m.obj"}
    asked = {os.path.realpath(path) for kind, path in view.dependencies.stamps if kind == "file"}
    assert {str(tmp_path / place / "m.obj") for place in ("one", "two", "sub/meshes")} <= asked


def test_mujoco_opens_no_file(tmp_path, monkeypatch):
    from urdftool.formats.mjcf import read_compile

    (tmp_path / "m.obj").write_text(_OBJ)
    text = '<mujoco><asset><mesh name="m" file="m.obj"/></asset><worldbody/></mujoco>'
    arguments = (text, {}, {}, str(tmp_path), Workspace())
    monkeypatch.chdir(tmp_path)
    assert read_compile.compile_text(*arguments)[0].error
    monkeypatch.setattr(read_compile, "open_no_files", nullcontext)
    assert not read_compile.compile_text(*arguments)[0].error


@pytest.mark.parametrize("kind", list_cases(["missing", "folder", "pipe", "device"], 2))
def test_a_file_that_cannot_be_read_is_an_error_at_its_element(tmp_path, kind):
    if kind == "folder":
        (tmp_path / "m.obj").mkdir()
    elif kind == "device":
        (tmp_path / "m.obj").symlink_to("/dev/zero")
    elif kind == "pipe":
        os.mkfifo(tmp_path / "m.obj")
    for suffix, text in (
        (".xml", bombs.mjcf("\n", '\n<asset><mesh file="m.obj"/></asset>')),
        (".usda", bombs.make_reference("m.obj.usda")),
    ):
        if suffix == ".usda" and kind != "missing":
            (tmp_path / "m.obj").rename(tmp_path / "m.obj.usda")
        with pytest.raises((SourceError, ModelError)) as error:
            read(write(tmp_path, "r", suffix, text))
        assert error.value.where.startswith(str(tmp_path / "r"))
        if suffix == ".xml":
            assert error.value.line == 2


def test_plugins_are_not_loaded_by_path(tmp_path):
    text = '<mujoco><extension><plugin plugin="./evil.so"/></extension><worldbody/></mujoco>'
    with pytest.raises(ModelError, match=r"plugin \./evil\.so not found"):
        read(write(tmp_path, "m", ".xml", text))


def test_a_layer_is_refused_before_openusd_opens_it(tmp_path):
    """The policy decides, also about layers that a layer of a layer names."""
    from urdftool.formats.usd.read import read as read_usd

    (tmp_path / "secret.usda").write_text("SECRET")
    project = tmp_path / "project"
    project.mkdir()
    (project / "b.usda").write_text(bombs.make_reference("../secret.usda"))
    path = write(project, "a", ".usda", bombs.make_reference("b.usda"))
    with pytest.raises(SourceError, match=r"secret\.usda' is outside of the project") as error:
        read_usd(path)
    assert "SECRET" not in str(error.value)
    assert not error.value.notes
