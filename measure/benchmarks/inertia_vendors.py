"""The inertias that vendors wrote against those of their own meshes, and their page.

Run: pip install example-robot-data pybullet; python -m measure.benchmarks.inertia_vendors [--check]
"""

from __future__ import annotations

import math
import sys
import sysconfig
from importlib.util import find_spec
from pathlib import Path

from urdftool.inertia.link_review import LinkReview
from urdftool.inertia.mesh_files import read_meshes
from urdftool.inertia.review import review
from urdftool.model.load import load

PAGE = Path(__file__).resolve().parents[2] / "docs" / "measurements" / "inertia-vendors.md"
BEGIN, END = "<!-- table begins -->", "<!-- table ends -->"

ERD = Path(sysconfig.get_paths()["purelib"], "cmeel.prefix", "share", "example-robot-data")
SPEC = find_spec("pybullet_data")
BULLET = Path(SPEC.origin).parent if SPEC and SPEC.origin else Path("pybullet_data")

ROBOTS = {
    "Franka Emika Panda (example-robot-data)": ERD / "robots/panda_description/urdf/panda.urdf",
    "Universal Robots UR5 (example-robot-data)": ERD / "robots/ur_description/urdf/ur5_robot.urdf",
    "KUKA LBR iiwa (pybullet_data)": BULLET / "kuka_iiwa/model.urdf",
}


def rows(path: Path, source: str) -> list[str]:
    """A row of the page for each link that has a mass and a geometry."""
    robot = load(path, package_paths=[ERD.parent])
    assert robot.source is not None
    description = robot.source
    found = review(robot, lambda names: read_meshes(description, names), source=source)
    return [row(item) for item in found if item.comparison is not None and item.body is not None]


def row(item: LinkReview) -> str:
    assert item.comparison is not None
    assert item.body is not None
    found = item.comparison
    ratio = " ".join(f"{value:.3g}" for value in found.ratio)
    angle = "–" if found.angle is None else f"{math.degrees(found.angle):.0f}"
    methods = ", ".join(dict.fromkeys(piece.method for piece in item.body.pieces))
    faults = ", ".join(fault.code for fault in item.faults)
    cells = (
        item.link.name,
        f"{item.link.mass:.4g}",
        ratio,
        angle,
        f"{found.distance * 1000:.3g}",
        f"{found.density:.4g}",
        methods,
        faults or item.status,
    )
    return f"| {' | '.join(cells)} |"


def tables() -> str:
    parts = []
    for name, path in ROBOTS.items():
        for source in ("visual", "collision"):
            parts += [
                f"### {name}, {source}\n",
                "| link | mass kg | moments, written/implied | axes ° | com mm | kg/m³ "
                "| method | judged |",
                "|---|---|---|---|---|---|---|---|",
                *rows(path, source),
                "",
            ]
    return "\n".join(parts)


def main(check: bool) -> int:
    for path in ROBOTS.values():
        if not path.exists():
            print(f"{path} is not there; pip install example-robot-data pybullet")
            return 2
    text = PAGE.read_text("utf-8")
    head, _, rest = text.partition(BEGIN)
    tail = rest.partition(END)[2]
    fresh = f"{head}{BEGIN}\n\n{tables()}\n{END}{tail}"
    if check:
        return int(fresh != text)
    PAGE.write_text(fresh, "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main("--check" in sys.argv[1:]))
