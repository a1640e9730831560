"""What a check reads is what its cached report depends on."""

import ast
import json
import subprocess
import sys

import pytest

from tests.conftest import FIXTURES, ROOT

PROBE = """
import json, os, sys
from urdftool.lint.options import Options
from urdftool.lint import run
from urdftool.lint.settings import Settings
from urdftool.lint.cache import Cache

heard = None

def hook(event, arguments):
    if heard is not None and event in ("open", "os.listdir", "os.scandir"):
        code = sys._getframe(1).f_code.co_filename
        path = arguments[0]
        if not code.startswith("<frozen importlib") and isinstance(path, (str, bytes, os.PathLike)):
            heard.add(("list" if "dir" in event else "file", os.path.abspath(os.fsdecode(path))))

class Kept(Cache):
    def __init__(self):
        pass
    def get_key(self, *question):
        return ""
    def write(self, key, report, read):
        asked = [question for part in (read, *read.shared) for question in part.stamps]
        self.read = {("list" if kind == "code" else kind, path) for kind, path in asked}

sys.addaudithook(hook)
check = run._check_variant

def checked(*question):  # what is read before is part of the key
    global heard, found
    heard = set()
    report = check(*question)
    heard, found = None, heard
    return report

run._check_variant = checked
cache = Kept()
missed = {}
for path in sys.argv[1:]:
    options = Options(Settings(select=("all",)), fixes=True, cache=cache)
    run.check_file(path, options)
    own = (sys.prefix, sys.base_prefix, os.path.dirname(os.path.dirname(run.__file__)))
    found.discard(("list", os.getcwd()))  # which the import of a library lists
    left = sorted(q for q in found - cache.read if not q[1].startswith(own))
    if left:
        missed[path] = left
print(json.dumps([missed, len(cache.read)]))
"""


STEP = 5
"""Of so many robots of rules one is checked by default; the slow test checks all."""


@pytest.mark.parametrize("step", [STEP, pytest.param(1, marks=pytest.mark.slow)])
def test_all_that_is_opened_or_listed_is_a_dependency(step):
    robots = [
        *sorted(FIXTURES.glob("robots/**/*.urdf*")),
        *sorted(FIXTURES.glob("rules/*/bad*.urdf"))[::step],
        *sorted(FIXTURES.glob("rules/*/*/**/*.urdf.xacro"))[::step],
    ]
    done = subprocess.run(
        [sys.executable, "-c", PROBE, *map(str, robots)], capture_output=True, text=True, cwd=ROOT
    )
    missed, count = json.loads(done.stdout or "[0, 0]")
    assert (missed, done.stderr) == ({}, "")
    assert count > 0


# Those that look at files which no report depends on, and data of the package.
OF_PROCESSES = {
    ("source/access.py", "environ"),
    ("source/expansion_child.py", "environ"),  # of the process that expands: emptied
    ("source/expansion_process.py", "environ"),
    ("source/expansion_server.py", "environ"),
}
"""Modules that use the environment of processes, which no description reads."""

OTHERS = {
    *(
        "lint/baseline.py",
        "lint/installed_code.py",
        "lint/discover.py",
        "lint/group.py",
        "lint/effect_kinds.py",
    ),
    *("lint/changes.py", "lint/launches.py", "lint/robot_search.py"),
    *("lint/settings.py", "lint/skipped.py", "lint/stale.py", "lint/variants.py", "lint/watch.py"),
    "model/files.py",
    "model/sdf_schema.py",
}
# Those that open what `Workspace.materialize` gave.
LOCAL = {"rules/file_rewrites.py", "rules/mesh/scale.py", "rules/mesh/files.py"}
OF_OS = {
    *("stat", "lstat", "scandir", "listdir", "walk", "readlink", "getenv", "environ", "access"),
    *("exists", "isfile", "isdir", "islink", "lexists", "realpath", "getsize", "getmtime"),
    *("samefile", "ismount"),
}
OF_PATHS = {
    "read_bytes",
    "read_text",
    "is_file",
    "is_dir",
    "is_symlink",
    "iterdir",
    "rglob",
    "glob",
}


@pytest.mark.parametrize("room", ["source", "model", "rules", "lint", "configuration.py"])
def test_files_are_read_through_the_workspace(room):
    package = ROOT / "urdftool"
    place = package / room
    for path in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
        name = path.relative_to(package).as_posix()
        if name in OTHERS:
            continue
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            where = f"{name}:{getattr(node, 'lineno', 0)}"
            if isinstance(node, ast.Attribute):
                holder = ast.unparse(node.value)
                if holder in ("os", "os.path") and node.attr in OF_OS:
                    assert (name, node.attr) in OF_PROCESSES, where
                elif node.attr in OF_PATHS and name not in LOCAL:
                    assert holder.rpartition(".")[2] in ("workspace", "files"), where
            elif isinstance(node, ast.Call) and ast.unparse(node.func) == "open":
                assert name in LOCAL, where
