"""The physics engines by the names of ``--engine``, and whether they are installed."""

from __future__ import annotations

import platform
import sys

from ..errors import MissingDependency
from ..extras import install_command, is_installed, missing

ENGINES = {"pybullet": ("bullet",), "mujoco": ("mj",), "both": ("bullet", "mj")}
"""What ``--engine`` may be, and the modules that are run."""

LIBRARIES = {"bullet": "pybullet", "mj": "mujoco"}
"""Modules with a function ``run(bodies, settings, folder)``, and the library each imports."""

_MUJOCO_MACHINES = {
    "linux": ("x86_64", "aarch64"),
    "darwin": ("x86_64", "arm64"),
    "win32": ("AMD64",),
}
"""Where MuJoCo has wheels, for every Python that urdftool supports."""


def default_engine() -> str:
    """Choose PyBullet, or MuJoCo where PyBullet is not installed and MuJoCo is.

    Raises:
        MissingDependency: Neither is installed.
    """
    if is_installed("pybullet"):
        return "pybullet"
    if is_installed("mujoco"):
        return "mujoco"
    raise MissingDependency(
        f"'urdftool simulate' requires a physics engine, and none is installed: {_advice()}",
        library="pybullet" if has_pybullet_wheel() else "mujoco",
    )


def check_engines(names: tuple[str, ...]) -> None:
    """Refuse engines that are not installed, before any work is done.

    Args:
        names: Modules of this package.

    Raises:
        MissingDependency: With what to do on this Python and machine.
    """
    if "bullet" in names and not is_installed("pybullet"):
        if has_pybullet_wheel():
            raise missing("pybullet", "--engine pybullet")
        raise MissingDependency(
            "PyBullet is not installed and has wheels for Linux on x86-64 with Python 3.10 and "
            f"3.11 only, not for {_here()}: {_advice()}",
            library="pybullet",
        )
    if "mj" in names and not is_installed("mujoco"):
        raise missing("mujoco", "--engine mujoco")


def _advice() -> str:
    """Say which engine can be had on this machine, and how."""
    if has_pybullet_wheel():
        return install_command("simulate")
    if is_installed("mujoco"):
        return "use --engine mujoco"
    if platform.machine() in _MUJOCO_MACHINES.get(sys.platform, ()):
        return f"use --engine mujoco, after {install_command('simulate')}"
    return (
        f"neither PyBullet nor MuJoCo has a wheel for {_here()}; simulate on Linux, macOS or "
        "Windows on x86-64, or on Linux or macOS on ARM"
    )


def has_pybullet_wheel() -> bool:
    """Tell whether the extra ``simulate`` installs PyBullet here, and not MuJoCo."""
    is_linux = sys.platform == "linux" and platform.machine() == "x86_64"
    return is_linux and sys.version_info[:2] < (3, 12)


def _here() -> str:
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    return f"Python {version} on {platform.system()} {platform.machine()}"
