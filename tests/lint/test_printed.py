"""A run of which nothing changed is printed again; any change is seen."""

import json
import os
from functools import partial

import pytest

from tests.conftest import FIXTURES
from urdftool import dependencies
from urdftool.commands import lint
from urdftool.lint import outcome
from urdftool.storage import DiskCache, cache_folder

MESH = '<visual><geometry><mesh filename="a.stl"/></geometry></visual>'
ROBOT = f'<robot name="r"><link name="a">{MESH}</link></robot>'
WRONG = '<robot name="r"><link name="a"/><joint name="j" type="fixed"/></robot>'


@pytest.fixture
def run(urdftool, monkeypatch):
    monkeypatch.setattr(dependencies, "_FRESH_NS", 0)
    return partial(urdftool, "lint")


@pytest.fixture
def no_run(monkeypatch):
    """From its call on, a run that is not printed again is an error."""

    def stop():
        def refuse(*_, **__):
            raise AssertionError("the run was repeated")

        monkeypatch.setattr(lint, "_check_paths", refuse)

    return stop


def list_stored():
    """Return the keys of the stored runs."""
    store = DiskCache(cache_folder("lint"))
    keys = [path.name for path in cache_folder("lint").rglob("*") if len(path.name) == 64]
    return [key for key in keys if "texts" in json.loads(store.get(key))]


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["--format", "json"],
        ["--format", "concise", "--statistics"],
        ["--format", "github", "--fail-on", "info"],
        ["--select", "mesh", "--exit-zero"],
        ["--target", "gz", "--all", "-v"],
        ["-q", "--jobs", "1"],
    ],
    ids=" ".join,
)
def test_an_unchanged_run_is_printed_again(run, write, no_run, words):
    paths = write("r.urdf", ROBOT), write("s.urdf", WRONG)
    quiet = [word for word in words if word in ("-q", "-v")]
    first = run(*quiet, *paths, *(word for word in words if word not in quiet))
    no_run()
    assert run(*quiet, *paths, *(word for word in words if word not in quiet)) == first
    assert first.code in (0, 1)


def test_the_order_of_streams_is_kept(run, write, no_run):
    path = write("r.urdf.xacro", ROBOT)
    first = run(path, "no_such:=1", "--select", "mesh-not-found,zero-axes", "--ignore", "inertia")
    assert first.code == 2  # an unknown rule
    first = run(path, "no_such:=1")
    assert "no_such" in first.err
    no_run()
    assert run(path, "no_such:=1") == first


CHANGES = {
    "a mesh comes": lambda write: write("a.stl", b"\0" * 84),
    "the robot": lambda write: write("r.urdf", WRONG),
    "another configuration": lambda write: write("urdftool.toml", "[lint]\nignore = ['mesh']\n"),
    "a nearer one": lambda write: write(".urdftool.toml", "[lint]\nselect = ['mesh']\n"),
    "a package": lambda write: write("package.xml", "<package><name>p</name></package>"),
    "no robot": lambda write: os.unlink("r.urdf"),
    "a link": lambda write: (os.rename("r.urdf", "t.urdf"), os.symlink("t.urdf", "r.urdf")),
    "another target of the link": lambda write: (
        os.unlink("q.urdf"),
        os.symlink(write("o.urdf", WRONG), "q.urdf"),
    ),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_change_is_seen(run, write, name):
    write("pyproject.toml", "")
    paths = [write("r.urdf", ROBOT), "q.urdf"]
    os.symlink("r.urdf", "q.urdf")
    for path in paths:
        before = run(path)
        assert run(path) == before
    CHANGES[name](write)
    for path in paths:
        after = run(path)
        assert after == run(path, "--no-cache")
        assert run(path) == after


@pytest.mark.parametrize(
    "words",
    [
        *(["--format", "concise"], ["--fail-on", "error"], ["--statistics"], ["-p", "x=."]),
        *(["--ignore", "mesh"], ["n:=1"], ["--color", "always"], ["--gltf-up", "z"]),
    ],
    ids=" ".join,
)
def test_other_options_are_other_runs(urdftool, write, no_run, words):
    path = write("r.urdf", ROBOT)
    general = words if words[0] == "--color" else []
    last = [] if general else words
    urdftool("lint", path)
    no_run()
    urdftool("lint", path)
    assert urdftool(*general, "lint", path, *last).code == 3


@pytest.mark.parametrize(
    "words",
    [
        *(["--no-cache"], ["--no-expand"], ["--junit", "j.xml"], ["--output-file", "o.txt"]),
        *(["--write-baseline", "b.json"], ["--diff"], ["--list"], ["--format", "html"]),
        ["--explain-targets"],
    ],
    ids=" ".join,
)
def test_runs_with_other_inputs_or_outputs_are_not_stored(urdftool, write, words):
    path = write("r.urdf", ROBOT)
    urdftool("lint", path, *words)
    assert not list_stored()


@pytest.mark.parametrize("path", [".", "absent.urdf", "m.sdf"])
def test_folders_and_robots_that_have_no_report_in_the_cache_are_not_stored(run, write, path):
    write("r.urdf", ROBOT)
    write("m.sdf", "<sdf version='1.9'><model name='m'><link name='a'/></model></sdf>")
    first = run(path)
    assert not list_stored()
    assert run(path) == first


def test_reports_of_workers_are_stored(run, write, no_run):
    paths = [write(f"{number}.urdf", ROBOT) for number in range(3)]
    first = run(*paths, "-j", "2")
    no_run()
    assert run(*paths) == first


FORGED = {
    "nothing": {},
    "no query": {"rows": [], "code": 0, "texts": [["stdout", "forged"]]},
    "a number": {"code": 0, "texts": [["stdout", 7]]},
    "one word": {"code": 0, "texts": ["stdout"]},
    "a surrogate": {"code": 0, "texts": [["stdout", "forged\ud800"]]},
    "the code of a bug": {"code": 3, "texts": [["stdout", "forged"]]},
    "a truth": {"code": True, "texts": [["stdout", "forged"]]},
    "no code": {"texts": [["stdout", "forged"]]},
}


@pytest.mark.parametrize("name", FORGED)
def test_a_damaged_entry_counts_as_absent(run, write, name):
    path = write("r.urdf", WRONG)
    first = run(path)
    (key,) = list_stored()
    whole = json.loads(DiskCache(cache_folder("lint")).get(key))
    forged = {"rows": whole["rows"], **FORGED[name]} if FORGED[name] else {}
    DiskCache(cache_folder("lint")).put(key, json.dumps(forged).encode())
    assert run(path) == first


def test_a_file_that_changes_during_the_run_is_not_stored(run, write, monkeypatch):
    path = write("r.urdf", ROBOT)
    gather = outcome.Report.checked.fget

    def change(report):
        write("r.urdf", WRONG)
        return gather(report)

    with monkeypatch.context() as patch:
        patch.setattr(outcome.Report, "checked", property(change))
        run(path)
    assert run(path) == run(path, "--no-cache")


def test_real_robots_are_printed_again(run, no_run, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    robots = sorted((FIXTURES / "robots").glob("*.urdf"))[::6]
    first = run(*robots)
    no_run()
    assert run(*robots) == first
