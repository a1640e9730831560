"""Checks at the same time in several threads: each says what it says alone."""

import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import pytest

from tests.conftest import FIXTURES
from urdftool.lint.fix_run import apply_fixes
from urdftool.lint.merge import gather
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings
from urdftool.report.findings_json import to_json
from urdftool.workspace import Workspace

ROBOTS = [
    *sorted(FIXTURES.glob("robots/*/urdf/*.urdf.xacro")),
    FIXTURES / "robots" / "ten_links.urdf",
    *sorted(FIXTURES.glob("rules/mesh*/bad*.urdf")),
    *sorted(FIXTURES.glob("rules/*collision*/bad*.urdf")),
    *sorted(FIXTURES.glob("rules/analysis-incomplete/bad*.urdf")),
]
ALL = Settings(select=("all",))


def check(path, workspace):
    return to_json(gather([check_file(path, Options(ALL, fixes=True, workspace=workspace))]))


def fix(path, workspace):
    options = Options(ALL, fixes=True, workspace=workspace)
    done = apply_fixes([check_file(path, options)], options, unsafe=True, meshes=True)
    return to_json(gather(done.reports)), done.after, done.applied, done.broken, done.unmade


@pytest.fixture(autouse=True)
def _many_switches():
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    yield
    sys.setswitchinterval(before)


@pytest.mark.parametrize("shared", [False, True], ids=["own workspaces", "one workspace"])
@pytest.mark.parametrize("work", [check, fix])
def test_threads_do_not_know_of_each_other(work, shared):
    robots = ROBOTS[::10] if work is check else ROBOTS[::16]
    alone = [work(path, Workspace()) for path in robots]
    together = Workspace()
    barrier = Barrier(4)

    def run(numbers):
        barrier.wait()
        return {n: work(robots[n], together if shared else Workspace()) for n in numbers}

    # two threads go forward and two backward, so that each robot is in two at nearly one time
    forward = list(range(len(robots)))
    orders = [forward, forward[::-1], forward[1:] + forward[:1], forward[::-1]]
    with ThreadPoolExecutor(4) as pool:
        for found in pool.map(run, orders):
            for number, result in found.items():
                assert result == alone[number], robots[number]
