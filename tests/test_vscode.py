"""The extension of VS Code: what it starts exists; it builds where its packages are installed."""

import json
import os
import re
import shutil
import subprocess

import pytest

from tests.conftest import ROOT
from urdftool import __version__, cli

FOLDER = ROOT / "editors" / "vscode"
PACKAGE = json.loads((FOLDER / "package.json").read_text("utf-8"))
NPM = shutil.which("npm")  # tests see few programs
SOURCE = "\n".join(path.read_text("utf-8") for path in sorted((FOLDER / "src").glob("*.ts")))


def test_its_commands_are_those_that_the_source_registers():
    declared = {one["command"] for one in PACKAGE["contributes"]["commands"]}
    assert declared == set(re.findall(r'registerCommand\("([\w.]+)"', SOURCE))


def test_its_settings_are_those_that_the_source_reads():
    declared = set(PACKAGE["contributes"]["configuration"]["properties"])
    read = {f"urdftool.{name}" for name in re.findall(r'settings\.get\("(\w+)"', SOURCE)}
    assert declared == read | {"urdftool.trace.server"}  # which vscode-languageclient reads


def test_it_starts_commands_and_options_that_exist():
    assert '"server"' in SOURCE
    view = cli.main.get_command(None, "view")
    lint = cli.main.get_command(None, "lint")
    options = {name for command in (view, lint) for one in command.params for name in one.opts}
    assert set(re.findall(r'"(--[a-z-]+)"', SOURCE)) <= options


def test_it_has_the_version_of_the_tool():
    assert PACKAGE["version"] == __version__
    lock = json.loads((FOLDER / "package-lock.json").read_text("utf-8"))
    assert lock["version"] == __version__


@pytest.mark.slow
@pytest.mark.parametrize("script", ["build", "test"])
def test_it_builds(script):
    if NPM is None:
        pytest.skip("it needs npm")
    if not (FOLDER / "node_modules").is_dir():
        pytest.skip("it needs the packages of 'npm ci' in editors/vscode")
    variables = {**os.environ, "PATH": os.pathsep.join((os.path.dirname(NPM), "/usr/bin", "/bin"))}
    words = [NPM, "run", "--silent", script]
    done = subprocess.run(words, cwd=FOLDER, env=variables, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
