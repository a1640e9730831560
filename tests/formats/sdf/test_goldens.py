"""Whole small robots, as they are to come out."""

import subprocess

import pytest

from urdftool.compare.check import is_faithful
from urdftool.formats.sdf.verify.compare import verify
from urdftool.formats.sdf.write import write
from urdftool.model.load import load

from .goldens import FOLDER, GOLDENS, path, text


@pytest.mark.parametrize(("name", "kind"), GOLDENS)
def test_golden(name, kind):
    assert text(name, GOLDENS[name, kind]) == path(name, kind).read_text("utf-8")


@pytest.mark.parametrize(("name", "kind"), GOLDENS)
def test_it_is_the_same_robot(name, kind, tmp_path):
    options = GOLDENS[name, kind]
    robot = load(FOLDER / f"{name}.urdf")
    written = write(robot, options)
    place = tmp_path / written.main
    place.write_bytes(written.files[written.main])
    checks = verify(robot, written, options, place if options.file else tmp_path)
    assert is_faithful(checks), [c.differing for c in checks]


@pytest.mark.program("ign")
@pytest.mark.parametrize(("name", "kind"), [key for key in GOLDENS if key[1] != "gz"])
def test_libsdformat_takes_it(name, kind):
    done = subprocess.run(
        ["ign", "sdf", "-k", str(path(name, kind))], capture_output=True, text=True, check=False
    )
    complaints = [s for s in done.stderr.splitlines() if "backtrace" not in s]
    assert (done.stdout.strip(), complaints) == ("Valid.", [])


@pytest.mark.parametrize(("name", "kind"), [key for key in GOLDENS if "classic" not in key[1]])
def test_drake_takes_it(name, kind):
    pytest.importorskip("pydrake")
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant

    if "world" in GOLDENS[name, kind].file:
        pytest.skip("Drake knows no systems of a world")
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModels(str(path(name, kind)))
