"""``auto`` on robots: ``python -m measure.benchmarks.collision_auto ROBOT...`` prints a table.

A robot is a file, with its xacro arguments after blanks: ``"ur.urdf.xacro name:=ur"``. Each is
given new collisions, loaded in PyBullet and, by way of ``export mjcf``, in MuJoCo, and linted
before and after. Options before the robots go to ``urdftool collision``: ``--max-error 0.02``.
"""

from __future__ import annotations

import json
import re
import resource
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from statistics import mean
from typing import Any

from urdftool.errors import UrdftoolError
from urdftool.model.load import load

HEAD = (
    "| robot | mesh links | within | pieces a link | vertices a link | largest error | processor "
    "| PyBullet | MuJoCo | new findings |\n|---|---|---|---|---|---|---|---|---|---|"
)

BULLET = """
import sys, pybullet as p
p.connect(p.DIRECT)
p.setGravity(0, 0, -9.81)
body = p.loadURDF(sys.argv[1], flags=p.URDF_USE_INERTIA_FROM_FILE)
links = range(-1, p.getNumJoints(body))
shapes = sum(len(p.getCollisionShapeData(body, link)) for link in links)
for _ in range(100):
    p.stepSimulation()
place = p.getBasePositionAndOrientation(body)[0]
print("SHAPES", shapes if all(abs(x) < 1e3 for x in place) else "blew up")
"""

MUJOCO = """
import sys, mujoco
model = mujoco.MjModel.from_xml_path(sys.argv[1])
data = mujoco.MjData(model)
for _ in range(100):
    mujoco.mj_step(model, data)
print("GEOMS", sum(model.geom_contype[i] > 0 for i in range(model.ngeom)),
      data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number)
"""


@dataclass
class Made:
    """What became of a robot.

    Attributes:
        name: The robot's file.
        parts: As in ``collision.json``.
        collisions: ``<collision>`` elements that it has now.
        seconds: Processor time it took [s], on all cores together.
        bullet: Shapes in PyBullet, or what went wrong.
        mujoco: ``"loads"``, or what went wrong.
        new: Errors and warnings of lint that were not there before, by rule.
        stderr: What was said of parts that are not within the error.
    """

    name: str
    parts: list[dict[str, Any]]
    collisions: int
    seconds: float
    bullet: str
    mujoco: str
    new: dict[str, int]
    stderr: str

    @property
    def sound(self) -> bool:
        """Whether both engines load it and lint finds nothing new."""
        return self.bullet == self.mujoco == "loads" and not self.new

    def links(self) -> list[tuple[int, int]]:
        """Pieces and vertices of each link that has meshes."""
        pieces: Counter[str] = Counter()
        vertices: Counter[str] = Counter()
        for part in self.parts:
            pieces[part["link"]] += len(part["pieces"])
            vertices[part["link"]] += part["measures"]["vertices"]
        return [(pieces[link], vertices[link]) for link in pieces]

    def row(self) -> str:
        """A line of the table."""
        links = self.links()
        within = sum(part["within"] for part in self.parts)
        worst = max((part["measures"]["error"] for part in self.parts), default=0.0)
        new = ", ".join(f"{rule} {count}" for rule, count in sorted(self.new.items())) or "none"
        return (
            f"| {self.name} | {len(links)} | {within} of {len(self.parts)} "
            f"| {mean(n for n, _ in links):.1f} | {mean(n for _, n in links):.0f} "
            f"| {worst:.2%} | {self.seconds:.0f} s | {self.bullet} | {self.mujoco} | {new} |"
        )


def urdftool(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "urdftool", *words], capture_output=True, text=True, check=False
    )


