"""The process that expands: what it can do, and what comes of answers that are not as expected."""

import json
import os
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from urdftool import expand
from urdftool.errors import XacroError
from urdftool.source import (
    expansion_channel,
    expansion_child,
    expansion_process,
    limits,
    xacro_hooks,
)

XACRO = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">{}</robot>'
FORKS = pytest.mark.skipif(sys.platform != "linux", reason="the process is a fork on Linux")


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "a.xacro"
    file.write_text(XACRO.format('\n<link name="${1 + 1}"/>'))
    return file


def run_in_process(monkeypatch, work):
    """Replace the expansion by a function, whose result becomes a message of the description."""

    def replacement(run):
        run.files.add_message(str(work(run)))
        return []

    monkeypatch.setattr(xacro_hooks.Run, "expand", replacement)


def _start_program():
    return subprocess.run(["true"], check=True)


def _kill_parent():
    os.kill(os.getppid(), 0)


ATTEMPTS = {
    "read": lambda: os.open("/etc/hostname", os.O_RDONLY),
    "write": lambda: os.open("/tmp/written", os.O_WRONLY | os.O_CREAT),
    "list": lambda: os.listdir("/"),
    "program": _start_program,
    "replace": lambda: os.execv("/bin/true", ["true"]),
    "socket": lambda: socket.socket(),
    "pipe": os.pipe,
    "remove": lambda: os.unlink(__file__),
    "signal": _kill_parent,
}


@FORKS
@pytest.mark.parametrize("name", ATTEMPTS)
def test_the_process_has_no_files_programs_or_network(path, monkeypatch, capfd, name):
    if name in ("signal", "list", "remove") and not _has_landlock():
        pytest.skip("the kernel has no Landlock")

    def work(_):
        try:
            ATTEMPTS[name]()
        except OSError as error:
            return f"refused: {type(error).__name__}"
        return "done"

    run_in_process(monkeypatch, work)
    expand_quietly(path)
    assert "refused: " in capfd.readouterr().err


def expand_quietly(path):
    """Expand; the replaced expansion has no tree to write."""
    try:
        expand(path)
    except XacroError:
        return


def _has_landlock():
    code = "from urdftool.landlock import disable_files_and_network as disable; print(disable())"
    return (
        "True"
        in subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout
    )


@FORKS
def test_the_process_has_no_environment(path, monkeypatch, capfd):
    monkeypatch.setenv("SECRET", "hidden-value")
    run_in_process(monkeypatch, lambda _: dict(os.environ))
    expand_quietly(path)
    assert "{}" in capfd.readouterr().err


@FORKS
def test_a_process_that_is_killed_is_reported_at_its_element(path, monkeypatch):
    def die(run, node, start):
        original(run, node, start)
        os.abort()

    original = expansion_child.RequestedFiles.mark_place
    monkeypatch.setattr(expansion_child.RequestedFiles, "mark_place", die)
    with pytest.raises(XacroError, match="exceeds a limit of the system") as caught:
        expand(path)
    assert caught.value.line == 2


@FORKS
@pytest.mark.parametrize(
    "result",
    [
        None,
        [],
        {},
        {"nodes": [], "encodings": []},
        {"nodes": [[1, "robot", {"a": 1}, 0, 0, 0]]},
        {"nodes": [[1, "robot", {}, 7, 0, 0]]},
        {"nodes": [[1, "robot", {}, 0, 0, 9]]},
        {"nodes": [[1, 3, 5]]},
        {"nodes": []},
        {"nodes": [[0, "robot", {}, 0, 0, 0]]},
        {"nodes": [[2, "robot", {}, 0, 0, 0]]},
        {"nodes": [[1, "robot", {}, -1, 0, 0]]},
        {"nodes": [[1, "robot", {}, 0, -1, 0]]},
        {"nodes": [[1, "robot", {}, 0, 10**30, 0]]},
        {"nodes": [[1, "robot", {}, 0, True, 0]]},
        {"nodes": [[1, "robot", {}, 0, 0, -1]]},
        {"nodes": [[1, "robot", {}, 0, 0, 0], [1, "robot", {}, 0, 0, 0]]},
        {"nodes": [[1, "robot", {}, 0, 0, 0], [2, 99, "text"]]},
        {"nodes": [[1, "robot", {}, 0, 0, 0]], "encodings": ["no-such-encoding"]},
        {"nodes": [[1, "robot", {}, 0, 0, 0]], "encodings": [7]},
        {"nodes": [[1, "robot", {}, 0, 0, 0]], "warnings": [["w", [0, 5, 4, 0]]]},
        {"nodes": [[1, "robot", {}, 0, 0, 0]], "arguments": [["a", 1, [0, 0, 1, 0]]]},
        {"nodes": [[1, "robot", {}, 0, 0, 0]], "included": [{"a": 1}]},
        {"nodes": [[1, "robot", {}, 0, 0, 0]], "stack_table": [[-1]]},
        {"error": "XacroError", "message": ["m"], "path": None},
        {"nodes": "text"},
        {"error": "SystemExit", "message": "m"},
    ],
)
def test_a_result_that_is_not_as_expected_is_an_error(path, monkeypatch, result):
    whole = {"encodings": ["utf-8"], "call_table": [], "stack_table": [[]], "arguments": []}
    whole |= {"warnings": [], "included": []}
    sent = {**whole, **result} if result and "encodings" not in result else result
    piece = json.dumps(sent.pop("nodes", [])).encode() if sent else b""
    if sent:
        sent["pieces"] = [len(piece)]
    monkeypatch.setattr(expansion_child.Writer, "write_result", lambda *_: (sent, [piece]))
    with pytest.raises(XacroError, match="invalid result"):
        expand(path)


