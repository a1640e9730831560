"""Every command on models in SDF and MJCF: ``python -m measure.benchmarks.any_format FOLDER``.

FOLDER contains the unpacked wheels robosuite 1.5.2, dm_control 1.0.50, gymnasium 1.4.0 and
gymnasium-robotics 1.4.2. The packages example-robot-data, pybullet and drake are installed where
``URDFTOOL_PEERS`` names.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from urdftool.compare.check import WITHOUT_DIFFERENCE

from .robots import example_folder

PAGE = Path(__file__).resolve().parents[2] / "docs" / "formats" / "commands.md"
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"
_TIME_LIMIT = 600

DRAKE = "pydrake/share/drake/examples"
MODELS = (
    "pybullet_data/kuka_iiwa/model.sdf",
    "pybullet_data/gripper/wsg50_one_motor_gripper.sdf",
    f"{DRAKE}/planar_gripper/planar_gripper.sdf",
    f"{DRAKE}/acrobot/Acrobot.sdf",
    "example-robot-data/robots/cassie_description/robots/cassie_v2.sdf",
    "robosuite/models/assets/robots/panda/robot.xml",
    "gymnasium_robotics/envs/assets/fetch/reach.xml",
    "dm_control/suite/quadruped.xml",
    "gymnasium/envs/mujoco/assets/humanoid.xml",
    "pybullet_data/mjcf/ant.xml",
)
"""Paths of the models in their packages."""


class Run(NamedTuple):
    """Result of a command."""

    code: int
    out: str
    err: str


def run(*words: object) -> Run:
    """Run a command of urdftool."""
    command = [sys.executable, "-m", "urdftool", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=_TIME_LIMIT, check=False)
    assert done.returncode in (0, 1, 2), done.stderr
    return Run(done.returncode, done.stdout, done.stderr)


def find_model(name: str, wheels: Path) -> Path:
    """Return the path of a model, in the wheels or an installed package."""
    examples = example_folder()
    if name.startswith("example-robot-data/"):
        return examples / name.removeprefix("example-robot-data/")
    installed = next(p for p in examples.parents if p.name == "site-packages")
    return wheels / name if (wheels / name).exists() else installed / name


def describe(path: Path, folder: Path) -> Iterator[str]:
    """Yield the cell of each command."""
    last = run("lint", path, "--no-cache", "--exit-zero").err.strip().splitlines()[-1]
    yield re.sub(r" in 1 file.*", "", last)
    yield describe_info(run("info", path, "--format", "json"))
    yield "drawn" if not run("view", path, "--picture", folder / "v.png").code else "refused"
    yield "drawn" if not run("graph", path, "-o", folder / "g.svg").code else "refused"
    verdict = run("simulate", path, "--no-cache")
    yield verdict.out.partition("\n")[0].partition(": ")[2] if verdict.code < 2 else "refused"
    yield run("inertia", "robot", path).err.strip().splitlines()[-1].partition(", ")[2]
    check = run("collision", path, "--check", "--no-cache")
    yield check.err.strip().splitlines()[-1].rpartition(": ")[2]
    for kind in ("urdf", "sdf", "mjcf", "usd"):
        words = ("export", kind, path, "-o", folder / kind, "--verify", "--format", "json")
        yield describe_export(run(*words))
    bundle = run("bundle", path, "-o", folder / "bundle", "--check")
    yield bundle.err.strip().splitlines()[-1].rpartition(": ")[2]
    urdf = next((folder / "urdf").glob("*.urdf"))
    yield f"{run('verify', path, urdf).err.strip().splitlines()[-1].partition(': ')[2]}"


def describe_info(done: Run) -> str:
    """Return links, degrees of freedom and mass."""
    info = json.loads(done.out)
    return f"{info['links']} links, {info['freedom']} DOF, {info['mass']:.4g} kg"


def describe_export(done: Run) -> str:
    """Return the worst verdict of an export, with the rows that are not equal."""
    report = json.loads(done.out)
    if done.code == 2:
        return "refused: " + ", ".join(sorted({f["rule"] for f in report["findings"]}))
    rows = [check for check in report["checks"] if check["verdict"] not in WITHOUT_DIFFERENCE]
    worst = "differs" if any(c["verdict"] == "differs" for c in rows) else "announced"
    return f"{worst}: {', '.join(check['check'] for check in rows)}" if rows else "equal"


NAMES = (
    *("lint", "info", "view", "graph", "simulate", "inertia robot", "collision --check"),
    *("export urdf", "export sdf", "export mjcf", "export usd", "bundle --check"),
    "verify with the URDF of export urdf",
)


def main() -> None:
    """Write the table into the page."""
    wheels = Path(sys.argv[1])
    lines = []
    for name in MODELS:
        with tempfile.TemporaryDirectory(dir=os.environ.get("TMPDIR")) as folder:
            cells = zip(NAMES, describe(find_model(name, wheels), Path(folder)), strict=True)
            title = name.replace(DRAKE, "drake/examples")
            lines += [f"### `{title}`", "", "| command | result |", "|---|---|"]
            lines += [f"| {command} | {cell} |" for command, cell in cells]
            lines.append("")
        print(name, file=sys.stderr)
    text = PAGE.read_text("utf-8")
    head, tail = text.partition(BEGIN)[0], text.partition(END)[2]
    PAGE.write_text(f"{head}{BEGIN}\n" + "\n".join(lines) + f"{END}{tail}", "utf-8")


if __name__ == "__main__":
    main()
