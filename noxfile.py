"""The wheel and the source distribution on each Python that is there: ``nox -s platforms``.

Wheel and sdist are built once and checked; each is installed into an empty environment, where the
commands run without a network. ``nox -s lowest`` runs light tests with the oldest dependencies
that are allowed.
"""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import nox

PYTHONS = ["3.10", "3.11", "3.12", "3.13", "3.14"]
ROOT = Path(__file__).parent
ARM = "fixtures/robots/demo_arm/urdf/arm_sound.urdf.xacro"
LIGHT = (
    "tests/test_house.py",
    "tests/test_startup.py",
    "tests/source",
    "tests/model",
    "tests/info",
)
COMMANDS = (
    *(["--version"], ["expand", ARM], ["info", ARM], ["graph", ARM, "-o", "-"]),
    *(["inertia", "robot", ARM], ["inertia", "box", "--mass", "1", "--size", "1", "1", "1"]),
    *(["lint", ARM, "--exit-zero"], ["export", "sdf", ARM, "-o", "OUT/arm", "--verify"]),
    ["collision", "mesh", "fixtures/meshes/cube.stl", "--method", "hull", "--no-cache"],
    ["view", ARM, "--picture", "OUT/arm.png", "--size", "64x48"],
)
HELPS = ("expand", "lint", "inertia", "collision", "graph", "info", "diff", "view", "simulate")

nox.options.sessions = ["build", "platforms"]
nox.options.error_on_missing_interpreters = False
nox.options.default_venv_backend = "venv"


def dist() -> Path:
    """Where wheel and sdist are built."""
    return ROOT / "build" / "dist"


@nox.session
def build(session: nox.Session) -> None:
    """Wheel and sdist, as an index would take them."""
    session.install("build", "twine")
    shutil.rmtree(dist(), ignore_errors=True)
    session.run("python", "-m", "build", "--outdir", str(dist()))
    session.run("twine", "check", "--strict", *map(str, sorted(dist().iterdir())))


@nox.session(python=PYTHONS)
@nox.parametrize("kind", ["whl", "tar.gz"])
def platforms(session: nox.Session, kind: str) -> None:
    """Install what was built, and run the commands without a network."""
    found = sorted(dist().glob(f"*.{kind}"))
    if not found:
        session.error("there is nothing to install; run `nox -s build` first")
    session.install(str(found[-1]))
    session.chdir(ROOT)
    out = Path(session.create_tmp())
    alone = ["unshare", "-n"] if sys.platform == "linux" and os.geteuid() == 0 else []
    program = str(Path(session.bin) / "urdftool")
    for words in [*COMMANDS, *([name, "--help"] for name in HELPS)]:
        command = [word.replace("OUT", str(out)) for word in words]
        session.run(*alone, program, *command, external=True, silent=True)


@nox.session(python=["3.10"])
def lowest(session: nox.Session) -> None:
    """Light tests with the lower bounds of the dependencies."""
    session.install("uv")
    resolved = Path(session.create_tmp()) / "lowest.txt"
    session.run(
        *("uv", "pip", "compile", "--resolution", "lowest-direct", "pyproject.toml"),
        *("--python", str(Path(session.bin) / "python"), "-o", str(resolved)),
    )
    session.install("-r", str(resolved), "pytest>=8", "hypothesis>=6.100")
    session.install("--no-deps", ".")
    session.run("python", "-m", "pytest", "-m", "not slow and not corpus", *LIGHT)
