"""Check by Gazebo's own reader, if installed, that the file loads without messages."""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from dataclasses import replace
from pathlib import Path

from ....compare.check import Check
from ....model.elements import Robot
from ..options import VERSIONS, Options
from ..write import write

_TOO_NEW = re.compile(r"Unable to convert from SDF version \S+ to (\S+)")
_TOOLS = ("gz", "ign")
_SECONDS = 60
"""Time that a program may take. Chosen, no source."""

_IGNORED = ("Library error", "backtrace")


def run_loads(robot: Robot, options: Options, place: Path) -> Check | None:
    """Run ``gz sdf -k`` or ``ign sdf -k``; return None if neither is installed or recent enough.

    For a reader older than the exported version, the robot is exported again in a version that it
    reads.
    """
    for tool in _TOOLS:
        if shutil.which(tool) is None:
            continue
        output = _ask(tool, place)
        if output is None:
            continue
        check = Check(f"{tool} sdf", "loads without error or warning", 0.0)
        older = _TOO_NEW.search(output)
        if older and older[1] in VERSIONS[options.target]:
            check.what += f", at {older[1]}, the newest it reads"
            output = _ask_older(tool, robot, replace(options, version=older[1], file="model.sdf"))
        elif older:
            return None
        check.differing = _collect_complaints(output or "")
        return check
    return None


def _ask(tool: str, place: Path) -> str | None:
    """Return the output of the tool; None if it has no command ``sdf``."""
    try:
        done = subprocess.run(
            [tool, "sdf", "-k", str(place)],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_SECONDS,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"Error: {error}"
    output = done.stdout + done.stderr
    if "cannot find any available" in output or "unrecognized command" in output.lower():
        return None
    return output if done.returncode == 0 else f"{output}\nError: exit code {done.returncode}"


def _ask_older(tool: str, robot: Robot, options: Options) -> str | None:
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "model.sdf"
        content = write(robot, options).files["model.sdf"]
        assert isinstance(content, bytes)
        place.write_bytes(content)
        return _ask(tool, place)


def _collect_complaints(output: str) -> list[str]:
    lines = [re.sub(r"\x1b\[[0-9;]*m", "", line).strip() for line in output.splitlines()]
    return [
        line
        for line in lines
        if re.search(r"\b(Error|Warning|Err|Wrn)\b", line) and not any(w in line for w in _IGNORED)
    ]
