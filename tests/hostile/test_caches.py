"""Several processes on one cache, and one that is killed while it writes there."""

import subprocess
import time

import pytest

from tests.hostile.writers import process, robot

pytestmark = pytest.mark.slow

COMMANDS = {
    "lint": ["lint", "r.xacro", "--exit-zero", "--format", "json"],
    "collision": ["collision", "mesh", "two_cubes.stl", "--format", "json", "--method", "coacd"],
}


def start(name, place):
    return process(
        COMMANDS[name],
        place / "r",
        place / "home",
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )


@pytest.mark.parametrize("name", COMMANDS)
def test_several_at_once_and_one_that_is_killed(name, tmp_path):
    robot(tmp_path / "r")
    (tmp_path / "home").mkdir()
    victim = start(name, tmp_path)
    others = [start(name, tmp_path) for _ in range(2)]
    time.sleep(1)
    victim.kill()
    victim.communicate()
    codes = []
    for child in (*others, start(name, tmp_path)):
        _, err = child.communicate(timeout=240)
        codes.append(child.returncode)
        assert b"Traceback" not in err
    assert set(codes) == {0}
    for path in (tmp_path / "home").rglob("*"):  # a damaged entry is computed anew
        if path.is_file():
            path.write_bytes(path.read_bytes()[:-5])
    child = start(name, tmp_path)
    _, err = child.communicate(timeout=240)
    assert child.returncode == 0, err