def make(source: Path, arguments: list[str], folder: Path, options: list[str]) -> Made:
    """Give a robot collisions, and look at what came out.

    Raises:
        RuntimeError: Nothing came out; with what was said.
    """
    before, after = folder / "before.urdf", folder / "after.urdf"
    try:
        robot = load(source, args=dict(word.split(":=", 1) for word in arguments))
    except UrdftoolError as error:
        raise RuntimeError(str(error)) from error
    skips = [word for link in robot.links for word in ("--skip-link", link.name)]
    common = ["collision", str(source), *arguments, "--uri", "relative"]
    done = urdftool(*common, "-o", str(before), *skips)
    if done.returncode:
        raise RuntimeError(done.stderr)
    begin = _processor()
    done = urdftool(*common, "-o", str(after), "--format", "json", *options)
    seconds = _processor() - begin
    if done.returncode:
        raise RuntimeError(done.stderr)
    parts = json.loads(done.stdout)["results"][0]["parts"]
    count = sum(len(link.collisions) for link in load(after).links)
    return Made(
        robot.name or source.stem,
        parts,
        count,
        seconds,
        in_bullet(after, count),
        in_mujoco(after, folder / "mjcf"),
        new_findings(before, after),
        done.stderr,
    )


def _processor() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def in_bullet(robot: Path, count: int) -> str:
    """Whether PyBullet loads it with all of its collisions and steps it."""
    words = [sys.executable, "-c", BULLET, str(robot)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    found = re.search(r"SHAPES (.*)", done.stdout)  # it may stand behind a warning of PyBullet's
    if done.returncode or found is None:
        return "fails: " + (done.stderr.strip().splitlines() or ["it died"])[-1][:60]
    return "loads" if found[1] == str(count) else f"{found[1]} shapes of {count}"


def in_mujoco(robot: Path, folder: Path) -> str:
    """Whether MuJoCo loads what ``export mjcf`` writes, and steps it."""
    done = urdftool("export", "mjcf", str(robot), "-o", str(folder), "--force")
    if done.returncode:
        return "not exported: " + done.stderr.strip().splitlines()[-1][:60]
    (model,) = (path for path in folder.glob("*.xml") if path.name != "scene.xml")
    words = [sys.executable, "-c", MUJOCO, str(model)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    found = re.search(r"GEOMS (\d+) (\d+)", done.stdout)
    if done.returncode or found is None:
        return "fails: " + (done.stderr.strip().splitlines() or ["it died"])[-1][:60]
    return "loads" if found[2] == "0" else "loads, blows up"


def new_findings(before: Path, after: Path) -> dict[str, int]:
    """Errors and warnings that a robot has after, and had not before, by rule."""
    old, new = (Counter(_findings(path)) for path in (before, after))
    rules: Counter[str] = Counter()
    for (rule, _), count in (new - old).items():
        rules[rule] += count
    return dict(rules)


def _findings(robot: Path) -> list[tuple[str, str]]:
    done = urdftool("lint", str(robot), "--format", "json", "--exit-zero")
    return [
        (finding["rule"], str((finding["element"] or {}).get("name")))
        for finding in json.loads(done.stdout)["findings"]
        if finding["severity"] != "info"
    ]


def main(words: list[str]) -> None:
    """Print the table."""
    robots = [word for word in words if Path(word.split()[0]).is_file()]
    options = [word for word in words if word not in robots]
    print(HEAD)
    everything = []
    for word in robots:
        source, *arguments = word.split()
        with tempfile.TemporaryDirectory() as folder:
            try:
                made = make(Path(source), arguments, Path(folder), options)
            except RuntimeError as error:
                print(f"| {Path(source).name} | {str(error).strip().splitlines()[0]} |")
                continue
        everything.append(made)
        print(made.row(), flush=True)
        missed = sum(not part["within"] for part in made.parts)
        said = made.stderr.count("not within")
        if missed and not said:
            print(f"{made.name}: {missed} parts are not within the error and it is not said")
        sys.stderr.write(made.stderr)
    links = [link for made in everything for link in made.links()]
    within = sum(part["within"] for made in everything for part in made.parts)
    parts = sum(len(made.parts) for made in everything)
    print(
        f"\n{len(everything)} robots, {len(links)} links: {within} of {parts} parts within, "
        f"{mean(n for n, _ in links):.1f} pieces and {mean(n for _, n in links):.0f} vertices "
        "a link in the mean"
    )


if __name__ == "__main__":
    main(sys.argv[1:])
