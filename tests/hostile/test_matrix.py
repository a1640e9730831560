"""Hostile files, and the commands that read them: limits, exit codes, messages and secrets."""

import sys
from collections import Counter

import pytest

from tests.hostile.matrix import Run, execute, list_cases, list_runs
from tests.hostile.place import SECRETS

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="measures processes in /proc")

PARTS = 4


def check(runs, place, start):
    found = []
    for run in runs:
        _, problems = execute(run, place, start)
        found += [f"{run.case.category} | {run.case.name} | {run.command}: {p}" for p in problems]
    assert not found, "\n".join(found)


def list_sample():
    """Runs of every category, of which none takes more than a second or two."""
    runs = [run for run in list_runs() if run.case.name not in SLOW_CASES]
    return runs[3::37]


SLOW_CASES = frozenset(
    (
        *("links at one place", "links in a star", "links that overlap", "links in a tree"),
        *("many elements", "sparse_many.gltf", "sparse.gltf", "zeros.gltf", "large.png"),
        *("instances.gltf", "instances.dae", "tree.dae", "many geoms", "many bodies"),
        *("same.stl", "corners.obj", "polygon.obj", "zeros.zip", "text.png"),
    )
)


def test_there_are_many():
    assert len(list_runs()) >= 600
    assert 30 <= len(list_sample()) <= 60
    assert len({run.case.category for run in list_sample()}) >= 15


@pytest.mark.parametrize("part", range(PARTS))
def test_a_sample_is_within_all_limits(part, zygote, place):
    check(list_sample()[part::PARTS], place, zygote.run)


@pytest.mark.slow
@pytest.mark.parametrize("category", sorted({case.category for case in list_cases()}))
def test_every_file_is_within_all_limits(category, zygote, place):
    runs = [run for run in list_runs() if run.case.category == category]
    check(runs, place, zygote.run)


def test_names_of_files_reach_the_command(zygote, place):
    """The command lines are right: a good robot in place of the hostile one is accepted."""
    from tests.hostile.description_files import SOLID_LINK, robot
    from tests.hostile.matrix import LIGHT, Case, write_files

    good = robot(SOLID_LINK.format("a"))
    case = Case("URDF", "good", lambda p: write_files(p, {"r.urdf": good}), LIGHT)
    codes = Counter(execute(Run(case, command), place, zygote.run)[0].code for command in LIGHT)
    assert set(codes) <= {0, 1}


@pytest.mark.parametrize("name", SECRETS)
@pytest.mark.parametrize("where", ["out", "err", "file", "zip"])
def test_a_secret_is_found(name, where, place):
    import zipfile

    from tests.hostile.place import Outcome

    outcome = Outcome(2, 0.1, 50, b"", b"a message")
    secret = SECRETS[name].encode()
    if where in ("out", "err"):
        setattr(outcome, where, b"a message: " + secret)
    elif where == "file":
        (place.out / "a.bin").write_bytes(bytes(100) + secret)
    else:
        with zipfile.ZipFile(place.out / "a.zip", "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("b", secret * 100)
    problems = place.find_problems(outcome)
    assert len(problems) == 1
    assert name in problems[0]


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        ({"code": None}, "does not end"),
        ({"code": 3}, "exit code 3"),
        ({"code": -11}, "exit code -11"),
        ({"seconds": 21.0}, "21 s"),
        ({"megabytes": 1001.0}, "1001 MB"),
        ({"err": b"Traceback (most recent call last):"}, "a traceback"),
        ({"err": b""}, "without a message"),
        ({"err": b"a" * 20_001}, "a message of 20001 bytes"),
        ({"err": b"\x1b]0;x\x07"}, "a control character"),
        ({"left": True}, "ran on"),
    ],
)
def test_a_problem_is_found(values, problem, place):
    from tests.hostile.place import Outcome

    usual = {"code": 2, "seconds": 0.1, "megabytes": 50.0, "err": b"a message"}
    assert problem in " ".join(place.find_problems(Outcome(**(usual | values))))


@pytest.mark.parametrize("kind", ["time", "memory", "process", "end"])
def test_what_a_process_uses_is_measured(kind, zygote, place):
    texts = {
        "time": "[x for x in range(3 * 10**7)] and 1",
        "memory": "[bytearray(300 << 20) and 1 for _ in range(20)]",
        "process": "__import__('subprocess').Popen(['sleep', '60']).pid",
        "end": "__import__('os').kill(__import__('os').getpid(), 9)",
    }
    place.clear()
    outcome = zygote.ask({"plain": texts[kind]}, place)
    if kind == "time":
        assert outcome.seconds > 0.3
    elif kind == "memory":
        assert outcome.megabytes > 290
    elif kind == "process":
        assert outcome.left
    else:
        assert outcome.code == -9
