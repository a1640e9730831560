"""Step robots as exported to MJCF without options: ``python -m measure.standing [URDF...]``.

Without arguments, all robots of example-robot-data and pybullet_data are exported as
``urdftool export mjcf`` does, and stepped in MuJoCo from the key ``home`` for 2 s, at the step that
the model has and at 5 ms. A line for each robot says what is wrong; the last lines count. These
steps share no code with the row ``runs`` of the export's proof, which is run beside them.
``--simulate`` also runs ``urdftool simulate`` in MuJoCo, and counts the robots of which it and the
row say that they stand, or that they do not, by the definition in ``mechanics.standing``.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from measure.benchmarks.robots import bullet_robots, example_folder, example_robots

SECONDS, BEYOND, DRIFT, TILT = 2.0, 0.01, 0.02, 3.0
"""Simulated time [s]; tolerance of limits [rad or m]; motion [m] and tilt [°] of a free base."""


@dataclass
class Outcome:
    """What became of one robot.

    Attributes:
        name: Its folder and file.
        refused: Why it is not exported.
        is_free: Whether its base is free.
        is_driven: Whether it has a servo.
        faults: Sentences on the stepped export, by step [s].
        stands: What the definition of a robot that stands says of the row ``runs``, at the step
            that is written.
        sentence: What that row says of its base and joints.
        simulated: What ``simulate`` says; None if it was not run.
        simulated_stands: Whether the robot stands there.
        unsimulated: Why ``simulate`` refuses it.
    """

    name: str
    refused: str = ""
    is_free: bool = False
    is_driven: bool = False
    faults: dict[float, list[str]] = field(default_factory=dict)
    stands: bool = False
    sentence: str = ""
    simulated: str | None = None
    simulated_stands: bool = False
    unsimulated: str = ""


def try_robot(path: Path, choices: Mapping[str, Any], simulates: bool = False) -> Outcome:
    """Export a robot and step it, and run ``simulate``."""
    from urdftool import export_mjcf, load
    from urdftool.errors import UrdftoolError
    from urdftool.formats.mjcf.verify_runs import run_at_home

    share = example_folder()
    paths = [path.parent] if share is None else [path.parent, share.parent]
    outcome = Outcome(f"{path.parent.name}/{path.stem}")
    with tempfile.TemporaryDirectory() as folder:
        try:
            robot = load(path, package_paths=paths)
            try:
                export_mjcf(robot, f"{folder}/m.xml", scene=True, **choices)
            except UrdftoolError:
                export_mjcf(
                    robot, f"{folder}/m.xml", scene=True, force=True, overwrite=True, **choices
                )
        except (UrdftoolError, ValueError) as error:
            outcome.refused = " ".join(str(error).split())
            return outcome
        scene = Path(folder) / "m_scene.xml"
        step(scene, outcome)
        trial = run_at_home(scene, next(iter(outcome.faults)))
        outcome.stands = trial.motion.stands
        outcome.sentence = "; ".join((*trial.list_faults(), *trial.describe_joints()))
    if simulates:
        _simulate(robot, outcome)
    return outcome


def _simulate(robot: Any, outcome: Outcome) -> None:
    """Run ``simulate`` in MuJoCo, on the base that the export has."""
    from urdftool import simulate
    from urdftool.errors import UrdftoolError
    from urdftool.simulation.settings import Settings

    settings = Settings(fixed_base=not outcome.is_free, time_limit=120)
    try:
        verdict = simulate(robot, settings, engine="mujoco")[0]
    except UrdftoolError as error:
        outcome.unsimulated = " ".join(str(error).split())
        return
    outcome.simulated_stands = verdict.stands
    texts = (
        *verdict.motion.describe_base(),
        *(text for text, _ in verdict.motion.describe_joints()),
    )
    codes = sorted({fault.code for fault in verdict.faults if fault.fell})
    outcome.simulated = "; ".join((*codes, *texts)) or "stands"


def step(scene: Path, outcome: Outcome) -> None:
    """Step a scene at its own step and at 5 ms, and note what is wrong."""
    import mujoco

    warned: list[str] = []
    mujoco.set_mju_user_warning(lambda text: warned.append(text.partition("Time =")[0].strip()))
    model = mujoco.MjModel.from_xml_path(str(scene))
    for timestep in dict.fromkeys((float(model.opt.timestep), 0.005)):
        warned.clear()
        model.opt.timestep = timestep
        outcome.faults[timestep] = list(_run(mujoco, model, outcome))
        outcome.faults[timestep] += dict.fromkeys(warned)


def _run(mujoco: Any, model: Any, outcome: Outcome) -> Any:
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    free = np.flatnonzero(model.jnt_type == int(mujoco.mjtJoint.mjJNT_FREE))
    base = int(model.jnt_bodyid[free[0]]) if len(free) else 0
    outcome.is_free = bool(len(free))
    servo = (model.actuator_biastype == int(mujoco.mjtBias.mjBIAS_AFFINE)).sum()
    outcome.is_driven = bool(servo)
    start, upright = np.array(data.xpos[base]), data.xmat[base].reshape(3, 3).copy()
    single = model.jnt_type >= int(mujoco.mjtJoint.mjJNT_SLIDE)
    limited = np.flatnonzero(single & (model.jnt_limited > 0))
    at, (low, high) = model.jnt_qposadr[limited], model.jnt_range[limited].T
    beyond = np.zeros(len(limited))
    for _ in range(round(SECONDS / model.opt.timestep)):  # a reset of the state resets the time
        mujoco.mj_step(model, data)
        if not np.isfinite(data.qpos).all():
            yield "the state is not finite"
            return
        beyond = np.maximum(beyond, np.maximum(low - data.qpos[at], data.qpos[at] - high))
    for index in np.flatnonzero(beyond > BEYOND):
        yield f"joint '{model.joint(int(limited[index])).name}' leaves by {beyond[index]:.2g}"
    drift = float(np.linalg.norm(data.xpos[base] - start))
    turn = (data.xmat[base].reshape(3, 3) @ upright.T)[2, 2]
    tilt = float(np.degrees(np.arccos(np.clip(turn, -1, 1))))
    if drift >= DRIFT or tilt >= TILT:
        yield f"the base moves by {drift:.3f} m and tilts by {tilt:.1f}°"


def main(arguments: list[str]) -> int:
    """Print what is wrong with each robot, and the counts."""
    parser = argparse.ArgumentParser(prog="python -m measure.standing", description=__doc__)
    parser.add_argument("robots", nargs="*", type=Path, help="Descriptions; default: all.")
    parser.add_argument("--only", default="", metavar="WORD", help="Part of the path of a robot.")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="Worker processes.")
    parser.add_argument("--actuators", help="As export mjcf has it.")
    parser.add_argument("--simulate", action="store_true", help="Run simulate, too.")
    parser.add_argument("--part", default="1/1", metavar="K/N", help="The K-th of N parts.")
    given = parser.parse_args(arguments)
    choices = {"actuators": given.actuators} if given.actuators else {}
    every = given.robots or [*example_robots(), *bullet_robots()]
    paths = [path for path in every if given.only in str(path)]
    part, parts = map(int, given.part.split("/"))
    paths = paths[part - 1 :: parts]
    work = partial(try_robot, choices=choices, simulates=given.simulate)
    counts: Counter[str] = Counter()
    with ProcessPoolExecutor(given.jobs) as pool:
        for outcome in pool.map(work, paths):
            _count(outcome, counts)
            kind = "free" if outcome.is_free else "fixed"
            lines = [outcome.refused] if outcome.refused else []
            lines += [f"{s * 1000:g} ms: {text}" for s, of in outcome.faults.items() for text in of]
            lines += [f"runs: {outcome.sentence}"] * bool(outcome.sentence)
            lines += _describe_simulation(outcome)
            print(f"- {outcome.name} ({kind})" + "".join(f"\n    - {x[:160]}" for x in lines))
            sys.stdout.flush()
    for name, count in counts.items():
        print(f"{name}: {count}")
    return 0


def _describe_simulation(outcome: Outcome) -> list[str]:
    """Say what ``simulate`` finds, and whether the stepped export does not agree."""
    if outcome.unsimulated:
        return [f"simulate refuses: {outcome.unsimulated}"]
    if outcome.simulated is None:
        return []
    shown = outcome.simulated != "stands" or not agrees(outcome)
    return [f"simulate: {outcome.simulated}"] * shown + ["DIFFER"] * (not agrees(outcome))


def agrees(outcome: Outcome) -> bool:
    """Tell whether ``simulate`` and the export at its own step both stand, or both do not."""
    return outcome.stands == outcome.simulated_stands


def _count(outcome: Outcome, counts: Counter[str]) -> None:
    if outcome.refused:
        counts["refused"] += 1
        return
    own, coarse = (list(outcome.faults.values()) * 2)[:2]
    counts["exported"] += 1
    counts["simulated"] += outcome.simulated is not None
    counts["simulated, stands or not as exported"] += outcome.simulated is not None and agrees(
        outcome
    )
    counts["no fault at the step written"] += not own
    counts["moves here, but the row runs says nothing"] += bool(own) and not outcome.sentence
    counts["with a free base"] += outcome.is_free
    counts["with a free base, no fault at the step written"] += outcome.is_free and not own
    counts["no warning, no NaN at 5 ms"] += not [
        text for text in coarse if not text.startswith(("joint", "the base"))
    ]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
