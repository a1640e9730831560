"""Questions at a terminal, through a pseudo-terminal."""

import os
import select
import subprocess
import sys
import time

import pytest

pty = pytest.importorskip("pty")

COMMAND = [sys.executable, "-m", "urdftool", "inertia"]


def converse(arguments, answers):
    """Run a command at a terminal; each answer is typed once its question is seen."""
    main, side = pty.openpty()
    process = subprocess.Popen(
        [*COMMAND, *arguments],
        stdin=side,
        stdout=subprocess.PIPE,
        stderr=side,
        close_fds=True,
        env={**os.environ, "TERM": "dumb"},
    )
    os.close(side)
    seen, deadline = "", time.monotonic() + 30
    todo = list(answers)
    while time.monotonic() < deadline:
        ready, _, _ = select.select([main], [], [], 0.2)
        if ready:
            try:
                data = os.read(main, 4096)
            except OSError:
                break
            if not data:
                break
            seen += data.decode()
        elif process.poll() is not None:
            break
        if todo and todo[0][0] in seen:
            question, answer = todo.pop(0)
            seen = seen.partition(question)[2]
            os.write(main, f"{answer}\n".encode())
    out, _ = process.communicate(timeout=10)
    os.close(main)
    assert not todo, f"never asked for {todo[0][0]!r}; seen {seen!r}"
    return process.returncode, out.decode(), seen


def test_the_menu_then_the_numbers():
    code, out, _ = converse(
        [], [("Which shape", "2"), ("Mass", "0.18"), ("Radius", "0.06"), ("Length", "0.09")]
    )
    assert code == 0
    assert 'ixx="0.0002835"' in out
    assert 'izz="0.000324"' in out


def test_only_what_is_missing_is_asked_for():
    answers = [("Mass", "1024"), ("X", "1"), ("Y", "1"), ("Z", "0.5")]
    code, out, _ = converse(["box"], answers)
    assert code == 0
    assert 'izz="170.667"' in out
    code, out, _ = converse(["sphere", "--mass", "2"], [("Radius", "0.5")])
    assert code == 0
    assert 'ixx="0.2"' in out


def test_an_answer_that_is_no_size_is_asked_for_again():
    answers = [("Radius", "wide"), ("Error", "-3"), ("greater than zero", "0.5")]
    code, out, _ = converse(["sphere", "--mass", "2"], answers)
    assert code == 0
    assert 'ixx="0.2"' in out


def test_a_shape_by_its_name_and_a_wrong_one():
    answers = [("Which shape", "torus"), ("Error", "sphere"), ("Mass", "2"), ("Radius", "0.5")]
    code, out, _ = converse([], answers)
    assert code == 0
    assert 'ixx="0.2"' in out


def test_an_end_of_input_stops():
    main, side = pty.openpty()
    process = subprocess.Popen([*COMMAND, "sphere"], stdin=side, stdout=side, stderr=side)
    os.close(side)
    seen = ""
    while "Mass" not in seen:
        seen += os.read(main, 4096).decode()
    os.write(main, b"\x04")
    assert process.wait(timeout=10) == 130
    os.close(main)


def test_progress_at_a_terminal_only(monkeypatch, capfd):
    from urdftool.commands.progress import Progress
    from urdftool.console import Console

    def report(console, **options):
        with Progress(console, "meshes", **options) as progress:
            progress(1, 3, ["a.stl", "link.stl"])
            time.sleep(0.05)
        return capfd.readouterr().err

    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    line = "\r\033[Kmeshes [########................] 1/3  "
    assert report(Console(), patience=0) == f"{line}a.stl, link.stl\r\033[K"
    assert f"{line}0 s  a.stl, link.stl" in report(Console(), patience=0.01, timed=True)
    assert report(Console(verbosity=-1), patience=0) == ""
    monkeypatch.setattr("sys.stderr.isatty", lambda: False, raising=False)
    assert report(Console(), patience=0) == ""


def test_progress_in_a_pipe_is_a_line_every_few_seconds(monkeypatch, capfd):
    from urdftool.commands import progress as module
    from urdftool.console import Console

    now = [0.0]
    monkeypatch.setattr(module, "monotonic", lambda: now[0])
    monkeypatch.setattr(module, "PIPE_PATIENCE", 2.0)  # which tests do not see otherwise
    monkeypatch.setattr("sys.stderr.isatty", lambda: False, raising=False)
    with module.Progress(Console(), "meshes") as progress:
        for second in range(12):
            now[0] = second
            progress(second, 12, ["a.stl"])
    lines = capfd.readouterr().err.splitlines()
    assert lines == ["2 of 12 meshes, 2 s: a.stl", "7 of 12 meshes, 7 s: a.stl"]
