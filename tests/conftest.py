"""What several tests share: where things are, and the command line called in process."""

import os
import signal
from dataclasses import dataclass
from pathlib import Path

import pytest

from urdftool import cli, configuration, inputs

ROOT = Path(__file__).resolve().parents[1]
FIXTURES = ROOT / "fixtures"
CORPUS = ROOT.parent / "shared" / "corpus"

# a shell that starts the tests in the background has them pass over it, and what they start, too
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(items):
    if CORPUS.exists():
        return
    absent = pytest.mark.skip(reason=f"the corpus of real robots is not at {CORPUS}")
    for item in items:
        if "corpus" in item.keywords:
            item.add_marker(absent)


@pytest.fixture(autouse=True)
def _fresh(monkeypatch, tmp_path_factory):
    """Nothing that was found in one test is known in the next; no ROS of the machine is seen."""
    for name in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    inputs.forget()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
    configuration._found.clear()


@dataclass
class Result:
    """What a command printed, and its exit code."""

    code: int
    out: str
    err: str


@pytest.fixture
def urdftool(capfdbinary):
    """Call the command line; gives a :class:`Result`."""

    def call(*arguments):
        capfdbinary.readouterr()
        code = cli.call([str(argument) for argument in arguments])
        captured = capfdbinary.readouterr()
        return Result(code, captured.out.decode(), captured.err.decode())

    return call


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Write a file below a temporary folder, which is the current one; gives its path."""
    monkeypatch.chdir(tmp_path)

    def writer(name, text):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(text, bytes):
            path.write_bytes(text)
        else:
            path.write_text(text, "utf-8")
        return os.path.relpath(path)

    return writer


XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n{}\n</robot>\n'


@pytest.fixture
def xacro_file(write):
    """Write a xacro file with something in its robot; gives its path."""
    return lambda name, inside: write(name, XACRO.format(inside))


@pytest.fixture
def stand_ins(tmp_path):
    """A folder with the files that examples name."""
    from tests import stand_ins

    return stand_ins.make(tmp_path)
