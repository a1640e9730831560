"""Processes with limits: what breaks one task leaves the others alone."""

import os
import pickle
import signal
import sys
import time

import pytest

from urdftool.errors import ModelError, UrdftoolError, XacroError
from urdftool.isolated import IsolatedProcess, ProcessDied, ProcessTimeout
from urdftool.parallel import make_plain_error, map_tasks, yield_in_order

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")


def work(task):
    if task == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    if task == "hang":
        time.sleep(60)
    if task == "refuse":
        raise ModelError("no legs", path="r.urdf", line=3)
    if task == "fill":
        return len(b"x" * 3_000_000_000)
    if task == "slow":
        time.sleep(0.3)
    return task, os.getpid()


def mapped(tasks, **options):
    options.setdefault("workers", 2)
    return dict(map_tasks(work, tasks, on_lost=lambda task, loss: (task, loss), **options))


def test_each_task_has_its_result_and_workers_are_used_again():
    tasks = [str(number) for number in range(20)]
    found = mapped(tasks)
    assert [found[index][0] for index in range(20)] == tasks
    processes = {found[index][1] for index in range(20)}
    assert 1 <= len(processes) <= 2
    assert os.getpid() not in processes


def test_one_worker_is_this_process():
    assert mapped(["a", "b"], workers=1)[1] == ("b", os.getpid())
    assert mapped(["a"], workers=1, isolate=True)[0][1] != os.getpid()


def test_results_can_keep_the_order_of_the_tasks():
    names = [task for task, _ in yield_in_order(map_tasks(work, ["slow", "a", "b"], workers=2))]
    assert names == ["slow", "a", "b"]


def test_a_killed_worker_is_reported_and_the_others_go_on():
    found = mapped(["a", "die", "b", "die", "c"])
    assert [found[index][0] for index in (0, 2, 4)] == ["a", "b", "c"]
    assert [found[index][1].exit_code for index in (1, 3)] == [-9, -9]


def test_without_a_result_for_it_a_lost_worker_is_an_error():
    with pytest.raises(UrdftoolError, match="code -9"):
        dict(map_tasks(work, ["a", "die"], workers=2))


def test_a_task_that_takes_too_long_is_ended():
    began = time.monotonic()
    found = mapped(["hang", "a"], time_limit=1.5)
    assert found[0][1].timed_out
    assert found[1][0] == "a"
    assert time.monotonic() - began < 40


@pytest.mark.skipif(sys.platform != "linux", reason="address space is not limited elsewhere")
def test_memory_has_a_limit():
    with pytest.raises(MemoryError):
        mapped(["a", "fill"], memory_limit=2_000_000_000)


def test_an_error_of_a_task_is_raised_here():
    with pytest.raises(ModelError, match="no legs") as raised:
        mapped(["a", "refuse", "b"])
    assert raised.value.where == "r.urdf:3"


def test_progress_names_what_runs():
    seen = []
    mapped(["a", "slow", "b"], on_progress=lambda done, running: seen.append((done, running)))
    assert seen[0] == (0, ["a", "slow"])
    assert seen[-1] == (3, [])


def test_an_isolated_call():
    with IsolatedProcess() as process:
        assert process.call("math", "hypot", 3, 4, time_limit=20) == 5


def test_an_isolated_process_that_dies_or_hangs():
    with IsolatedProcess() as process, pytest.raises(ProcessDied, match="SIGABRT") as raised:
        process.call("os", "abort", time_limit=20)
    assert raised.value.exit_code == -signal.SIGABRT
    with IsolatedProcess() as process, pytest.raises(ProcessTimeout):
        process.call("time", "sleep", 60, time_limit=0.3)


def test_an_error_of_a_worker_keeps_what_a_fix_reads():
    facts = {"rule": "unknown-macro", "case": "a call", "data": {"suggestion": "wheel"}}
    error = XacroError("unknown macro 'whel'", path="r.xacro", line=3, **facts)
    plain = pickle.loads(pickle.dumps(make_plain_error(error)))
    assert (plain.rule, plain.case, plain.data) == tuple(facts.values())
    assert str(plain) == str(error)
