"""Tasks on a Dask cluster and in processes: the same reports, and what a lost worker costs."""

import json
import os
import signal
from pathlib import Path

import pytest

from tests.conftest import FIXTURES
from urdftool import cluster
from urdftool.cluster import Loss, map_anywhere
from urdftool.commands.export_many import choose_places
from urdftool.lint import run
from urdftool.lint.options import Options
from urdftool.lint.parallel import check_files

ROBOTS = FIXTURES / "robots"
GOOD = '<robot name="r"><link name="l"/></robot>'


@pytest.fixture(scope="module")
def scheduler(programs):
    """The address of a scheduler with two workers, which see the same programs as other tests."""
    distributed = pytest.importorskip("distributed")
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("PATH", programs)
        found = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with found:
        yield found.scheduler_address


def lines_of(text):
    """Lines without those of progress."""
    return [line for line in text.splitlines() if " robots, " not in line]


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        "lint {robots} --no-cache --format json",
        "simulate --fleet {robots}/laser_bot {robots}/my_robot --duration 0.5 --format json",
        "export sdf {robots}/laser_bot {robots}/my_robot -o out --verify --overwrite",
    ],
)
def test_a_cluster_reports_the_same_bytes(urdftool, write, scheduler, words):
    write("here", "")
    words = words.format(robots=ROBOTS).split()
    here = urdftool(*words, "-j", "2")
    files = {path: path.read_bytes() for path in Path("out").rglob("*") if path.is_file()}
    there = urdftool(*words, "--scheduler", scheduler)
    assert (here.code, here.out) == (there.code, there.out)
    assert lines_of(here.err) == lines_of(there.err)
    assert {path: path.read_bytes() for path in Path("out").rglob("*") if path.is_file()} == files
    assert len(here.out) > 1000


def work(task):
    """A task that may end its process, its worker, or raise."""
    if task == "segfault":
        os.kill(os.getpid(), signal.SIGSEGV)
    if task == "kill the worker":
        os.kill(os.getppid(), signal.SIGKILL)
    if task == "raise":
        raise ValueError(task)
    return task.upper()


def report_loss(task, loss):
    return f"{task}: {loss.describe()}"


@pytest.mark.slow
@pytest.mark.parametrize("others", ["abc", "abcdefgh" * 10], ids=["single", "grouped"])
@pytest.mark.parametrize(
    ("bad", "expected"),
    [
        ("segfault", "segfault: exit code -11"),
        ("kill the worker", "kill the worker: the cluster gave it up: KilledWorker"),
    ],
)
def test_a_worker_that_dies_loses_one_task(scheduler, bad, expected, others):
    tasks = ["a", bad, *others]
    found = dict(
        map_anywhere(work, tasks, workers=1, scheduler=scheduler, on_lost=report_loss, tries=1)
    )
    assert [found[index] for index in range(len(tasks))] == ["A", expected, *others.upper()]


@pytest.mark.slow
def test_an_exception_of_a_task_is_raised_here(scheduler):
    with pytest.raises(ValueError, match="raise"):
        list(map_anywhere(work, ["raise"], workers=1, scheduler=scheduler, on_lost=report_loss))


@pytest.mark.library("distributed")
def test_a_scheduler_that_is_absent_is_reported(urdftool, write, monkeypatch):
    monkeypatch.setattr(cluster, "_CONNECTING", 0.2)
    path = write("a.urdf", GOOD)
    done = urdftool("lint", path, "--no-cache", "--scheduler", "tcp://127.0.0.1:9")
    assert done.code == 2
    assert "no Dask scheduler answers at tcp://127.0.0.1:9" in done.err


@pytest.mark.parametrize(
    "words",
    [
        "lint a.urdf --fix --scheduler X",
        "simulate a.urdf --scheduler X",
        "export sdf a.urdf -o out --scheduler X",
        "export sdf a.urdf b.urdf --scheduler X",
        "export sdf a.urdf - -o out",
    ],
)
def test_options_that_exclude_each_other_are_refused(urdftool, write, words):
    write("a.urdf", GOOD)
    write("b.urdf", GOOD)
    done = urdftool(*words.split())
    assert done.code == 2
    assert "--help" in done.err


def test_a_process_that_ends_costs_lint_one_report(monkeypatch, write):
    paths = [write(f"{name}.urdf", GOOD) for name in "abc"]
    check_file = run.check_file

    def check(path, options):
        if path == "b.urdf":
            os._exit(7)
        return check_file(path, options)

    monkeypatch.setattr(run, "check_file", check)
    reports = list(check_files(paths, Options(), 2))
    assert [report.path for report in reports] == paths
    assert [report.error is None for report in reports] == [True, False, True]
    assert "exit code 7" in reports[1].error.message


def test_several_robots_are_exported_into_folders(urdftool, write):
    write("in/a/arm.urdf", GOOD)
    write("in/a/arm.sdf", "<sdf version='1.7'><model name='m'><link name='l'/></model></sdf>")
    write("in/b.urdf", GOOD.replace("<link", "<lnk"))
    done = urdftool("export", "sdf", "in", "-o", "out", "--format", "json", "-j", "1")
    assert done.code == 2
    assert "exported 2 of 3 robots; not exported: in/b.urdf\n" in done.err
    robots = {robot["path"]: robot for robot in json.loads(done.out)["robots"]}
    assert robots["in/a/arm.urdf"]["exit_code"] == 0
    assert robots["in/b.urdf"]["exit_code"] == 2
    assert Path("out/a/arm/model.sdf").exists()
    assert not Path("out/b").exists()
    one = urdftool("export", "sdf", "in/a/arm.urdf", "-o", "alone", "--format", "json")
    assert Path("alone/model.sdf").read_bytes() == Path("out/a/arm/model.sdf").read_bytes()
    assert one.err.replace("alone", "out/a/arm") in done.err


def test_files_that_differ_in_their_ending_have_different_folders():
    files = ["r/a.urdf", "r/b/a.urdf", "r/a.urdf.xacro", "r/a.xml"]
    assert choose_places(files, "o") == ["o/a", "o/b/a", "o/a_2", "o/a_3"]


def test_a_loss_describes_what_ended_the_worker():
    assert Loss(None).describe() == "time limit"
    assert Loss(-9).describe() == "exit code -9"
    assert Loss(1, "no worker is left").describe() == "no worker is left"
