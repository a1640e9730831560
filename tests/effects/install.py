"""Install further versions of readers: ``python -m tests.effects.install FOLDER``.

Sentences that name a version are checked in it: MuJoCo 3.3 beside the one of this environment,
urdfdom 4 and 6 beside Debian's urdfdom 3, and Newton. ``URDFTOOL_READERS=FOLDER`` lets the table
find them. Debian's packages are liburdfdom-dev, liburdfdom-tools, libsdformat-dev,
libkdl-parser-dev and g++.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

PREFIXES = {
    "urdfdom-4.0.1": ("cmeel-urdfdom==4.0.1", "cmeel-tinyxml2<11", "cmeel-urdfdom-headers==1.1.2"),
    "urdfdom-6.0.0": ("cmeel-urdfdom==6.0.0", "cmeel-urdfdom-headers==3.0.0"),
}
ENVIRONMENTS = {"mujoco-3.3.7": ("mujoco==3.3.7",), "newton-1.8.0": ("newton[importers]==1.8.0",)}


def install(folder: Path) -> None:
    """Install each version into a folder of its own."""
    for name, packages in PREFIXES.items():
        pip = (sys.executable, "-m", "pip", "install", "--target", str(folder / name))
        subprocess.run([*pip, *packages], check=True)
    for name, packages in ENVIRONMENTS.items():
        subprocess.run([sys.executable, "-m", "venv", str(folder / name)], check=True)
        python = str(folder / name / "bin" / "python")
        subprocess.run([python, "-m", "pip", "install", *packages], check=True)


if __name__ == "__main__":
    install(Path(sys.argv[1]).resolve())
