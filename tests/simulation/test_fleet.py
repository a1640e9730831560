"""Many robots at once: what breaks one leaves the others alone."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from functools import cache
from xml.etree import ElementTree

import jsonschema
import pytest

from tests.conftest import FIXTURES, ROOT
from urdftool.errors import UrdftoolError
from urdftool.formats.defects import Refused, report_defects
from urdftool.model.load import load
from urdftool.parallel import terminate_gracefully
from urdftool.simulation.fleet import Row, run_in_parallel

ROBOTS = FIXTURES / "robots"
MIRA = ROBOTS / "mira_description" / "urdf"


@cache
def _find_defects():
    """Those of a robot whose inertia is not possible; found before the time of tasks runs."""
    return list(report_defects(load(ROBOTS / "ros2_arm" / "urdf" / "robot2.urdf.xacro")))


def _work(path, notes):
    if path == "error":
        raise UrdftoolError("is wrong", path=path, line=3, column=4)
    if path == "refused":
        raise Refused(_find_defects())
    if path == "bug":
        raise ZeroDivisionError("oh")
    if path == "dies":
        os.kill(os.getpid(), signal.SIGKILL)
    if path == "hangs":
        time.sleep(60)
    if path == "deaf":
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        time.sleep(60)
    if path == "mask":
        return Row(path, name=str(sorted(signal.pthread_sigmask(signal.SIG_BLOCK, []))))
    if path == "no files":
        raise OSError(24, "Too many open files")
    if path == "no memory":
        raise MemoryError
    return Row(path, stands=True)


def test_each_robot_has_a_row_whatever_becomes_of_the_others():
    paths = ["a", "error", "bug", "refused", "dies", "hangs", "b"]
    _find_defects()
    rows = {row.path: row for row in run_in_parallel(paths, _work, jobs=3, limit=2.0)}
    assert set(rows) == set(paths)
    assert rows["a"].stands
    assert rows["b"].stands
    assert str(rows["error"].error) == "error:3:4: is wrong"
    assert "bug in urdftool" in rows["bug"].error.message
    assert "ixx of <inertia> in link 'link_01'" in rows["refused"].error.message
    assert rows["refused"].error.notes
    assert "exit code -9" in rows["dies"].error.message
    assert "was stopped after the time limit of 2 s" in rows["hangs"].error.message


def test_what_the_system_does_not_give_is_said():
    rows = {row.path: row for row in run_in_parallel(["no files", "no memory"], _work, jobs=2)}
    assert rows["no files"].error.message == "Too many open files"
    assert rows["no memory"].error.message == "not enough memory"


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="signals are not held back")
def test_who_is_ended_as_soon_as_it_starts_ends_quietly(capfd):
    for _ in range(20):
        rows = run_in_parallel(["a", "hangs", "hangs"], _work, jobs=3)
        with terminate_gracefully():
            next(rows)
            rows.close()
    assert capfd.readouterr().err == ""


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="signals are not held back")
def test_a_worker_takes_signals_again():
    (row,) = run_in_parallel(["mask"], _work, jobs=1)
    assert row.name == "[]"


def test_who_does_not_hear_that_the_time_is_over_is_killed():
    began = time.monotonic()
    (row,) = run_in_parallel(["deaf"], _work, jobs=1, limit=0.5)
    assert "was stopped" in row.error.message
    assert time.monotonic() - began < 40


@pytest.mark.program("ps")
def test_whoever_stops_early_leaves_no_process():
    rows = run_in_parallel(["hangs", "a", "hangs"], _work, jobs=3)
    assert next(rows).path == "a"
    rows.close()
    time.sleep(0.1)
    children = subprocess.run(
        ["ps", "--ppid", str(os.getpid()), "-o", "stat=,args="], capture_output=True, text=True
    ).stdout.splitlines()
    assert not [line for line in children if "python" in line and not line.startswith("Z")]


@pytest.fixture
def fleet(urdftool, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robots" / ".hidden").mkdir(parents=True)
    for name in ("mira.urdf", "mira_geometric.urdf"):
        sound = "mira_simple_collisions_inertias.urdf"
        text = (MIRA / (sound if name == "mira.urdf" else name)).read_bytes()
        (tmp_path / "robots" / name).write_bytes(text)
        (tmp_path / "robots" / ".hidden" / name).write_bytes(text)
    macros = '<robot name="m" xmlns:xacro="http://www.ros.org/wiki/xacro"/>'
    (tmp_path / "robots" / "macros.urdf.xacro").write_text(macros)

    def call(*arguments):
        return urdftool("simulate", "--engine", "mujoco", "--fleet", "robots", *arguments)

    return call


def test_a_folder_is_one_table(fleet):
    result = fleet()
    assert result.code == 1
    lines = result.out.splitlines()
    assert [line.split()[0] for line in lines[:2]] == [
        "robots/mira.urdf",
        "robots/mira_geometric.urdf",
    ]
    assert "stands" in lines[0]
    assert "no-collision-geometry" in lines[1]
    assert lines[2] == "3 robots: 1 stand, 1 do not stand, 1 skipped"


def test_a_robot_that_cannot_be_tried_is_a_row(fleet, tmp_path):
    (tmp_path / "broken.urdf").write_text("<robot name='r'><link name='a'/>\n<link name='b'/></r")
    result = fleet("broken.urdf", "none.urdf", "--format", "json", "--junit", "out.xml")
    assert result.code == 2
    said = json.loads(result.out)
    schema = json.loads((ROOT / "docs" / "schemas" / "simulate-fleet.json").read_text("utf-8"))
    jsonschema.Draft202012Validator(schema).validate(said)
    robots = {robot["path"]: robot for robot in said["robots"]}
    assert robots["robots/mira.urdf"]["stands"] is True
    assert robots["robots/macros.urdf.xacro"]["skipped"]
    assert robots["broken.urdf"]["error"]["line"] == 2
    assert robots["none.urdf"]["error"]["message"] == "no such file"
    assert "none.urdf: no such file" in result.err
    root = ElementTree.parse(tmp_path / "out.xml").getroot()
    assert {name: root.get(name) for name in ("tests", "failures", "errors")} == {
        "tests": "5",
        "failures": "1",
        "errors": "2",
    }
    (case,) = root.findall(".//testcase[@classname='robots/mira_geometric.urdf']")
    assert "missing-collision" in case.find("failure").text
    (skipped,) = root.findall(".//skipped")
    assert "only macros" in skipped.get("message")


def test_one_robot_is_a_junit_case_too(urdftool):
    result = urdftool("simulate", MIRA / "mira.urdf", "--engine", "mujoco", "--format", "junit")
    assert result.code == 0
    assert ElementTree.fromstring(result.out.encode()).get("tests") == "1"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--fleet"], "missing argument IN"),
        (["--fleet", "-"], "does not read standard input"),
        (["--fleet", "a.urdf", "--plot", "a.png"], "do not support --fleet"),
        (["a.urdf", "b.urdf"], "a.urdf b.urdf"),
        (["--fleet", "empty"], "no .urdf or .urdf.xacro below empty"),
        (["a.urdf", "--junit", "file/a.xml"], "file is not a folder"),
    ],
)
def test_a_wrong_call_is_said(urdftool, tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty").mkdir()
    (tmp_path / "file").touch()
    result = urdftool("simulate", "--engine", "mujoco", *arguments)
    assert result.code == 2
    assert said in result.err


@pytest.mark.slow
def test_interrupted_it_stops_and_leaves_nothing(tmp_path):
    """Ctrl-C in the middle: exit 130, no process, no temporary folder."""
    environment = {**os.environ, "TMPDIR": str(tmp_path)}
    process = subprocess.Popen(
        [sys.executable, "-m", "urdftool", "simulate", "--engine", "mujoco", "--duration", "3600",
         "--timestep", "1e-5", "--slope", "40", "--friction", "0", "--fleet", str(ROBOTS)],
        cwd=ROOT, env=environment, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    time.sleep(6)
    process.send_signal(signal.SIGINT)
    assert process.wait(20) == 130
    assert process.stderr.read().endswith("urdftool: stopped\n")
    time.sleep(0.5)
    assert not list(tmp_path.glob("urdftool-*"))


@pytest.mark.program("ps")
@pytest.mark.skipif(sys.platform == "win32", reason="needs signals")
@pytest.mark.slow
@pytest.mark.parametrize("how", ["KILL", "TERM", "HUP"])
@pytest.mark.parametrize("many", [["--fleet"], []], ids=["fleet", "one"])
def test_ended_from_outside_it_leaves_nothing(tmp_path, how, many):
    """No process, and no temporary folder unless it was killed before it could remove that."""
    (tmp_path / "tmp").mkdir()
    shutil.copyfile(MIRA / "mira_simple_collisions_inertias.urdf", tmp_path / "mira.urdf")
    process = subprocess.Popen(
        [sys.executable, "-m", "urdftool", "simulate", "--engine", "mujoco", "--duration", "3600",
         "--timestep", "1e-5", "--slope", "40", "--friction", "0", *many,
         str(tmp_path / "mira.urdf")],
        cwd=ROOT, env={**os.environ, "TMPDIR": str(tmp_path / "tmp")}, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    until = time.monotonic() + 20
    while not list((tmp_path / "tmp").glob("urdftool-*/*")) and time.monotonic() < until:
        time.sleep(0.05)
    time.sleep(0.5)
    process.send_signal(getattr(signal, f"SIG{how}"))
    code = process.wait(20)
    assert code == {"KILL": -9, "TERM": 143, "HUP": 129}[how]
    time.sleep(1)
    assert not [line for line in _processes() if str(tmp_path) in line]
    assert how == "KILL" or not list((tmp_path / "tmp").iterdir())


def _processes():
    """Their command lines and environments."""
    ps = ["ps", "axeww", "-o", "args="]
    return subprocess.run(ps, capture_output=True, text=True).stdout.splitlines()


def test_notes_of_workers_are_printed_in_the_order_of_the_robots(urdftool, write):
    pytest.importorskip("pybullet")
    blocks = "".join(f'<gazebo reference="{name}"/>' for name in ("none", "nobody"))
    robot = '<robot name="r"><link name="a"/>{}</robot>'
    paths = [write(f"{name}.urdf", robot.format(blocks)) for name in "ba"]
    result = urdftool("simulate", "--fleet", *paths, "-j", "2", "--duration", "0.01")
    noted = [line for line in result.err.splitlines() if "'none'" in line]
    assert [line.partition(":")[0] for line in noted] == paths
