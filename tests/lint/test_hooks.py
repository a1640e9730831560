"""The hooks, under the real pre-commit, in a scratch repository; and what the docs show of them."""

import json
import re
import shutil
import subprocess
import sys
from importlib.resources import files
from pathlib import Path

import jsonschema
import pytest
import yaml

from tests.conftest import FIXTURES, ROOT, XACRO

PRE_COMMIT = shutil.which("pre-commit", path=str(Path(sys.executable).parent))
PAGE = (ROOT / "docs" / "adopting.md").read_text("utf-8")
HOOKS_OF_PAGE, WORKFLOW_OF_PAGE = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)


def real(function):
    """Wants pre-commit, and a checkout that it can clone."""
    for condition, reason in (
        (PRE_COMMIT is None, "pre-commit is not installed"),
        (not (ROOT / ".git").exists(), "pre-commit wants a git checkout"),
    ):
        function = pytest.mark.skipif(condition, reason=reason)(function)
    return pytest.mark.slow(function)


CONFIGURATION = """repos:
- repo: {repository}
  rev: {revision}
  hooks:
  - id: urdftool-lint
  - id: urdftool-lint-errors
  - id: urdftool-lint-fix
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


def head():
    return run("git", "-C", str(ROOT), "rev-parse", "HEAD").stdout.strip()


@pytest.fixture
def repository(write):
    """A repository with a xacro file, what it expands to, and the hooks of this checkout's HEAD."""
    revision = head()
    write("arm.urdf.xacro", XACRO.format('<link name="a"/>'))
    run(sys.executable, "-m", "urdftool", "expand", "arm.urdf.xacro", "-o", "arm.urdf")
    write(
        ".pre-commit-config.yaml",
        CONFIGURATION.format(repository=ROOT.as_posix(), revision=revision),
    )
    run("git", "init", "--quiet")


@real
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

    crooked = (
        '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="Continuous">'
        '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit effort="1" velocity="1"/>'
        "</joint></robot>\n"
    )
    write("bad.urdf", crooked)
    done = hook("urdftool-lint-fix")
    assert done.returncode == 1
    assert "files were modified by this hook" in done.stdout
    assert Path("bad.urdf").read_text() == crooked.replace("Continuous", "continuous")
    done = hook("urdftool-lint-fix")
    assert done.returncode == 0, done.stdout

    write("arm.urdf.xacro", XACRO.format('<link name="b"/>'))
    done = hook("urdftool-expand-check")
    assert done.returncode == 1
    assert "arm.urdf: is outdated" in done.stdout


@real
def test_the_hooks_of_the_page_run_in_a_repository_that_had_none(write):
    """As docs/adopting.md has it: a baseline of what is there, the hooks, the commands."""
    shutil.copytree(FIXTURES / "robots" / "laser_bot", "laser_bot")
    write("urdf/arm.urdf.xacro", XACRO.format('<link name="a"/>'))
    tool = [sys.executable, "-m", "urdftool"]
    run(*tool, "expand", "urdf/arm.urdf.xacro", "-o", "urdf/arm.urdf")
    run(*tool, "lint", ".", "--write-baseline", "urdftool-baseline.json")
    shown = HOOKS_OF_PAGE.replace("https://github.com/urdftool/urdftool", ROOT.as_posix())
    write(".pre-commit-config.yaml", shown.replace("v0.1.0", head()))
    run("git", "init", "--quiet")
    (commands,) = re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL)
    run("git", "add", "--all")
    for command in commands.splitlines():
        words = command.split()
        done = run(shutil.which(words[0], path=str(Path(PRE_COMMIT).parent)), *words[1:])
        assert done.returncode == 0, done.stdout + done.stderr

    person = ("-c", "user.name=a", "-c", "user.email=a@b.c")
    assert run("git", *person, "commit", "-qm", "first").returncode == 0
    robot = Path("laser_bot/urdf/laser_bot_as_taught.urdf.xacro")
    robot.write_text(robot.read_text().replace("<limit effort", "<limit efort"))
    done = run("git", *person, "commit", "-qam", "second")
    assert done.returncode == 1
    assert "has the unknown attribute 'efort'; write effort" in done.stderr


def test_the_workflow_of_the_page_is_one():
    workflow = yaml.load(WORKFLOW_OF_PAGE, Loader=yaml.BaseLoader)
    vendored = files("check_jsonschema") / "builtin_schemas/vendor/github-workflows.json"
    schema = json.loads(vendored.read_text())
    validator = jsonschema.validators.validator_for(schema)(schema)
    assert [error.message for error in validator.iter_errors(workflow)] == []
    inputs = yaml.safe_load((ROOT / "action.yml").read_text("utf-8"))["inputs"]
    (step,) = [s for s in workflow["jobs"]["lint"]["steps"] if "urdftool" in s["uses"]]
    assert set(step["with"]) <= set(inputs)
    shown = re.findall(r"^\| `([\w-]+)` \|.*\|.*\|$", PAGE.partition("| input")[2], re.MULTILINE)
    assert sorted(shown) == sorted(inputs)


def test_every_hook_is_on_the_page():
    hooks = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
    for hook in hooks:
        assert f"| `{hook['id']}` |" in PAGE
