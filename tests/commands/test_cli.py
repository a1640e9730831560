import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from urdftool import __version__, cli

COMMANDS = cli.COMMANDS


def test_version(urdftool):
    assert urdftool("--version").out == f"urdftool {__version__}\n"


@pytest.mark.parametrize("command", [(), *((name,) for name in COMMANDS)])
def test_help_is_complete(urdftool, command):
    result = urdftool(*command, "--help")
    assert result.code == 0
    assert "Usage: urdftool" in result.out
    for line in result.out.splitlines():
        assert len(line) <= 100


@pytest.mark.parametrize("command", COMMANDS)
def test_every_option_says_what_it_does(command):
    import click

    found = cli.main.get_command(click.Context(cli.main), command)
    below = [found]
    if isinstance(found, click.Group):
        context = click.Context(found)
        below += [found.get_command(context, name) for name in found.list_commands(context)]
    for one in below:
        for parameter in one.params:
            if isinstance(parameter, click.Option):
                assert parameter.help, f"{one.name} {parameter.name}"


def test_a_mistyped_command_is_recognised(urdftool):
    result = urdftool("expnd")
    assert result.code == 2
    assert "did you mean 'expand'?" in result.err


def test_no_command_shows_the_help(urdftool):
    assert "Commands" in urdftool().out + urdftool().err


def test_a_bug_is_a_message_and_exit_code_3(urdftool, monkeypatch):
    monkeypatch.setattr(cli.main, "main", lambda *_, **__: 1 / 0)
    result = urdftool("lint", "x")
    assert result.code == 3
    assert "bug in urdftool" in result.err
    assert "Traceback" not in result.err
    with pytest.raises(ZeroDivisionError):
        urdftool("--debug", "lint", "x")


def test_ctrl_c_is_exit_code_130(tmp_path):
    fifo = tmp_path / "slow.urdf"
    os.mkfifo(fifo)
    process = subprocess.Popen(
        [sys.executable, "-m", "urdftool", "expand", str(fifo)], stderr=subprocess.PIPE, text=True
    )
    time.sleep(0.6)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=10)
    assert process.returncode == 130
    assert "Traceback" not in err


def test_a_closed_pipe_is_one_line(tmp_path):
    robot = tmp_path / "many.urdf"
    links = "".join(f'<link name="l{i}"/>' for i in range(20_000))
    robot.write_text(f'<robot name="r">{links}</robot>')
    process = subprocess.Popen(
        [sys.executable, "-m", "urdftool", "expand", str(robot)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    process.stdout.read(10)
    process.stdout.close()
    err = process.stderr.read().decode()
    assert process.wait(timeout=10) == 2
    assert err == "urdftool: standard output was closed before all was written\n"


def test_colours_are_as_asked(urdftool, write):
    path = write("r.urdf", "<robot/>")
    assert "\x1b[" not in urdftool("lint", path).out
    assert "\x1b[" in urdftool("--color", "always", "lint", path).out
    assert "\x1b[" not in urdftool("--color", "never", "lint", path).out


def test_colours_follow_the_environment(urdftool, write, monkeypatch):
    path = write("r.urdf", "<robot/>")
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert "\x1b[" in urdftool("lint", path).out
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b[" not in urdftool("lint", path).out
    monkeypatch.delenv("NO_COLOR")
    assert urdftool("lint", path, "--output-file", "out.txt").code == 1
    assert "\x1b[" not in Path("out.txt").read_text()


@pytest.mark.parametrize("where", [("-q", "lint", "r.urdf"), ("lint", "r.urdf", "-q")])
def test_options_of_urdftool_may_stand_anywhere(urdftool, write, where):
    write("r.urdf", "<robot/>")
    assert urdftool("lint", "r.urdf").err != ""
    assert urdftool(*where).err == ""


def test_an_interrupted_import_is_no_bug(urdftool, monkeypatch):
    def interrupted(*words, **options):
        raise RuntimeError("Error calling __set_name__") from KeyboardInterrupt()

    monkeypatch.setattr(cli.main, "main", interrupted)
    result = urdftool("info", "r.urdf")
    assert result.code == 130
    assert result.err == "urdftool: stopped\n"
