"""``urdftool lint --watch``, without depending on how fast anything runs."""

import os
import shutil
import signal
import subprocess
import sys

import pytest

from tests.conftest import FIXTURES
from urdftool.lint.options import Options
from urdftool.lint.watch import Watch

BAD = FIXTURES / "rules" / "axis-not-unit" / "bad.urdf"
ARM = FIXTURES / "robots" / "demo_arm"


class Steps:
    """What happens at each pause; after the last, Ctrl-C."""

    def __init__(self, *steps):
        self.steps = list(steps)

    def __call__(self, seconds):
        assert seconds > 0
        if not self.steps:
            raise KeyboardInterrupt
        self.steps.pop(0)()


@pytest.fixture
def watched(urdftool, monkeypatch):
    """Run the command with steps at its pauses."""

    def run(*words, steps):
        pause = Steps(*steps)
        wait = Watch.wait
        monkeypatch.setattr(Watch, "wait", lambda self, _: wait(self, pause))
        return urdftool("lint", "--watch", "--format", "concise", *words)

    return run


def replace(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_a_change_is_reported_and_ctrl_c_ends_with_130(watched, tmp_path):
    robot = tmp_path / "arm.urdf"
    shutil.copy(BAD, robot)
    done = watched(robot, steps=[lambda: replace(robot, 'xyz="0 1 1"', 'xyz="0 1 0"')])
    assert done.code == 130
    assert done.out.count("[axis-not-unit]") == 1
    assert "changed: " in done.err
    assert "no findings in 1 file" in done.err.partition("changed: ")[2]
    assert done.err.rstrip().endswith("stopped")


def test_an_included_file_is_watched(watched, tmp_path):
    folder = tmp_path / "demo_arm"
    shutil.copytree(ARM, folder)
    macro = folder / "urdf" / "link.macro.xacro"
    done = watched(
        folder / "urdf" / "arm.urdf.xacro",
        "--select",
        "inertia-triangle-inequality",
        steps=[lambda: replace(macro, "length**2 / 2", "radius**2 / 2")],
    )
    assert "link.macro.xacro" in done.err.partition("changed: ")[2].splitlines()[0]
    assert done.out.count("[inertia-triangle-inequality]") == 1


def test_a_mesh_that_appears_is_a_change(watched, tmp_path):
    robot = tmp_path / "arm.urdf"
    robot.write_text(
        '<robot name="a"><link name="l"><visual><geometry><mesh filename="part.stl"/></geometry>'
        "</visual></link></robot>"
    )
    steps = [lambda: shutil.copy(FIXTURES / "meshes" / "cube.stl", tmp_path / "part.stl")]
    done = watched(robot, "--select", "mesh-not-found", steps=steps)
    assert done.out.count("[mesh-not-found]") == 1
    assert "part.stl" in done.err
    assert "no findings" in done.err


def test_a_new_robot_in_a_folder_is_checked(watched, tmp_path):
    shutil.copy(BAD, tmp_path / "one.urdf")
    done = watched(tmp_path, steps=[lambda: shutil.copy(BAD, tmp_path / "two.urdf")])
    assert done.out.count("one.urdf:26") == 2
    assert done.out.count("two.urdf:26") == 1


def test_what_breaks_in_between_is_reported_and_does_not_end_it(watched, tmp_path):
    robot = tmp_path / "arm.urdf"
    shutil.copy(BAD, robot)
    settings = tmp_path / "urdftool.toml"
    steps = [
        lambda: robot.write_text("<robot"),
        lambda: settings.write_text("[lint]\nselect = 3\n"),
        settings.unlink,
        robot.unlink,
        lambda: shutil.copy(BAD, robot),
    ]
    done = watched(robot, steps=steps)
    assert done.code == 130
    assert "[not-well-formed]" in done.out
    assert "lint.select must be a list" in done.err
    assert "no such file" in done.err
    assert done.out.count("[axis-not-unit]") == 2


def test_only_what_changed_is_checked_again(tmp_path):
    paths = [str(tmp_path / name) for name in ("one.urdf", "two.urdf")]
    for path in paths:
        shutil.copy(BAD, path)
    watch = Watch(paths)
    before = list(watch.check_files(paths, Options()))
    os.truncate(paths[1], 0)
    after = list(watch.check_files(paths, Options()))
    assert after[0] is before[0]
    assert after[1] is not before[1]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--fix"], "does not go with --fix"),
        (["--diff"], "does not go with --diff"),
        (["--list"], "does not go with --list"),
        (["-"], "--watch requires files"),
    ],
)
def test_other_work_is_refused(urdftool, words, message):
    done = urdftool("lint", "--watch", BAD, *words)
    assert done.code == 2
    assert message in done.err


def test_the_process_ends_at_ctrl_c(tmp_path):
    robot = tmp_path / "arm.urdf"
    shutil.copy(BAD, robot)
    words = [sys.executable, "-m", "urdftool", "lint", "--watch", "--format", "concise", robot]
    process = subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, cwd=tmp_path
    )
    try:
        assert "[axis-not-unit]" in process.stdout.readline()
        replace(robot, 'xyz="0 1 1"', 'xyz="0 3 0"')
        assert "length 3" in process.stdout.readline()
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 130
    finally:
        process.kill()
        process.wait()