@FORKS
def test_an_answer_of_too_many_values_is_not_parsed(path, monkeypatch):
    monkeypatch.setattr(expansion_channel, "MAX_VALUES", 1000)
    monkeypatch.setattr(expansion_child.Writer, "write_result", lambda *_: ([[]] * 2000, []))
    with pytest.raises(XacroError, match="exceeds a limit"):
        expand(path)


@FORKS
def test_a_process_that_sleeps_is_ended(path, monkeypatch):
    monkeypatch.setattr(expansion_process, "PATIENCE", 0.3)
    run_in_process(monkeypatch, lambda _: time.sleep(600))
    with pytest.raises(XacroError, match="exceeds a limit"):
        expand(path)


@FORKS
@pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() == 0, reason="has no limit")
def test_the_process_starts_no_other(path, monkeypatch, capfd):
    run_in_process(monkeypatch, lambda _: os.fork())
    expand_quietly(path)
    assert capfd.readouterr().err == ""


@FORKS
def test_no_request_is_answered_but_those_of_the_list(path, monkeypatch):
    run_in_process(monkeypatch, lambda run: run.files._request("__class__"))
    with pytest.raises(XacroError, match="invalid result"):
        expand(path)


def expand_in_thread(path):
    """Return the result or the error of an expansion beside this thread."""
    found = []

    def work():
        try:
            found.append(expand(path))
        except XacroError as error:
            found.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    return found[0]


def test_a_thread_expands_to_the_same(path):
    assert expand_in_thread(path) == expand(path)


def test_a_thread_reports_the_same_error(path):
    path.write_text(XACRO.format('\n<link name="${nope}"/>'))
    with pytest.raises(XacroError) as caught:
        expand(path)
    assert str(expand_in_thread(path)) == str(caught.value)


ENDLESS = '<xacro:property name="a0" value="${(1, 2)}"/>' + "".join(
    f'<xacro:property name="a{n + 1}" value="${{(a{n}, a{n})}}"/>' for n in range(20)
)


@FORKS
def test_one_step_that_does_not_end_is_ended(path, monkeypatch):
    """The hash of a tuple is computed in one step of Python."""
    monkeypatch.setattr(limits, "TOTAL_SECONDS", 1.0)
    path.write_text(XACRO.format(ENDLESS + '\n<link name="${python.set([(a20,) * 40000])}"/>'))
    with pytest.raises(XacroError, match="more than 1 s of CPU time") as caught:
        expand(path)
    assert caught.value.line == 2


@FORKS
@pytest.mark.parametrize(
    "text",
    [
        '\n<link name="${[[x] * 99999 for x in python.range(999)]}"/>',
        '<xacro:property name="q" value="${[[x] * 99999 for x in python.range(999)]}"/>'
        '\n<link name="a${q}"/>',  # a property is evaluated where it is used
    ],
)
def test_memory_is_limited_by_the_system(path, monkeypatch, text):
    monkeypatch.setattr(limits, "MEMORY", 64 << 20)
    path.write_text(XACRO.format(text))
    with pytest.raises(XacroError, match="memory") as caught:
        expand(path)
    assert caught.value.line == 2


@FORKS
def test_nothing_is_left_of_the_processes(path):
    def count():
        return len(os.listdir("/proc/self/fd"))

    def list_children():
        """Return the processes that this one, or an earlier test in it, started."""
        tasks = Path("/proc/self/task").iterdir()
        return {child for task in tasks for child in (task / "children").read_text().split()}

    before, children = count(), list_children()
    for _ in range(5):
        expand(path)
        expand_in_thread(path)
    assert count() == before
    assert list_children() <= children


def test_messages_are_printed_once_if_the_expansion_starts_again(tmp_path, capfd):
    (tmp_path / "c.yaml").write_text("a: 1\n")
    (tmp_path / "part.xacro").write_text(
        XACRO.format("<link name=\"a${xacro.load_yaml('c.yaml').a}\"/>")
    )
    main = tmp_path / "main.xacro"
    message = """<a b="${xacro.message('hello \\x1b[1m')}"/>"""
    main.write_text(XACRO.format(message + '<xacro:include filename="part.xacro"/>'))
    code = f"import urdftool; urdftool.expand({str(main)!r})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stderr == "hello \\x1b[1m\n"
