"""The tools that urdftool is measured beside, where they are, and of which version.

Those of PyPI stand in an environment of their own, which ``make bench-peers`` makes: some of them
want versions of libraries that others do not. Those of Debian are found on the path.
"""

from __future__ import annotations

import os
import platform
import re
import shutil
import subprocess
import sys
from functools import cache
from importlib import metadata
from pathlib import Path

from urdftool import __version__

from .timing import PYTHON

ROOT = Path(__file__).resolve().parents[2]
FOLDER = Path(os.environ.get("URDFTOOL_PEERS", ROOT / ".venv-peers"))

PYPI = (
    "xacro", "simcheck", "scikit-robot", "urdf2mjcf", "xacrodoc", "mujoco", "obj2mjcf",
    "fast-simplification", "pymeshlab", "coacd", "pybullet", "trimesh", "scipy", "pycollada",
    "example-robot-data",
)  # fmt: skip
"""What ``make bench-peers`` installs."""

DEBIAN = {
    "check_urdf": "liburdfdom-tools",
    "urdf_to_graphviz": "liburdfdom-tools",
    "dot": "graphviz",
    "ign sdf": "sdformat-sdf",
}


def python() -> str | None:
    """The Python of the environment of the others."""
    return _in(FOLDER, "python")


def tool(name: str) -> str | None:
    """A command of the others, of the system, or beside our Python; None where it is missing."""
    if name in DEBIAN:  # packages of PyPI bring wrappers of the same name, in Python
        folders = os.environ.get("PATH", os.defpath).split(os.pathsep)
        others = [f for f in folders if not Path(f, "python").exists() or f == "/usr/bin"]
        return shutil.which(name, path=os.pathsep.join(others))
    return _in(FOLDER, name) or shutil.which(name) or _in(Path(PYTHON).parents[1], name)


def _in(folder: Path, name: str) -> str | None:
    return shutil.which(name, path=str(folder / ("Scripts" if os.name == "nt" else "bin")))


@cache
def version(name: str) -> str | None:
    """The version of a package of PyPI, or of what brings a command of Debian."""
    if name == "urdftool":
        return __version__
    if name == "ign sdf":
        return _first_number(["ign", "sdf", "--versions"])
    if name in DEBIAN:
        return _first_number(["dpkg-query", "-W", "-f", "${Version}", DEBIAN[name]])
    chosen = python()
    if chosen is not None:
        code = f"from importlib.metadata import version as v; print(v({name!r}))"
        done = subprocess.run([chosen, "-c", code], capture_output=True, text=True, check=False)
        if done.returncode == 0:
            return done.stdout.strip()
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def has(name: str) -> bool:
    """Whether there is such a package in the environment of the others."""
    chosen = python()
    if chosen is None:
        return False
    code = f"from importlib.metadata import version as v; v({name!r})"
    return subprocess.run([chosen, "-c", code], capture_output=True, check=False).returncode == 0


def _first_number(words: list[str]) -> str | None:
    try:
        done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=60)
    except (OSError, subprocess.TimeoutExpired):
        return None
    match = re.search(r"\d+(?:\.\d+)+", done.stdout)
    return match[0] if done.returncode == 0 and match else None


def missing(name: str) -> str:
    """How to get what is not there."""
    if name in DEBIAN:
        package = "ignition-tools sdformat-sdf" if name == "ign sdf" else DEBIAN[name]
        return f"{name} is not installed (apt-get install {package}), so it is left out."
    return f"{name} is not installed (make bench-peers), so it is left out."


@cache
def machine() -> str:
    """Processor, cores and Python."""
    name = platform.processor() or platform.machine()
    try:
        text = Path("/proc/cpuinfo").read_text("utf-8")
        match = re.search(r"^model name\s*:\s*(.*)$", text, re.MULTILINE)
        name = match[1] if match else name
    except OSError:
        pass
    number = os.cpu_count() or 1
    cores = "1 core" if number == 1 else f"{number} cores"
    return f"{name}, {cores}, {platform.system()}, Python {platform.python_version()}"


def install(folder: Path = FOLDER) -> int:
    """Make the environment, each package by itself: one that cannot be had stops no other."""
    if subprocess.run([sys.executable, "-m", "venv", str(folder)], check=False).returncode:
        return 2
    pip = [str(folder / "bin" / "python"), "-m", "pip", "install", "--quiet"]
    pip += ["--disable-pip-version-check", "--prefer-binary"]
    if subprocess.run([*pip, *PYPI], check=False).returncode == 0:
        return 0
    failed = [name for name in PYPI if subprocess.run([*pip, name], check=False).returncode]
    print(f"not installed: {', '.join(failed)}" if failed else "all are installed")
    return 0


if __name__ == "__main__":
    sys.exit(install())
