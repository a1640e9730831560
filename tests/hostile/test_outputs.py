"""Outputs over inputs, without room, and cut off in the middle: whole or not at all."""

import os
import random
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.hostile.writers import ROBOT, SLOW, WRITERS, contents, is_slow, process, robot, words
from tests.hostile.zygote import pack_words

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs links and resource limits")

NAMES = [pytest.param(n, marks=[pytest.mark.slow] if is_slow(n) else []) for n in WRITERS]


@dataclass
class Folder:
    """The folder of the robot, where a process that forks starts commands."""

    root: Path

    @property
    def project(self):
        return self.root / "r"

    def environment(self):
        home = str(self.root / "home")
        return {"PATH": os.environ["PATH"], "HOME": home, "XDG_CACHE_HOME": home}


@pytest.fixture
def place(tmp_path):
    robot(tmp_path / "r")
    (tmp_path / "home").mkdir()
    return tmp_path / "r"


@pytest.fixture
def run(zygote):
    """Run a command in the folder of the robot."""

    def call(command, place):
        outcome = zygote.ask(pack_words(command), Folder(place.parent))
        return outcome.code, outcome.out.decode(), outcome.err.decode()

    return call


def run_process(command, place, **options):
    """Run a command as :func:`run` does, in a new interpreter."""
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
    child = process(command, place, place.parent / "home", **options)
    out, err = child.communicate(timeout=240)
    return child.returncode, out.decode(), err.decode()


def inputs(place):
    return {name: data for name, data in contents(place).items() if name in GIVEN}


GIVEN = ("r.xacro", "r.urdf", "cube.obj", "cube.mtl", "sphere.stl", "two_cubes.stl")
READS_NOTHING = ("shape", "macros")


@pytest.mark.parametrize("name", NAMES)
def test_a_link_to_an_input_is_not_written_through(name, place, run):
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


SECONDS = {
    "expand r.xacro -o a.urdf --depfile r.xacro": "r.xacro",
    "expand r.xacro -o a.urdf --depfile cube.obj/a.d": "cube.obj/a.d",
    "expand r.xacro -o a.urdf --depfile a.urdf": "a.urdf",
    "expand r.xacro -o r.xacro --source-map a.json": "r.xacro",
    "expand r.xacro -o a.urdf --source-map r.xacro --depfile a.d": "r.xacro",
    "lint r.xacro --output-file a.txt --write-baseline r.xacro": "r.xacro",
    "lint r.xacro --output-file r.xacro --write-baseline a.json": "r.xacro",
    "lint r.xacro --output-file a.json --write-baseline a.json": "a.json",
    "graph r.xacro": "r.gv",
    "view r.xacro --size 9x9 --picture a.png --contact-sheet quadrants.png": "quadrants.png",
    "view r.xacro --size 9x9 --picture a.png --contact-sheet a.png": "a.png",
    "simulate r.urdf --engine mujoco --plot a.png --picture quadrants.png": "quadrants.png",
    "simulate r.urdf --engine mujoco --plot a.png --junit cube.obj": "cube.obj",
    "simulate r.urdf --engine mujoco --plot a.png --junit a.png": "a.png",
}
"""Commands with two outputs, one of which cannot be, and which that is."""


@pytest.mark.parametrize(
    "command",
    [pytest.param(c, marks=[pytest.mark.slow] if c.startswith(SLOW) else []) for c in SECONDS],
)
def test_of_two_outputs_both_are_written_or_none(command, place, run):
    (place / "r.gv").mkdir()
    before = contents(place)
    code, _, err = run(command.split(), place)
    assert code == 2
    assert SECONDS[command] in err
    assert contents(place) == before


@pytest.mark.parametrize("target", ["part.xacro", "r.xacro"])
def test_findings_take_no_place_of_what_is_included(target, place, run):
    (place / "part.xacro").write_text('<robot xmlns:xacro="http://www.ros.org/wiki/xacro"/>')
    text = (place / "r.xacro").read_text()
    include = '<xacro:include filename="part.xacro"/>\n</robot>'
    (place / "r.xacro").write_text(text.replace("</robot>", include))
    before = contents(place)
    for option in (["--output-file", target], ["--write-baseline", target]):
        code, _, err = run(["lint", "r.xacro", *option], place)
        assert (code, "is an input" in err) == (2, True), err
        assert contents(place) == before


EXPORTS = [("sdf", "r.xacro"), ("mjcf", "r.urdf"), ("sdf", "cube.obj"), ("mjcf", "cube.obj")]


@pytest.mark.parametrize(("language", "target"), EXPORTS)
def test_a_file_is_no_folder_for_an_export(language, target, place, run):
    before = contents(place)
    code, _, err = run(["export", language, "r.urdf", "--force", "-o", target], place)
    assert code == 2
    assert "is a file" in err
    assert contents(place) == before


@pytest.mark.slow
@pytest.mark.parametrize("language", ["sdf", "mjcf"])
def test_meshes_beside_a_robot_stay(language, place, run):
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
    # messages go through a pipe, to which the limit does not apply
    code, _, err = run_process(words(name, WRITERS[name][1]), place, preexec_fn=full)
    after = contents(place)
    fits = code != 2
    small = {n for n in after if fits and n not in before and len(after[n]) <= 64}
    assert code == 2 or small
    assert "too large" in err or small
    assert {n: d for n, d in after.items() if n not in small} == before


@pytest.mark.parametrize("name", NAMES)
def test_a_folder_that_is_not_there_is_made(name, place, run):
    code, _, err = run(words(name, f"no/such/{WRITERS[name][1]}"), place)
    assert code in (0, 1), err
    assert os.listdir(place / "no" / "such")


@pytest.mark.parametrize("name", NAMES)
def test_a_folder_that_cannot_be_made(name, place, run):
    before = contents(place)
    code, _, err = run(words(name, f"r.urdf/such/{WRITERS[name][1]}"), place)
    assert code == 2
    assert "folder" in err or "directory" in err
    assert {n: d for n, d in contents(place).items() if n != "other.urdf"} == before


@pytest.mark.slow
@pytest.mark.parametrize("name", list(WRITERS))
def test_killed_at_any_moment(name, place, run):
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
