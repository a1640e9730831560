"""Configuration of an articulation for Isaac Lab, as a Python file next to the stage."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from ...model.elements import Joint, Robot
from ...model.kinematics import MOVABLE
from ...model.numbers import round_noise
from ...model.settings import RESISTANCE
from ...model.start import start_positions
from ..common.directory import mark_usda, write_beside
from ..common.srdf import read_srdf
from ..written import Written
from .bodies import Bodies, is_movable, make_bodies
from .contacts import is_self_colliding
from .home import Home, plan_home, plan_servos
from .inertials import make_inertias
from .joint_values import JointValues, choose_joint_values, read_joint_settings
from .names import Names, make_names
from .options import Options

_SIDES = re.compile(
    r"(?<![a-z])(left|right|front|rear|back|hind|[lr]|[fhr][lr])(?![a-z])|joint|\d+", re.IGNORECASE
)

_FIELDS = {
    2: ("effort_limit_sim", "velocity_limit_sim"),
    3: ("joint_effort_limit", "joint_velocity_limit"),
}
"""Names of the limits in the configuration of an actuator, by version of Isaac Lab."""


def write_config(
    robot: Robot,
    options: Options,
    stage: Path,
    file: Path,
    *,
    version: int,
    overwrite: bool,
) -> list[str]:
    """Write the configuration of an exported robot; return sentences on what was assumed.

    Raises:
        OutputError: The file cannot be written.
    """
    names = make_names(robot, robot.name or "robot")
    silent = Written("")
    srdf = None if options.srdf is None else read_srdf(options.srdf, robot, silent, None)
    bodies = make_bodies(robot, options.base, srdf.virtual_joint if srdf else None, silent)
    home = plan_home(bodies, make_inertias(bodies, options, silent)[0], options, srdf, silent)
    settings = read_joint_settings(bodies, options.actuator_config)
    servos = plan_servos(bodies, home, options, settings, silent)
    values = choose_joint_values(bodies, settings, servos, silent)
    config = _Config(bodies, names, values, home, version)
    path = os.path.relpath(stage.resolve(), file.resolve().parent)
    text = config.format(Path(path).as_posix(), self_collision=is_self_colliding(robot, options))
    source = Path(robot.source.path).name if robot.source is not None else "a robot"
    write_beside(
        file, {file.name: mark_usda(text.encode(), source)}, main=file.name, overwrite=overwrite
    )
    return config.assumptions


class _Config:
    """The text of a configuration.

    Attributes:
        assumptions: Sentences on values that the description does not have.
    """

    def __init__(
        self,
        bodies: Bodies,
        names: Names,
        values: Mapping[str, JointValues],
        home: Home,
        version: int,
    ) -> None:
        self._robot, self._bodies, self._names = bodies.robot, bodies, names
        self._values, self._home, self._version = values, home, version
        self.assumptions: list[str] = []
        joints = [j for j in bodies.joints if j.type in MOVABLE and is_movable(j)]
        written = {joint.name for joint in joints}
        self._followers = [
            joint for joint in joints if joint.mimic is not None and joint.mimic.joint in written
        ]
        self._joints = [joint for joint in joints if joint not in self._followers]

    def format(self, stage: str, *, self_collision: bool) -> str:
        """Return the text of the file."""
        name = re.sub(r"\W", "_", self._names.robot).upper()
        height = self._measure_height()
        rotation = "(0.0, 0.0, 0.0, 1.0)" if self._version == 3 else "(1.0, 0.0, 0.0, 0.0)"
        order = "(x, y, z, w)" if self._version == 3 else "(w, x, y, z)"
        lines = [
            f'"""Articulation of {self._names.robot} for Isaac Lab {self._version}."""',
            "",
            "from pathlib import Path",
            "",
            "import isaaclab.sim as sim_utils",
            "from isaaclab.actuators import ImplicitActuatorCfg",
            "from isaaclab.assets import ArticulationCfg",
            "",
            *self._format_orders(),
            "",
            f"{name}_CFG = ArticulationCfg(",
            "    spawn=sim_utils.UsdFileCfg(",
            f"        usd_path=str(Path(__file__).parent / {json.dumps(stage)}),",
            "        activate_contact_sensors=False,",
            "        articulation_props=sim_utils.ArticulationRootPropertiesCfg(",
            f"            enabled_self_collisions={self_collision},",
            "        ),",
            "    ),",
            "    init_state=ArticulationCfg.InitialStateCfg(",
            f"        pos=(0.0, 0.0, {height!r}),",
            f"        rot={rotation},  # {order}",
            "        joint_pos={",
            *self._format_positions(),
            "        },",
            '        joint_vel={".*": 0.0},',
            "    ),",
            "    soft_joint_pos_limit_factor=1.0,  # assumed: the limits of the description",
            "    actuators={",
            *self._format_actuators(),
            "    },",
            ")",
        ]
        return "\n".join(lines) + "\n"

    def _measure_height(self) -> float:
        """Return the height of a free base at which the lowest collision shape touches z = 0."""
        if not self._bodies.free:
            return 0.0
        self.assumptions.append("the base is at the height at which the lowest shape touches z = 0")
        return self._home.pose.translation[2] + 0.0

    def _format_positions(self) -> Iterator[str]:
        positions, moved = self._home.positions, start_positions(self._robot)[1]
        clipped = [joint.name for joint in self._joints
                   if moved.get(joint.name) == positions.get(joint.name, 0.0) != 0.0]  # fmt: skip
        for joint in (*self._joints, *self._followers):
            value = round_noise(positions.get(joint.name, 0.0))
            yield f"            {json.dumps(self._names.joint[joint.name])}: {value!r},"
        if clipped:
            shown = ", ".join(f"'{name}'" for name in clipped)
            self.assumptions.append(f"zero is outside of the limits of {shown}; they start at one")

    def _format_actuators(self) -> Iterator[str]:
        groups: dict[tuple[object, ...], list[Joint]] = {}
        for joint in self._joints:
            groups.setdefault((_find_stem(joint.name), *self._list_values(joint)), []).append(joint)
        taken: dict[str, int] = {}
        for (stem, *_), joints in groups.items():
            taken[str(stem)] = taken.get(str(stem), 0) + 1
            label = f"{stem}_{taken[str(stem)]}" if taken[str(stem)] > 1 else str(stem)
            yield from self._format_group(label, joints)
        for joint in self._followers:
            assert joint.mimic is not None
            leader = self._names.joint[joint.mimic.joint]
            yield f"        # {self._names.joint[joint.name]} follows {leader}"
        if len(groups) > 1:
            self.assumptions.append(
                f"{len(groups)} groups of actuators, by equal limits, damping, friction and "
                "armature, and by name"
            )
        if not any(self._values[joint.name].kp or self._values[joint.name].kd
                   for joint in self._joints):  # fmt: skip
            self.assumptions.append("stiffness and damping are those of the stage, which are zero")

    def _list_values(self, joint: Joint) -> tuple[float | None, ...]:
        """Return effort, velocity and resistance of a joint."""
        values = self._values[joint.name]
        return values.effort, values.velocity, *(values.resistance[r.name] for r in RESISTANCE)

    def _format_group(self, label: str, joints: list[Joint]) -> Iterator[str]:
        effort, velocity, viscous, dry, armature = self._list_values(joints[0])
        names = ", ".join(json.dumps(self._names.joint[joint.name]) for joint in joints)
        limits = _FIELDS[self._version]
        yield f"        {json.dumps(label)}: ImplicitActuatorCfg("
        yield f"            joint_names_expr=[{names}],"
        for field, value in (
            (limits[0], effort),
            (limits[1], velocity),
            ("friction", dry),
            ("dynamic_friction", dry),
            ("viscous_friction", viscous),
            ("armature", armature),
        ):
            if value:
                yield f"            {field}={value!r},"
        yield "            stiffness=None,  # that of the stage"
        yield "            damping=None,"
        yield "        ),"

    def _format_orders(self) -> Iterator[str]:
        """Yield comments with the order of joints in each simulator."""
        joints = [*self._joints, *self._followers]
        depth = {j.name: sum(1 for _ in self._robot.tree.list_ancestors(j.child)) for j in joints}
        wide = [self._names.joint[j.name] for j in sorted(joints, key=lambda j: depth[j.name])]
        yield f"# Order of joints, breadth first (PhysX; not run): {', '.join(wide)}"
        yield f"# Order of joints, depth first by name (Newton): {', '.join(self._list_deep())}"

    def _list_deep(self) -> list[str]:
        """Return the joints depth first, siblings by the name of their prims."""
        own = {joint.child: joint for joint in (*self._joints, *self._followers)}
        found: list[str] = []
        todo = [self._robot.tree.roots[0].name]
        while todo:
            link = todo.pop()
            if link in own:
                found.append(self._names.joint[own[link].name])
            below = self._robot.tree.get_child_joints(link)
            names = sorted(below, key=lambda j: self._names.joint[j.name], reverse=True)
            todo += [joint.child for joint in names]
        return found


def _find_stem(name: str) -> str:
    """Return a name without sides, numbers and the word joint."""
    words = [word for word in re.split(r"[\W_]+", _SIDES.sub(" ", name.replace("_", " "))) if word]
    return "_".join(words).lower() or "joints"
