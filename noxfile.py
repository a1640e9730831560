"""The wheel and the source distribution on each Python that is there: ``nox -s platforms``.

Wheel and sdist are built once and checked; each is installed into an empty environment, where the
commands run, and all that README.md shows, without a network. ``nox -s lowest`` runs light tests
with the oldest dependencies that are allowed. ``nox -s wheels`` resolves every extra for each
Python and platform, from wheels alone. ``nox -s usd`` tests stages with the oldest and the newest
usd-core for each Python. A Python that is not there is skipped and said so.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import sys
import tempfile
from pathlib import Path

import nox

PYTHONS = ["3.10", "3.11", "3.12", "3.13", "3.14"]
PLATFORMS = (
    *("x86_64-manylinux_2_28", "aarch64-manylinux_2_28"),
    *("x86_64-apple-darwin", "aarch64-apple-darwin", "x86_64-pc-windows-msvc"),
)
ROOT = Path(__file__).parent
URDF = ROOT / "fixtures/robots/demo_arm/urdf"
ARM = "fixtures/robots/demo_arm/urdf/arm_sound.urdf.xacro"
LIGHT = (
    "tests/test_architecture.py",
    "tests/test_startup.py",
    "tests/source",
    "tests/model",
    "tests/info",
    "tests/test_api.py",
    "tests/viewer/test_server.py",
)
STAGES = ("tests/formats/usd", "tests/lint/test_other_formats.py")
COMMANDS = (
    *(["--version"], ["expand", ARM], ["info", ARM], ["graph", ARM, "-o", "-"]),
    *(["graph", ARM, "-o", "OUT/arm.svg"], ["diff", ARM, ARM], ["simulate", ARM, "--fixed-base"]),
    *(["inertia", "robot", ARM], ["inertia", "box", "--mass", "1", "--size", "1", "1", "1"]),
    *(["lint", ARM, "--exit-zero"], ["export", "sdf", ARM, "-o", "OUT/arm", "--verify"]),
    ["export", "mjcf", ARM, "-o", "OUT/arm_mj"],
    ["export", "usd", ARM, "-o", "OUT/arm.usdc", "--verify"],
    ["collision", "mesh", "fixtures/meshes/cube.stl", "--method", "hull", "--no-cache"],
    ["view", ARM, "--picture", "OUT/arm.png", "--size", "64x48"],
)
HELPS = ("expand", "lint", "inertia", "collision", "graph", "info", "diff", "view", "simulate")

nox.options.sessions = ["build", "platforms"]
nox.options.error_on_missing_interpreters = False
nox.options.default_venv_backend = "venv"


def find_pythons() -> None:
    """Let the Pythons that pyenv has be found by their names, active there or not."""
    versions = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    found = [str(path) for path in sorted(versions.glob("3.*/bin"))]
    os.environ["PATH"] = os.pathsep.join([*found, os.environ.get("PATH", "")])


find_pythons()


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
    """Install what was built, and run the commands and README.md without a network."""
    found = sorted(dist().glob(f"*.{kind}"))
    if not found:
        session.error("there is nothing to install; run `nox -s build` first")
    session.install("--only-binary", ":all:", f"{found[-1]}[all]")
    session.chdir(ROOT)
    out = Path(session.create_tmp()).resolve()
    for words in [*COMMANDS, *([name, "--help"] for name in HELPS)]:
        urdftool(session, [word.replace("OUT", str(out)) for word in words])
    if kind == "whl":
        readme(session, out / "readme")


def alone() -> list[str]:
    """What keeps a command from the network, where that can be done."""
    return ["unshare", "-n"] if sys.platform == "linux" and os.geteuid() == 0 else []


def urdftool(session: nox.Session, words: list[str]) -> None:
    """A command, which must be able to do its work; exit 1 is a verdict on the robot."""
    program = str(Path(session.bin) / "urdftool")
    session.run(*alone(), program, *words, external=True, silent=True, success_codes=[0, 1])


def readme(session: nox.Session, here: Path) -> None:
    """All that README.md shows: what its commands print, its other commands, and its Python."""
    python = str(Path(session.bin) / "python")
    check = (python, str(ROOT / "docs/generate.py"), "--check", str(ROOT / "README.md"))
    session.run(*alone(), *check, external=True)
    shutil.rmtree(here, ignore_errors=True)
    here.mkdir()
    shutil.copy(URDF / "arm_sound.urdf.xacro", here / "arm.urdf.xacro")
    shutil.copy(URDF / "link_sound.macro.xacro", here)
    session.chdir(here)
    text = (ROOT / "README.md").read_text("utf-8")
    for block in re.findall(r"```sh\n(.*?)```", text, re.DOTALL):
        for line in block.splitlines():
            words = shlex.split(line, comments=True)
            lasts = words[1:2] == ["view"] and "--contact-sheet" not in words
            if words[:1] == ["urdftool"] and not lasts:
                urdftool(session, words[1:])
    for code in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
        session.run(*alone(), python, "-c", code, external=True)


@nox.session(python=False)
def wheels(session: nox.Session) -> None:
    """Resolve every extra for every Python and platform that is supported, from wheels alone."""
    folder = Path(session.create_tmp())
    environment = folder / "uv"
    session.run(sys.executable, "-m", "venv", str(environment))
    uv = str(environment / ("Scripts" if os.name == "nt" else "bin") / "uv")
    session.run(str(Path(uv).with_name("python")), "-m", "pip", "install", "--quiet", "uv")
    for python in PYTHONS:
        for platform in PLATFORMS:
            session.run(
                *(uv, "pip", "compile", "--quiet", "pyproject.toml", "--extra", "all"),
                *("--only-binary", ":all:", "--python-version", python),
                *("--python-platform", platform, "-o", str(folder / f"{python}-{platform}.txt")),
            )


@nox.session(python=PYTHONS)
@nox.parametrize("resolution", ["lowest", "highest"])
def usd(session: nox.Session, resolution: str) -> None:
    """Tests of stages with the oldest and the newest usd-core that has a wheel for the Python."""
    session.install("uv", ".[mesh]", "pytest>=8", "hypothesis>=6.100", "pillow")
    session.run(
        *("uv", "pip", "install", "--resolution", resolution, "--no-deps"),
        *("--only-binary", ":all:", "usd-core>=25.5"),
    )
    session.run("python", "-m", "pytest", "-m", "not slow", *STAGES)


@nox.session(python=["3.10"])
def lowest(session: nox.Session) -> None:
    """Light tests with the lower bounds of the dependencies."""
    session.install("uv")
    resolved = Path(session.create_tmp()) / "lowest.txt"
    session.run(
        *("uv", "pip", "compile", "--resolution", "lowest-direct", "pyproject.toml"),
        *("--extra", "dask", "--extra", "all"),
        *("--python", str(Path(session.bin) / "python"), "-o", str(resolved)),
    )
    session.install("-r", str(resolved), "pytest>=8", "hypothesis>=6.100")
    session.install("--no-deps", ".")
    place = Path(tempfile.gettempdir()) / "urdftool-lowest"  # names below this folder are shortened
    marks = ("-m", "not slow and not corpus", "--basetemp", str(place))
    session.run("python", "-m", "pytest", *marks, *LIGHT)
