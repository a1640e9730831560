"""The hooks, under the real pre-commit, in a scratch repository."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT, XACRO

PRE_COMMIT = shutil.which("pre-commit", path=str(Path(sys.executable).parent))

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(PRE_COMMIT is None, reason="pre-commit is not installed"),
    pytest.mark.skipif(not (ROOT / ".git").exists(), reason="pre-commit wants a git checkout"),
]

CONFIGURATION = """repos:
- repo: {repository}
  rev: {revision}
  hooks:
  - id: urdftool-lint
  - id: urdftool-lint-errors
  - id: urdftool-expand-check
    args: [arm.urdf, arm.urdf.xacro]
"""
GOOD = '<robot name="r"><link name="a"/></robot>\n'
BAD = '<robot><link name="a"/></robot>\n'


def run(*words):
    return subprocess.run(words, capture_output=True, text=True, check=False)


def hook(name):
    run("git", "add", "--all")
    return run(PRE_COMMIT, "run", name, "--all-files", "--verbose")


@pytest.fixture
def repository(write):
    """A repository with a xacro file, what it expands to, and the hooks of this checkout's HEAD."""
    revision = run("git", "-C", str(ROOT), "rev-parse", "HEAD").stdout.strip()
    write("arm.urdf.xacro", XACRO.format('<link name="a"/>'))
    run(sys.executable, "-m", "urdftool", "expand", "arm.urdf.xacro", "-o", "arm.urdf")
    write(
        ".pre-commit-config.yaml",
        CONFIGURATION.format(repository=ROOT.as_posix(), revision=revision),
    )
    run("git", "init", "--quiet")


def test_hooks_pass_what_is_right_and_stop_what_is_wrong(repository, write):
    write("good.urdf", GOOD)
    for name in ("urdftool-lint", "urdftool-lint-errors", "urdftool-expand-check"):
        done = hook(name)
        assert done.returncode == 0, done.stdout + done.stderr
        assert "Passed" in done.stdout

    write("bad.urdf", BAD)
    done = hook("urdftool-lint")
    assert done.returncode == 1
    assert "bad.urdf:1:1: error: " in done.stdout
    assert hook("urdftool-lint-errors").returncode == 1

    write("arm.urdf.xacro", XACRO.format('<link name="b"/>'))
    done = hook("urdftool-expand-check")
    assert done.returncode == 1
    assert "arm.urdf: is stale" in done.stdout
