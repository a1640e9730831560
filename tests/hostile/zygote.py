"""Commands in processes of their own, with limits and measured.

``Zygote`` starts one Python that has imported urdftool, which forks for each command. What a
command uses is measured with all its processes, so that the speed of the machine does not matter.
"""

from __future__ import annotations

import base64
import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tests.hostile.place import Outcome, Place

ROOT = Path(__file__).resolve().parents[2]
ADDRESSES = 4 << 30
"""Limit of the address space of each process [bytes]."""

PATIENCE = 20.0
"""Time after which a command that uses no processor time is said not to end [s]."""

LONGEST = 600.0
"""Time after which any command is said not to end [s]."""

PROCESSOR = 30
"""Limit of the processor time of each process [s]."""

FILE = 256 << 20
"""Limit of the size of each written file [bytes]."""


class Zygote:
    """A process that forks for each command."""

    def __init__(self, *, fresh: bool = False) -> None:
        """Start it.

        Args:
            fresh: Start ``python -m urdftool`` for each command, as a user does.
        """
        self._fresh = fresh
        # a library that starts threads when it is imported would keep commands from forking
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.hostile.zygote"],
            cwd=ROOT,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def run(self, words: Sequence[str | bytes], place: Place) -> Outcome:
        """Run a command of urdftool in the project of a place."""
        return self.ask({**pack_words(words), "fresh": self._fresh}, place)

    def ask(self, job: dict[str, Any], place: Place) -> Outcome:
        """Pass a job on and wait for what comes of it.

        Args:
            job: What to do: ``words`` of a command, or a ``plain`` expression of Python.
            place: Where.
        """
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        job |= {
            "folder": str(place.project),
            "environment": place.environment(),
            "streams": str(place.root),
        }
        self._process.stdin.write(json.dumps(job) + "\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        assert line, "the process that forks has ended"
        return _read(Outcome(**json.loads(line)), place)

    def close(self) -> None:
        """End it."""
        self._process.stdin.close()  # type: ignore[union-attr]
        self._process.wait(30)


def pack_words(words: Sequence[str | bytes]) -> dict[str, Any]:
    """Return the job that runs a command."""
    data = [word if isinstance(word, bytes) else os.fsencode(word) for word in words]
    return {"words": [base64.b64encode(word).decode() for word in data]}


def _read(outcome: Outcome, place: Place) -> Outcome:
    outcome.out = (place.root / "stdout").read_bytes()
    outcome.err = (place.root / "stderr").read_bytes()
    return outcome


def _prepare(streams: Path) -> None:
    """Set the limits and streams of a process that was forked."""
    import resource

    os.setsid()
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
    resource.setrlimit(resource.RLIMIT_CPU, (PROCESSOR, PROCESSOR + 5))
    resource.setrlimit(resource.RLIMIT_FSIZE, (FILE, FILE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for stream, name in ((0, None), (1, "stdout"), (2, "stderr")):
        flags = os.O_RDONLY if name is None else os.O_WRONLY | os.O_CREAT | os.O_TRUNC
        opened = os.open(os.devnull if name is None else streams / name, flags, 0o600)
        os.dup2(opened, stream)
        os.close(opened)


def _fork(start: Any) -> Outcome:
    """Fork, let the child start, and measure it with all its processes."""
    child = os.fork()
    if child == 0:
        try:
            start()
        finally:
            os._exit(99)
    start_time = busy = time.monotonic()
    pause, most, others = 0.001, 0, 0.0
    while True:
        done, status, used = os.wait4(child, os.WNOHANG)
        now = time.monotonic()
        if done or now - start_time > LONGEST or now - busy > PATIENCE:
            break
        time.sleep(pause)
        pause = min(pause * 1.5, 0.05)
        if pause >= 0.05:
            memory, seconds = _look_at_session(child)
            busy = now if seconds != others else busy
            most, others = max(most, memory), seconds
    code: int | None = None
    if done:
        code = os.waitstatus_to_exitcode(status)
    rest = _list_session(child) - {child}
    left = bool(rest) and bool(done) and not _ends_soon(child)
    with contextlib.suppress(OSError):
        os.killpg(child, signal.SIGKILL)
    for other in rest:
        with contextlib.suppress(OSError):
            os.kill(other, signal.SIGKILL)
    if not done:
        _, _, used = os.wait4(child, 0)
    unit = 1 << 20 if sys.platform == "darwin" else 1 << 10
    seconds = max(used.ru_utime + used.ru_stime, others)
    return Outcome(code, round(seconds, 3), max(used.ru_maxrss / unit, most / (1 << 20)), left=left)


def _ends_soon(session: int) -> bool:
    """Tell whether the other processes of a session, which were told to, end by themselves."""
    for _ in range(40):
        if not _list_session(session):
            return True
        time.sleep(0.05)
    return False


def _read_stats() -> list[tuple[int, list[str]]]:
    """Return the numbers in /proc of all processes; none where there is no such folder."""
    found = []
    with contextlib.suppress(OSError):
        for name in os.listdir("/proc"):
            if name.isdigit():
                with contextlib.suppress(OSError):
                    text = Path("/proc", name, "stat").read_text("utf-8", "replace")
                    found.append((int(name), text.rpartition(")")[2].split()))
    return found


def _list_session(session: int) -> set[int]:
    """Return the living processes of a session."""
    return {
        number
        for number, values in _read_stats()
        if int(values[3]) == session and values[0] not in "ZX"
    }


def _look_at_session(session: int) -> tuple[int, float]:
    """Return the most resident memory of a process of a session, and the time of all."""
    most, seconds = 0, 0.0
    for _, values in _read_stats():
        if int(values[3]) == session:
            most = max(most, int(values[21]) * os.sysconf("SC_PAGESIZE"))
            seconds += sum(map(int, values[11:15])) / os.sysconf("SC_CLK_TCK")
    return most, seconds


def main() -> None:
    """Answer jobs: one line of JSON each, and one for what came of it."""
    from urdftool import cli

    _import_ahead()
    answers = os.fdopen(os.dup(1), "w")
    for line in sys.stdin:
        job = json.loads(line)

        def start(job: dict[str, Any] = job) -> None:
            _prepare(Path(job["streams"]))
            os.chdir(job["folder"])
            words = [os.fsdecode(base64.b64decode(word)) for word in job.get("words", [])]
            if job.get("fresh"):
                line = [sys.executable, "-m", "urdftool", *words]
                os.execve(sys.executable, line, job["environment"] | {"PYTHONPATH": str(ROOT)})
            os.environ.clear()
            os.environ.update(job["environment"])
            sys.stdin = sys.__stdin__ = open(0, encoding="utf-8")  # noqa: SIM115
            sys.stdout = sys.__stdout__ = open(1, "w", encoding="utf-8")  # noqa: SIM115
            sys.stderr = sys.__stderr__ = open(2, "w", encoding="utf-8")  # noqa: SIM115
            if "plain" in job:
                _evaluate_plainly(job["plain"])
            else:
                cli.run(words)

        outcome = _fork(_and_exit(start))
        values = {"code": outcome.code, "seconds": outcome.seconds, "left": outcome.left}
        answers.write(json.dumps({**values, "megabytes": outcome.megabytes}) + "\n")
        answers.flush()


def _and_exit(start: Any) -> Any:
    def run() -> None:
        code = 99
        try:
            start()
            code = 0
        except SystemExit as leaving:
            code = leaving.code if isinstance(leaving.code, int) else 98
        except BaseException:
            import traceback

            traceback.print_exc()
        finally:
            with contextlib.suppress(Exception):
                sys.stdout.flush()
                sys.stderr.flush()
            os._exit(code)

    return run


_AHEAD = (
    *("source", "rules", "lint", "model", "report", "inertia", "compare", "bundle", "fmt", "graph"),
    *("formats.common", "formats.sdf", "formats.mjcf", "api", "mechanics", "geometry"),
)
"""Packages of urdftool whose modules commands share."""


def _import_ahead() -> None:
    """Import what commands share, so that a fork is cheap; no library with threads."""
    from importlib import import_module
    from pkgutil import walk_packages

    from urdftool import extras

    for name in ("yaml", "lxml.etree", "numpy", "urdftool.cli"):
        import_module(name)
    for package in _AHEAD:
        folder = import_module(f"urdftool.{package}")
        for module in walk_packages(folder.__path__, f"{folder.__name__}."):
            try:
                import_module(module.name)
            except ImportError as error:
                if extras.find_missing_library(error) is None:
                    raise
    threads = Path("/proc/self/task")
    assert not threads.exists() or len(list(threads.iterdir())) == 1


def _evaluate_plainly(text: str) -> None:
    """Evaluate an expression as Python does, with the names of xacro and no restriction."""
    import string

    import xacro

    names = {**xacro._global_symbols, "string": string}
    try:
        print(eval(text.strip(), names))
    except Exception as error:
        sys.stderr.write(f"{type(error).__name__}: {error}\n")
        sys.exit(2)


if __name__ == "__main__":
    main()
