"""An engine that dies, hangs or talks does no harm."""

import math
import os
import subprocess
import sys
import time
from unittest import mock

import pytest

from tests.conftest import ROOT
from urdftool.errors import ModelError
from urdftool.simulation.engine_process import EngineDied, EngineProcess


def call(function, *arguments, time_limit=20.0):
    with EngineProcess("json") as child:
        return child.call("process_jobs", function, *arguments, time_limit=time_limit)


@pytest.fixture(autouse=True)
def _deeds(monkeypatch):
    """The module with what a child is made to do lies beside this test."""
    monkeypatch.setattr("urdftool.simulation.engine_process.MODULES", "tests.simulation")


def test_an_answer():
    assert call("double", 21) == 42


def test_what_the_engine_prints_is_swallowed(capfd):
    assert call("talk") == "said"
    assert capfd.readouterr() == ("", "")


def test_what_is_told_is_heard_before_the_answer():
    heard = []
    with EngineProcess("json") as child:
        assert child.call("process_jobs", "report", 1, time_limit=20, on_emit=heard.append) == 3
    assert heard == [1, 2]


def test_a_crash_after_telling_is_one_message():
    heard = []
    with EngineProcess("json") as child, pytest.raises(EngineDied, match="SIGSEGV"):
        child.call("process_jobs", "die_telling", time_limit=20, on_emit=heard.append)
    assert heard == ["on my way"]


def test_a_process_that_dies_before_its_job_is_one_message():
    with EngineProcess("json") as child:
        child._process.kill()
        child._process.wait()
        with pytest.raises(EngineDied, match="SIGKILL"):
            child.call("process_jobs", "double", b"x" * 10_000_000, time_limit=20)


def test_an_error_of_ours_comes_through():
    with pytest.raises(ModelError, match="no legs"):
        call("refuse")


def test_a_bug_is_one_message_with_its_kind():
    with pytest.raises(EngineDied, match="exit code 1") as raised:
        call("fail")
    assert raised.value.notes[-1] == "ZeroDivisionError: division by zero"


def test_a_crash_is_one_message():
    with pytest.raises(EngineDied, match="SIGSEGV"):
        call("crash")


def test_a_hang_ends_in_time_and_leaves_nobody(monkeypatch):
    monkeypatch.setattr("urdftool.simulation.engine_process.SLOWEST", 1.0)
    began = time.monotonic()
    with EngineProcess("json") as child:
        with pytest.raises(EngineDied, match="stopped after the limit of 1 s"):
            child.call("process_jobs", "hang", time_limit=1.0)
        number = child._process.pid
    assert time.monotonic() - began < 40
    with pytest.raises(ProcessLookupError):
        os.kill(number, 0)
    assert all(pipe.closed for pipe in (child._process.stdin, child._process.stdout))


@pytest.mark.skipif(sys.platform == "win32", reason="needs resource limits")
def test_the_limit_counts_processor_time(monkeypatch):
    monkeypatch.setattr("urdftool.simulation.engine_process._START", 0.0)
    with pytest.raises(EngineDied, match="after the limit of 1 s of processor time"):
        call("spin", time_limit=1.0)


def test_waiting_uses_no_processor_time():
    assert call("wait", 1.5, time_limit=1.0) == "waited"


@pytest.mark.parametrize("name", ["pickle", "numpy", "urdftool", "json"])
def test_no_module_is_taken_from_the_folder_one_works_in(tmp_path, monkeypatch, name):
    monkeypatch.setattr(sys, "path", [str(ROOT), *(path for path in sys.path if path)])
    (tmp_path / f"{name}.py").write_text("open('ran', 'w')")
    monkeypatch.chdir(tmp_path)
    assert call("double", 21) == 42
    assert not (tmp_path / "ran").exists()


def test_what_python_prints_while_it_starts_is_no_answer(tmp_path, monkeypatch):
    (tmp_path / "sitecustomize.py").write_text("print('hello', flush=True)")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    assert call("double", 21) == 42


def test_time_may_have_no_limit():
    assert call("double", 21, time_limit=math.inf) == 42


@pytest.mark.skipif(sys.platform == "win32", reason="needs resource limits")
def test_a_lower_limit_of_the_system_stays():
    line = (
        "import resource; resource.setrlimit(resource.RLIMIT_CPU, (9, 9)); "
        "from urdftool.simulation import engine_process as child; "
        "child.MODULES = 'tests.simulation'; "
        "process = child.EngineProcess('json'); "
        "print(process.call('process_jobs', 'double', 21, time_limit=60)); process.__exit__()"
    )
    done = subprocess.run(
        [sys.executable, "-c", line], cwd=ROOT, capture_output=True, text=True, timeout=60
    )
    assert done.stdout == "42\n", done.stderr


def test_a_system_without_threads_is_one_message():
    with EngineProcess("json") as child, mock.patch("urdftool.isolated.Thread.start") as start:
        start.side_effect = RuntimeError("can't start new thread")
        with pytest.raises(EngineDied, match="can't start new thread"):
            child.call("process_jobs", "double", 21, time_limit=20)


def test_it_ends_where_nobody_holds_its_input(monkeypatch):
    monkeypatch.setattr("urdftool.simulation.engine_process.SLOWEST", 1.0)
    with EngineProcess("json") as child:
        with pytest.raises(EngineDied, match="stopped after the limit"):
            child.call("process_jobs", "hang", time_limit=1.0)
        child._process.stdin.close()
        assert child._process.wait(5) == 1
