"""Entries of caches that others wrote: foreign ones count as absent, and nothing in them runs."""

import json
import os
import shutil
import sys

import pytest

from tests.hostile.writers import robot
from urdftool.storage import DiskCache, join_parts

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs links and pipes")

COMMANDS = {
    "lint": (["lint", "r.urdf", "--exit-zero"], "lint"),
    "collision": (
        ["collision", "mesh", "cube.obj", "--method", "hull", "--format", "json"],
        "collision",
    ),
    "mjcf": (["export", "mjcf", "r.urdf", "--force", "-o", "out", "--overwrite"], "mjcf-meshes"),
    "simulate": (
        ["simulate", "r.urdf", "--engine", "mujoco", "--duration", "0.1", "--format", "json"],
        "simulate",
    ),
}
SLOW = ("collision", "mjcf", "simulate")


def _nest(depth):
    return b"[" * depth + b"]" * depth


FORGED = {
    "pickle": b"cos\nsystem\n(S'touch PWNED'\ntR.",
    "empty": b"",
    "numbers": b"[1,2,3]",
    "NaN": b'{"unit":[NaN,[NaN,0,0],[0,0,0,0,0,0]],"box":[[0,0,0],[0,0,0]],"notes":[]}',
    "deep": _nest(100_000),
    "digits": b"9" * 10_000,
    "surrogate": b'{"method":"\\ud800","pieces":[{"kind":"\\ud800"}]}',
    "parts": join_parts({"pieces": [{}], "parts": [{}]}, [b"\0" * 24, b"\xff" * 12]),
    "head": join_parts(7, [b"\0" * 24, b"\xff" * 12]),
    "no points": join_parts(None, [b"", b"\1\0\0\0" * 3]),
    "zip": b"PK\3\4" + bytes(60),
}


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.slow if n in SLOW else ()) for n in COMMANDS]
)
def test_forged_entries_count_as_absent(name, tmp_path, monkeypatch, urdftool):
    command, kind = COMMANDS[name]
    robot(tmp_path / "r")
    monkeypatch.chdir(tmp_path / "r")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    cache = DiskCache(tmp_path / "cache" / "urdftool" / kind)
    first = urdftool(*command)
    keys = [path.name for path in (tmp_path / "cache").rglob("*") if len(path.name) == 64]
    assert keys
    for label, data in FORGED.items():
        for key in keys:
            cache.put(key, data)
        again = urdftool(*command)
        assert (label, clean(again)) == (label, clean(first))
        assert not os.path.exists("PWNED")
    for make in (os.mkfifo, os.mkdir, lambda path: os.symlink("/dev/zero", path)):
        for key in keys:
            path = tmp_path / "cache" / "urdftool" / kind / key[:2] / key
            shutil.rmtree(path) if path.is_dir() else path.unlink()
            make(path)
        assert clean(urdftool(*command)) == clean(first)


def clean(result):
    """Return exit code and output, without times."""
    try:
        table = json.loads(result.out)
    except ValueError:
        return result.code, result.out
    return result.code, json.dumps(drop_times(table))


def drop_times(value):
    if isinstance(value, dict):
        return {k: drop_times(v) for k, v in value.items() if "seconds" not in k and k != "wall"}
    return [drop_times(item) for item in value] if isinstance(value, list) else value
