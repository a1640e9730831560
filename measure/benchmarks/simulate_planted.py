"""``python -m measure.benchmarks.simulate_planted``: one fault planted in each of many robots.

A line for each fault: of how many robots it was found, by the kind of verdict it deserves, and
which passed. Robots are fixtures and those of ``pybullet_data``, where that is installed.
"""

from __future__ import annotations

import importlib
import math
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from measure.benchmarks.robots import FIXTURES
from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import Verdict, judge

ROBOTS = FIXTURES / "robots"
MIRA = ROBOTS / "mira_description" / "urdf" / "mira.urdf"
BASE = ROBOTS / "my_robot" / "urdf" / "robot_base.urdf.xacro"
ARM = ROBOTS / "ros2_arm" / "urdf" / "robot2_sound.urdf.xacro"
LASER = ROBOTS / "laser_bot" / "urdf" / "laser_bot.urdf.xacro"

WHEELS = [
    (BASE, "front_left_wheel_link"),
    (LASER, "link_left_wheel"),
    ("husky/husky.urdf", "front_left_wheel_link"),
    ("racecar/racecar.urdf", "left_rear_wheel"),
    ("r2d2.urdf", "right_front_wheel"),
    ("laikago/laikago_toes_zup.urdf", "toeRL"),
    ("a1/a1.urdf", "FR_toe"),
    ("aliengo/aliengo.urdf", "FR_toe"),
]
SMALL = [
    (MIRA, "yaw_M3_link"),
    (BASE, "front_left_wheel_link"),
    (ARM, "link_05"),
    (LASER, "link_left_wheel"),
    ("husky/husky.urdf", "front_left_wheel_link"),
    ("racecar/racecar.urdf", "left_rear_wheel"),
    ("a1/a1.urdf", "FR_lower"),
    ("aliengo/aliengo.urdf", "FR_lower"),
    ("laikago/laikago_toes_zup.urdf", "RL_lower_leg"),
    ("quadruped/spirit40.urdf", "lower0"),
]
MESHES = [
    (MIRA, "base_link"),
    (BASE, "front_left_wheel_link"),
    ("husky/husky.urdf", "base_link"),
    ("racecar/racecar.urdf", "left_rear_wheel"),
    ("a1/a1.urdf", "trunk"),
    ("aliengo/aliengo.urdf", "trunk"),
    ("laikago/laikago_toes_zup.urdf", "chassis"),
    ("kuka_iiwa/model_free_base.urdf", "lbr_iiwa_link_3"),
]
ROOTS = [
    (MIRA, "base_link"),
    (BASE, "base_link"),
    (ARM, "base_link"),
    ("r2d2.urdf", "base_link"),
    ("quadruped/spirit40.urdf", "body"),
    ("quadruped/minitaur_derpy.urdf", "base_chassis_link"),
    ("husky/husky.urdf", "base_link"),
    ("laikago/laikago_toes_zup.urdf", "chassis"),
]
SLOPED = [
    *(MIRA, BASE, ARM, LASER),
    *("husky/husky.urdf", "racecar/racecar.urdf", "a1/a1.urdf", "laikago/laikago_toes_zup.urdf"),
]
JOINED = [
    *((MIRA, "head_link"), (BASE, "rear_right_wheel_link"), (ARM, "link_02")),
    *(
        (LASER, "link_right_wheel"),
        ("a1/a1.urdf", "RL_lower"),
        ("aliengo/aliengo.urdf", "FR_upper"),
    ),
    *(
        ("mini_cheetah/mini_cheetah.urdf", "shank_hl"),
        ("husky/husky.urdf", "rear_right_wheel_link"),
    ),
]
FAULTS: list[tuple[str, str, list[Any], set[str]]] = [
    ("no collision on a wheel or foot", "no_collision", WHEELS, {"missing-contact-geometry"}),
    ("identity inertia", "identity_inertia", SMALL, {"inertia-too-large"}),
    ("mass times 1000", "thousandfold_mass", SMALL, {"too-dense"}),
    ("meshes in millimetres", "millimetres", MESHES, {"too-large"}),
    ("no friction on a slope", "no_friction", SLOPED, {"slid"}),
    ("no inertia of the base", "no_inertia", ROOTS, {"no-mass"}),
    ("collision in the neighbour", "overlapping", JOINED, {"interpenetration"}),
]


def verdict_on(path: Path, **settings: Any) -> Verdict:
    """What is said of one robot."""
    robot = load(path)
    (run,) = simulate(robot, Settings(**settings))
    return judge(robot, run)


def rows() -> Iterator[str]:
    """A line for each fault."""
    from tests.simulation import planted  # a test's tools

    for title, fault, cases, kinds in FAULTS:
        found, missed, said = 0, [], []
        for case in cases:
            source, *where = case if isinstance(case, tuple) else (case,)
            path = _path(source)
            if path is None:
                continue
            settings = {"slope": math.radians(10)} if fault == "no_friction" else {}
            with tempfile.TemporaryDirectory() as folder:
                tree = planted.expanded(path, Path(folder))
                planted.absolute(tree, path)
                if fault == "overlapping":
                    where.append(planted.into_neighbour(path, where[0]))
                getattr(planted, fault)(tree, *where)
                target = Path(folder) / "planted.urdf"
                tree.write(target)
                verdict = verdict_on(target, **settings)
            got = [fault.code for fault in verdict.faults if fault.fails]
            found += bool(kinds & set(got))
            said.append(f"{path.stem}: {', '.join(dict.fromkeys(got)) or 'stands'}")
            if not kinds & set(got):
                missed.append(path.stem)
        passed = ", ".join(missed) or "none"
        yield f"| {title} | {found} of {len(said)} | {passed} | {'; '.join(said)} |"


def _path(source: str | Path) -> Path | None:
    if isinstance(source, Path):
        return source
    try:
        data = importlib.import_module("pybullet_data")
    except ImportError:
        return None
    return Path(data.getDataPath()) / source


def main() -> None:
    """Print the table."""
    print("| fault | found in | passed | verdicts |\n|---|---|---|---|")
    for line in rows():
        print(line, flush=True)


if __name__ == "__main__":
    main()
