"""What several tests share: where things are, and the command line called in process."""

import gc
import os
import re
import shutil
import signal
import subprocess
import sys
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import HealthCheck, settings

from tests.forked import ForkedPython
from urdftool import cli, extras, isolated
from urdftool.commands import progress
from urdftool.parallel import can_fork
from urdftool.projects import TRUST

ROOT = Path(__file__).resolve().parents[1]
FIXTURES = ROOT / "fixtures"
CORPUS = ROOT.parent / "shared" / "corpus"

# how long inputs take on a machine with other work says nothing of the program
settings.register_profile("urdftool", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("urdftool")

# a shell that starts the tests in the background has them pass over it, and what they start, too
signal.signal(signal.SIGINT, signal.default_int_handler)


QUICK = frozenset(
    ROOT / line
    for line in (ROOT / "tests" / "quick.txt").read_text("utf-8").splitlines()
    if not line.startswith("#")
)
"""Files whose tests have the mark ``quick``."""

MOST_SKIPPED = 70
"""How many tests may be skipped where the corpus and every extra are present."""

ABSENT = re.compile(
    r"requires (a physics engine|[\w-]+), (?:which is not|and none is) installed: pip"
)
"""What a command prints where an optional library is missing; a test of it is skipped there."""


def is_there(named):
    """Whether what a message calls missing is installed, so that a test has hidden it."""
    if named == "a physics engine":
        return extras.is_installed("pybullet") or extras.is_installed("mujoco")
    names = {distribution: name for name, distribution in extras.DISTRIBUTION_OF.items()}
    return extras.is_installed(names.get(named, named))


def skips_too_many(count):
    """Whether so many tests were skipped that a green run would mean little."""
    left_out = ("dask", "robots")
    optional = {library for library, extra in extras.EXTRA_OF.items() if extra not in left_out}
    return count > MOST_SKIPPED and CORPUS.exists() and all(map(extras.is_installed, optional))


def pytest_sessionfinish(session):
    """Fail a run that skipped too many tests; workers of a parallel run do not count them."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if reporter is None or hasattr(session.config, "workerinput"):
        return
    skipped = len(reporter.stats.get("skipped", []))
    if skips_too_many(skipped) and session.exitstatus == pytest.ExitCode.OK:
        reporter.write_line(f"{skipped} tests were skipped; {MOST_SKIPPED} may be", red=True)
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def is_quick_run(config):
    """Whether only the quick tests were asked for, so that other files need not be imported."""
    return config.getoption("markexpr", "") == "quick"


def pytest_ignore_collect(collection_path, config):
    """Leave out the files without quick tests, which takes most of the time of collecting."""
    if is_quick_run(config) and collection_path.suffix == ".py":
        return (collection_path not in QUICK) or None
    return None


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Collect without the garbage collector, which would look at every test again and again.

    What was collected stays: later searches for garbage leave it out.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.enable()
        gc.freeze()


def pytest_collection_modifyitems(items):
    for item in items:
        if item.path in QUICK:
            item.add_marker(pytest.mark.quick)
    absent = pytest.mark.skip(reason=f"the corpus of real robots is not at {CORPUS}")
    for item in items:
        if "corpus" in item.keywords and not CORPUS.exists():
            item.add_marker(absent)
        for mark in item.iter_markers("program"):
            if not any(map(shutil.which, mark.args)):
                item.add_marker(pytest.mark.skip(reason=f"requires {' or '.join(mark.args)}"))
        for mark in item.iter_markers("library"):
            if not all(map(extras.is_installed, mark.args)):
                item.add_marker(pytest.mark.skip(reason=f"requires {' and '.join(mark.args)}"))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """Skip a test that failed because an optional library is not installed, as in the core."""
    report = yield
    if report.failed and call.excinfo is not None:
        library = extras.find_missing_library(call.excinfo.value)
        if library is not None and not extras.is_installed(library):
            report.outcome = "skipped"
            report.longrepr = (str(item.path), 0, f"requires {library}")
    return report


@pytest.fixture(scope="session")
def programs(tmp_path_factory):
    """A PATH with what every machine has, and the programs beside this Python."""
    from generator.programs import restrict_path

    return restrict_path(tmp_path_factory.mktemp("programs"), Path(sys.executable).parent)


@pytest.fixture(scope="session")
def cache_folders(tmp_path_factory):
    """Yield empty folders; ``mktemp`` would list those of all tests before, for each one."""
    parent = tmp_path_factory.mktemp("caches")

    def make_folders():
        for number in count():
            folder = parent / str(number)
            folder.mkdir()
            yield folder

    return make_folders()


@pytest.fixture(scope="session", autouse=True)
def _forks_have_mujoco():
    """Import MuJoCo once, and not in each of the forks that read an MJCF."""
    if extras.is_installed("mujoco"):
        import mujoco  # noqa: F401


@pytest.fixture(autouse=True)
def _engines_start_as_forks(monkeypatch):
    """Fork for MuJoCo, which is here already; the tests of the documentation start it as users do.

    Half of the time of a short simulation is that of the start of its engine.
    """

    def start(words, **how):
        libraries = words[3].split(",") if len(words) > 3 else ()
        forks = "mujoco" in libraries and "mujoco" in sys.modules and can_fork()
        if how["cwd"] is None:
            del how["cwd"]
        return (ForkedPython if forks else subprocess.Popen)(words, **how)

    known = {name: getattr(subprocess, name) for name in ("PIPE", "TimeoutExpired")}
    monkeypatch.setattr(isolated, "subprocess", SimpleNamespace(Popen=start, **known))


@pytest.fixture(autouse=True)
def _fresh(monkeypatch, cache_folders, request, programs):
    """Nothing that was found in one test is known in the next; no ROS of the machine is seen.

    Programs that not every machine has are seen by tests that are marked with them.
    """
    if not list(request.node.iter_markers("program")):
        monkeypatch.setenv("PATH", programs)
    for name in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    # a busy machine must not add lines to what a test reads
    monkeypatch.setattr(progress, "PIPE_PATIENCE", 3600.0)
    monkeypatch.setenv("XDG_CACHE_HOME", str(next(cache_folders)))


@dataclass
class Result:
    """What a command printed, and its exit code."""

    code: int
    out: str
    err: str


@pytest.fixture
def urdftool(capfdbinary):
    """Call the command line; gives a :class:`Result`. ``--trust`` holds for that call alone."""

    def call(*arguments):
        capfdbinary.readouterr()
        with pytest.MonkeyPatch.context() as environment:
            environment.setenv(TRUST, os.environ.get(TRUST, ""))
            code = cli.call([str(argument) for argument in arguments])
        captured = capfdbinary.readouterr()
        absent = ABSENT.search(captured.err.decode())
        if absent and not is_there(absent[1]):
            pytest.skip(absent[0])
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


@pytest.fixture
def stages_are_read_here(monkeypatch):
    """Read stages in this process, where OpenUSD is loaded once for all tests.

    Commands read them in a process with limits; tests/formats/test_native_limits.py and
    tests/formats/usd/test_bad_stages.py do so, too.
    """
    from urdftool.formats.usd import read

    def call(function, *arguments, limits, prepare, threaded):
        # not prepared: a limit of OpenUSD's threads that is set when it has some makes one of
        # them call sched_yield until the process ends
        assert limits.memory
        assert prepare
        assert threaded
        return function(*arguments)

    monkeypatch.setattr(read, "call_with_limits", call)


XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n{}\n</robot>\n'


@pytest.fixture
def xacro_file(write):
    """Write a xacro file with something in its robot; gives its path."""
    return lambda name, inside: write(name, XACRO.format(inside))
