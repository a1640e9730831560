"""Python files of the current folder that have the names of modules which libraries import."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import FIXTURES

NAMES = ("ctypes", "collections", "struct", "types", "textwrap", "glfw", "mujoco")
MJCF = '<mujoco><worldbody><body><freejoint/><geom size="0.1"/></body></worldbody></mujoco>'
START = "import sys; sys.path[:] = {path!r}; from urdftool.cli import run; run()"
LOAD = "import sys; sys.path[:] = {path!r}; import urdftool; urdftool.load('m.xml')"


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(
    ("code", "words"),
    [
        (START, "lint --no-cache ."),
        (START, "simulate r.urdf --engine mujoco --duration 0.1"),
        pytest.param(
            LOAD, "", marks=pytest.mark.skipif(sys.version_info < (3, 11), reason="no safe path")
        ),
    ],
)
def test_no_module_of_the_current_folder_is_imported(tmp_path, code, words):
    for name in NAMES:
        (tmp_path / f"{name}.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w').close()")
    (tmp_path / "m.xml").write_text(MJCF)
    robot = FIXTURES / "effects" / "robots" / "pendulum.urdf"
    (tmp_path / "r.urdf").write_bytes(robot.read_bytes())
    path = [str(Path.cwd()), *filter(os.path.isabs, sys.path)]
    done = subprocess.run(
        [sys.executable, "-I", "-c", code.format(path=path), *words.split()],
        cwd=tmp_path, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode in (0, 1), done.stderr
    assert not (tmp_path / "ran").exists()
