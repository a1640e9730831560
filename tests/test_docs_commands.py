"""Every command that help and documentation show can be typed as it is shown."""

import re
import shlex
import shutil
import signal
import subprocess
import sys
from importlib.util import find_spec

import click
import pytest
from generator.console import list_pages

from tests import stand_ins
from tests.conftest import ROOT
from urdftool import cli

CODE = re.compile(r"```sh\n(.*?)```|((?:^ {4,}urdftool [^\n]*\n)+)", re.DOTALL | re.MULTILINE)
SLOW = ("collision", "simulate", "mjcf", "graph", "view")
LASTING = ("view",)  # until Ctrl-C, where it draws no picture


def shown_in(text):
    """The commands in blocks of code: those of ``sh``, and indented ones."""
    for fenced, indented in CODE.findall(text):
        for line in (fenced or indented).replace("\\\n", " ").splitlines():
            command = line.strip().removeprefix("$ ").partition("  #")[0]
            if command.startswith("urdftool "):
                yield " ".join(command.split())


def helps(command, context):
    """The command's help, and those of the commands in it."""
    yield command.help or ""
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            yield from helps(command.get_command(context, name), context)


def all_shown():
    """Every command that is shown, with where it is."""
    found = {}
    for text in helps(cli.main, click.Context(cli.main)):
        for line in text.splitlines():
            if line.strip().startswith("urdftool "):
                found.setdefault(line.strip(), "help")
    for page in list_pages():
        for command in shown_in(page.read_text("utf-8")):
            found.setdefault(command, str(page.relative_to(ROOT)))
    return found


SHOWN = all_shown()


def is_lasting(words):
    pictures = ("--picture", "--contact-sheet")
    return words[1] in LASTING and not any(word in pictures for word in words)


def commands(lasting):
    found = []
    for command, where in SHOWN.items():
        words = shlex.split(command)
        if is_lasting(words) == lasting:
            slow = lasting or any(word in SLOW for word in words[1:3])
            marks = [pytest.mark.slow] if slow else []
            found.append(pytest.param(words, id=f"{where}: {command}", marks=marks))
    return found


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return stand_ins.make(tmp_path_factory.mktemp("stand_ins"))


def needed(words):
    """The library that a command needs and that is not everywhere."""
    if "simulate" in words[:2] and "mujoco" not in words:
        return "pybullet"
    if ("mjcf" in words and "--verify" in words) or any(word.endswith(".xml") for word in words):
        return "mujoco"
    if any(word.endswith(".usda") for word in words):
        return "pxr"
    return "viser" if is_lasting(words) else "click"


def test_there_are_commands():
    assert len(SHOWN) > 50


@pytest.mark.parametrize("words", commands(lasting=False))
def test_it_can_be_typed(words, made, tmp_path, monkeypatch, urdftool):
    if find_spec(needed(words)) is None:
        pytest.skip(f"it needs {needed(words)}")
    here = tmp_path / "here"
    shutil.copytree(made, here)
    monkeypatch.chdir(here)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(here / "packages"))
    result = urdftool(*words[1:])
    assert result.code in (0, 1), result.err


@pytest.mark.parametrize("words", commands(lasting=True))
def test_it_serves_until_it_is_stopped(words, made):
    if find_spec(needed(words)) is None:
        pytest.skip(f"it needs {needed(words)}")
    words = [word for word in words if word != "--open"]  # there may be no browser
    process = subprocess.Popen(
        [sys.executable, "-m", *words], cwd=made, stdout=subprocess.PIPE, text=True
    )
    try:
        assert "http://127.0.0.1:" in process.stdout.readline()
        process.send_signal(signal.SIGINT)
        assert process.wait(20) in (130, -signal.SIGINT)
    finally:
        process.kill()
