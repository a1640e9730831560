"""Which engines there are, by the names a user gives, and whether they are installed."""

from __future__ import annotations

import sys
from importlib.util import find_spec

from ..errors import MissingDependency

ENGINES = {"pybullet": ("bullet",), "mujoco": ("mj",), "both": ("bullet", "mj")}
"""What ``--engine`` may be, and the modules that are run."""

LIBRARIES = {"bullet": "pybullet", "mj": "mujoco"}
"""Modules with a function ``run(bodies, settings, folder)``, and the library each imports."""

MUJOCO = "pip install 'urdftool[mujoco]'"

_LAST = (3, 11)  # the last Python for which PyBullet has wheels


def default_engine() -> str:
    """PyBullet; where there is none, and MuJoCo is, MuJoCo."""
    none = find_spec("pybullet") is None
    return "mujoco" if none and find_spec("mujoco") is not None else "pybullet"


def check_engines(names: tuple[str, ...]) -> None:
    """Refuse engines that are not installed, before any work is done.

    Args:
        names: Modules of this package.

    Raises:
        MissingDependency: With what to do on this Python.
    """
    there = find_spec("mujoco") is not None
    if "bullet" in names and find_spec("pybullet") is None:
        version = f"{sys.version_info[0]}.{sys.version_info[1]}"
        if sys.version_info[:2] > _LAST:
            what = f"PyBullet has wheels up to Python 3.11 only, and this is {version};"
        else:
            what = "PyBullet is not installed; pip install pybullet, or"
        install = "" if there else f" after {MUJOCO}"
        raise MissingDependency(f"{what} use --engine mujoco{install}")
    if "mj" in names and not there:
        raise MissingDependency(f"MuJoCo is not installed; {MUJOCO}")
