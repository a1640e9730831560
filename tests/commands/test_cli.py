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
    monkeypatch.setattr(cli.main, "callback", lambda **_: 1 / 0)
    result = urdftool("lint", "x")
    assert result.code == 3
    assert "bug in urdftool" in result.err
    assert "Traceback" not in result.err
    with pytest.raises(ZeroDivisionError):
        urdftool("--debug", "lint", "x")


@pytest.mark.parametrize(("name", "code"), [("xacro", 2), ("urdftool.absent", 3)])
def test_a_library_of_the_core_that_is_absent_is_no_bug(urdftool, monkeypatch, name, code):
    def fail(**_):
        raise ModuleNotFoundError(f"No module named '{name}'", name=name)

    monkeypatch.setattr(cli.main, "callback", fail)
    result = urdftool("lint", "x")
    assert result.code == code
    assert ("requires the Python module 'xacro'" in result.err) == (code == 2)
    assert ("bug in urdftool" in result.err) == (code == 3)


def test_ctrl_c_is_exit_code_130():
    import fcntl
    import struct
    import termios

    process = subprocess.Popen(
        [sys.executable, "-m", "urdftool", "expand", "-"],
        stdin=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    process.stdin.write(b"<robot")
    process.stdin.flush()
    while struct.unpack("i", fcntl.ioctl(process.stdin, termios.FIONREAD, bytes(4)))[0]:
        time.sleep(0.01)  # until it reads
    process.send_signal(signal.SIGINT)
    err = process.stderr.read().decode()
    process.stdin.close()
    process.wait()
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
    assert err == "urdftool: standard output was closed before all output was written\n"


@pytest.mark.skipif(sys.platform == "win32", reason="needs a shell")
@pytest.mark.parametrize("words", ["lint --list-rules", "expand r.urdf"])
def test_a_pipe_that_nobody_reads_is_no_verdict(write, words):
    write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    ours, theirs = os.pipe()
    os.close(ours)
    done = subprocess.run(
        [sys.executable, "-m", "urdftool", *words.split()], stdout=theirs, stderr=subprocess.PIPE
    )
    os.close(theirs)
    assert done.returncode == 2
    assert done.stderr == b"urdftool: standard output was closed before all output was written\n"


@pytest.mark.skipif(sys.platform == "win32", reason="needs a shell")
@pytest.mark.parametrize("closed", ["<&-", ">&-", "2>&-", "<&- >&-", "<&- >&- 2>&-"])
@pytest.mark.parametrize(("words", "code"), [("expand r.urdf", 0), ("lint r.urdf", 1), ("no", 2)])
def test_closed_streams_leave_the_exit_code(write, closed, words, code):
    write("r.urdf", '<robot name="r"><link name="a"/><link name="b"/></robot>')
    line = f"'{sys.executable}' -m urdftool {words} {closed}"
    done = subprocess.run(line, shell=True, capture_output=True, text=True)
    assert done.returncode == code
    assert "Traceback" not in done.stderr


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device without room")
@pytest.mark.parametrize("words", ["expand none.urdf", "no"])
def test_a_message_without_room_leaves_the_exit_code(tmp_path, words):
    with open("/dev/full", "w") as full:
        done = subprocess.run([sys.executable, "-m", "urdftool", *words.split()], stderr=full)
    assert done.returncode == 2


def test_too_little_memory_is_said(urdftool, monkeypatch):
    monkeypatch.setattr(cli.main, "main", _fail(MemoryError()))
    result = urdftool("expand", "r.urdf")
    assert (result.code, result.err) == (2, "urdftool: not enough memory for this command\n")


def test_a_thread_at_work_is_left_without_a_word():
    """Libraries that are cut off in the midst of a call complain, each in its own way."""
    line = (
        "import atexit, threading, time; atexit.register(print, 'cut off'); "
        "threading.Thread(target=time.sleep, args=(60,), daemon=True).start(); "
        "from urdftool import cli; cli.run(['lint', '--explain', 'mesh-not-found'])"
    )
    done = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True, timeout=30)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout
    assert "cut off" not in done.stdout


def _fail(error):
    def fail(*_, **__):
        raise error

    return fail


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


def test_what_follows_two_dashes_is_not_an_option(urdftool, write):
    write("-q", '<robot name="r"><link name="a"/></robot>')
    result = urdftool("info", "--", "-q")
    assert (result.code, result.err) == (0, "")
    assert "r" in result.out
    assert urdftool("info", "--", "--debug").err == "--debug: no such file\n"


def test_the_value_of_another_option_is_not_an_option(urdftool, write):
    path = write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    result = urdftool("expand", path, "-o", "-v")
    assert result.code == 0
    assert Path("-v").exists()


@pytest.mark.parametrize("line", ["inertia box -q --mass 1 --size 1 1 1", "inertia -q sphere"])
def test_commands_below_a_command_accept_them_too(urdftool, line):
    words = [*line.split(), "--mass", "1", "--radius", "1"] if "sphere" in line else line.split()
    result = urdftool(*words)
    assert (result.code, result.err) == (0, "")


def test_the_version_with_v_is_what_a_bug_report_needs(urdftool):
    for words in (("--version", "-v"), ("-v", "--version")):
        lines = urdftool(*words).out.splitlines()
        assert lines[0] == f"urdftool {__version__}"
        assert lines[1].startswith("Python 3.")
        for name in ("core: click ", "[mesh]: scipy ", "[draw]: ", "[simulate]: ", "[mujoco]: "):
            assert any(line.startswith(name) for line in lines), name


def test_no_command_is_not_an_error_message(urdftool):
    result = urdftool()
    assert result.code == 2
    assert result.err.startswith("Usage: urdftool")


def test_an_interrupted_import_is_no_bug(urdftool, monkeypatch):
    def interrupted(*words, **options):
        raise RuntimeError("Error calling __set_name__") from KeyboardInterrupt()

    monkeypatch.setattr(cli.main, "main", interrupted)
    result = urdftool("info", "r.urdf")
    assert result.code == 130
    assert result.err == "urdftool: stopped\n"
