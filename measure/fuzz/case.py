"""One case: a damaged robot, a command on it in a process of its own, and what must hold after."""

from __future__ import annotations

import contextlib
import hashlib
import multiprocessing.process
import os
import random
import re
import resource
import shutil
import signal
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

from .commands import COMMANDS
from .damage import damaged, damaged_yaml
from .meshes import copied_mesh, damage_some
from .robots import copied

OWN = ("urdftool", ".cache", ".sdformat")
"""What may be left in the home folder: the cache, and the log of the library that reads SDF."""

EDITED = (".urdf", ".xacro", ".srdf", ".xml", ".txt", ".py", ".launch", ".yaml", ".stl")
"""What a fix may edit or make: descriptions, SRDF, package.xml, CMakeLists.txt, launch files, and
meshes. It must say which."""

CONTROL = re.compile("\r(?!\n)|[\0-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
"""What a terminal obeys instead of showing it."""

SECONDS = 60
MEMORY = 8 << 30


@dataclass
class Outcome:
    """What became of a case: its number tells it again."""

    number: int
    command: str
    robot: str
    words: list[str]
    code: int | None
    seconds: float
    problems: list[str] = field(default_factory=list)


def run_case(seed, number, robots, scratch, only=None):
    """Run a case; the same seed and number are the same case.

    Args:
        seed: Of the whole run.
        number: Of the case.
        robots: From ``robots.candidates``.
        scratch: A folder that is made, and removed where all is well.
        only: The command to try, instead of any.
    """
    dice = random.Random(f"{seed}-{number}")
    name = only or dice.choice(list(COMMANDS))
    path, folder = dice.choice(dice.choice(robots))
    words = dice.choice(COMMANDS[name])
    scratch = Path(scratch)
    shutil.rmtree(scratch, ignore_errors=True)
    (scratch / "in").mkdir(parents=True)
    (scratch / "out").mkdir()
    (scratch / "home").mkdir()
    filled = {"OUT": str(scratch / "out")}
    if "MESH" in words:
        path = copied_mesh(dice, scratch / "in")
        filled["MESH"] = str(path)
    else:
        filled |= _robot(path, folder, dice, scratch)
    if "YAML" in words:
        filled["YAML"] = str(scratch / "in" / "controllers.yaml")
        Path(filled["YAML"]).write_bytes(damaged_yaml(dice))
    words = [_filled(word, filled) for word in words]
    before = _contents(scratch / "in")
    start = time.monotonic()
    code = _call(words, scratch)
    outcome = Outcome(number, name, str(path), words, code, time.monotonic() - start)
    outcome.problems = _problems(outcome, scratch, before)
    if not outcome.problems:
        shutil.rmtree(scratch)
    return outcome


def _robot(path, folder, dice, scratch):
    """Copy a robot with what lies beside it, and damage it, sometimes one of its meshes too."""
    robot = copied(path, folder, scratch / "in")
    original = robot.with_name(f"original_{robot.name}")
    original.write_bytes(robot.read_bytes())
    robot.write_bytes(damaged(robot.read_bytes(), dice, scratch))
    if dice.random() < 0.15:
        damage_some(scratch / "in", dice)
    return {"IN": str(robot), "ORIGINAL": str(original), "FOLDER": str(robot.parent)}


def _filled(word, values):
    for name, value in values.items():
        if word == name or word.startswith(name + "/"):
            return value + word[len(name) :]
    return word


def _call(words, scratch):
    """The exit code; minus the signal's number where one ended it, None where time did."""
    child = os.fork()
    if child == 0:
        os.setsid()
        os.chdir(scratch / "out")
        # a worker of a pool may have no children; the command may
        multiprocessing.process.current_process()._config["daemon"] = False
        for stream, name in ((0, os.devnull), (1, scratch / "stdout"), (2, scratch / "stderr")):
            flags = os.O_RDONLY if stream == 0 else os.O_WRONLY | os.O_CREAT | os.O_TRUNC
            os.dup2(os.open(name, flags), stream)
        for name in ("HOME", "TMPDIR", "XDG_CACHE_HOME"):
            os.environ[name] = str(scratch / "home")
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        sys.stdout = open(1, "w", encoding="utf-8")  # noqa: SIM115 -- until the process ends
        sys.stderr = open(2, "w", encoding="utf-8")  # noqa: SIM115
        from urdftool import cli

        code = 99
        try:
            code = cli.call(words)
            sys.stdout.flush()
            sys.stderr.flush()
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 98
        finally:
            os._exit(code)
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            _kill_rest(child)
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.002)
    _kill_rest(child)
    os.waitpid(child, 0)
    return None


def _kill_rest(group):
    with contextlib.suppress(OSError):
        os.killpg(group, signal.SIGKILL)


def _contents(folder):
    return {
        str(p.relative_to(folder)): hashlib.sha1(p.read_bytes()).digest()
        for p in folder.rglob("*")
        if p.is_file()
    }


def _problems(outcome, scratch, before):
    """What must not be, and is."""
    if outcome.code is None:
        return [f"took longer than {SECONDS} s"]
    err, out = _text(scratch / "stderr"), _text(scratch / "stdout")
    found = []
    if outcome.code not in (0, 1, 2):
        found.append(f"exit code {outcome.code}")
    if "Traceback (most recent" in err + out:
        found.append("a traceback")
    said = err + out if "--fleet" in outcome.words else err  # its table says it
    if outcome.code == 2 and not said.strip():
        found.append("could not be done, and nothing is said")
    exact = not {"json", "--check", "--diff"}.isdisjoint(outcome.words)  # a result, as it is
    if control := CONTROL.search(err if exact else err + out):
        found.append(f"a control character is printed: {control[0]!r}")
    found += _harm(outcome, scratch, before)
    written = sorted((scratch / "out").rglob("*"))
    if any(p.is_file() and not p.stat().st_size for p in written):
        found.append("an empty output")
    tells = not {"--fleet", "--output-file"}.isdisjoint(outcome.words)  # reports of what failed
    if outcome.code == 2 and written and not tells:
        found.append(f"could not be done, and wrote {written[0].name}")
    return found


def _harm(outcome, scratch, before):
    """What was changed, written or left where nothing should be."""
    after = _contents(scratch / "in")
    changed = {name for name in before | after if before.get(name) != after.get(name)}
    if "--fix" in outcome.words:
        said = _text(scratch / "stderr")
        asked = os.path.relpath(outcome.words[1], scratch / "in")
        changed = {
            n for n in changed if n != asked and not (n.endswith(EDITED) and Path(n).name in said)
        }
    if changed:
        yield f"inputs changed: {sorted(changed)[:3]}"
    expected = ("in", "out", "home", "stdout", "stderr")
    strays = [p.name for p in scratch.iterdir() if p.name not in expected]
    if strays or (scratch.parent / "escaped").exists():
        yield f"written outside: {strays}"
    kept = [p.name for p in (scratch / "home").iterdir() if p.name not in OWN]
    if kept:
        yield f"left behind: {kept[:3]}"


def _text(path):
    return path.read_bytes().decode("utf-8", "replace") if path.exists() else ""
