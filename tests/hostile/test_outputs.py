"""Outputs over inputs, without room, and cut off in the middle: whole or not at all."""

import random
import subprocess
import sys
import time

import pytest

from tests.hostile.writers import ROBOT, WRITERS, contents, is_slow, process, robot, words

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs links and resource limits")

NAMES = [pytest.param(n, marks=[pytest.mark.slow] if is_slow(n) else []) for n in WRITERS]


@pytest.fixture
def place(tmp_path):
    robot(tmp_path / "r")
    (tmp_path / "home").mkdir()
    return tmp_path / "r"


def run(command, place, **options):
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
    child = process(command, place, place.parent / "home", **options)
    out, err = child.communicate(timeout=240)
    return child.returncode, out.decode(), err.decode()


def inputs(place):
    return {name: data for name, data in contents(place).items() if name in GIVEN}


GIVEN = ("r.xacro", "r.urdf", "cube.obj", "cube.mtl", "sphere.stl", "two_cubes.stl")
READS_NOTHING = ("shape", "macros")


@pytest.mark.parametrize("name", NAMES)
def test_a_link_to_an_input_is_not_written_through(name, place):
    if name in READS_NOTHING:
        pytest.skip("it has no input")
    command, target = WRITERS[name]
    read = next(word for word in command.split() if word in GIVEN)
    (place / target).symlink_to(place / read)
    before = inputs(place)
    code, _, err = run(words(name, target), place)
    assert code == 2
    assert err.strip()
    assert inputs(place) == before
    assert (place / target).is_symlink()


EXPORTS = [("sdf", "r.xacro"), ("mjcf", "r.urdf"), ("sdf", "cube.obj"), ("mjcf", "cube.obj")]


@pytest.mark.parametrize(("language", "target"), EXPORTS)
def test_a_file_is_no_folder_for_an_export(language, target, place):
    before = contents(place)
    code, _, err = run(["export", language, "r.urdf", "--force", "-o", target], place)
    assert code == 2
    assert "is a file" in err
    assert contents(place) == before


@pytest.mark.slow
@pytest.mark.parametrize("language", ["sdf", "mjcf"])
def test_meshes_beside_a_robot_stay(language, place):
    before = inputs(place)
    target = "a.sdf" if language == "sdf" else "a.xml"
    run(["export", language, "r.urdf", "--force", "-o", target, "--mesh-dir", "."], place)
    assert inputs(place) == before


@pytest.mark.parametrize("name", NAMES)
def test_a_full_disk_leaves_nothing(name, place):
    def full():
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))

    before = contents(place)
    code, _, err = run(words(name, WRITERS[name][1]), place, preexec_fn=full)
    after = contents(place)
    fits = code != 2
    small = {n for n in after if fits and n not in before and len(after[n]) <= 64}
    assert code == 2 or small
    assert "too large" in err or small
    assert {n: d for n, d in after.items() if n not in small} == before


@pytest.mark.parametrize("name", NAMES)
def test_a_folder_that_is_not_there(name, place):
    before = contents(place)
    code, _, err = run(words(name, f"no/such/{WRITERS[name][1]}"), place)
    if name == "collision":  # makes the folders of its output
        assert code == 0
        return
    assert code == 2
    assert "does not exist" in err
    assert {n: d for n, d in contents(place).items() if n != "other.urdf"} == before


@pytest.mark.slow
@pytest.mark.parametrize("name", list(WRITERS))
def test_killed_at_any_moment(name, place):
    """What was there stays or is replaced as a whole; the next run works."""
    target = WRITERS[name][1]
    start = time.monotonic()
    code, _, err = run(words(name, target), place)
    whole = time.monotonic() - start
    assert code in (0, 1), err
    good = {n: d for n, d in contents(place).items() if "/" not in n and n not in GIVEN}
    dice = random.Random(name)
    for _ in range(4):
        child = process(
            words(name, target),
            place,
            place.parent / "home",
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        time.sleep(whole * dice.uniform(0.2, 1.0))
        child.kill()
        child.wait()
        now = contents(place)
        assert now["r.urdf"].decode() == ROBOT
        for file, data in good.items():
            if file.endswith((".urdf", ".xacro", ".json", ".gv", ".obj", ".d", ".mmd", ".sdf")):
                assert now[file] == data, file
    code, _, err = run(words(name, target), place)
    assert code in (0, 1), err
