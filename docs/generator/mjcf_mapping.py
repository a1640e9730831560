"""Mapping of URDF elements to MJCF, for the documentation.

Where the exporter has a table of its own, the rows are generated from it.
"""

from __future__ import annotations

from collections.abc import Iterable

from urdftool.formats.mjcf.gazebo import LOST, MISSING
from urdftool.formats.mjcf.loops import KINDS as CLOSERS
from urdftool.formats.mjcf.structure import KINDS
from urdftool.model.sensors import KINDS as SENSORS
from urdftool.model.sensors import SensorKind
from urdftool.model.settings import OF_JOINTS, OF_LINKS, RESISTANCE, SURFACE, Setting

EXACT, CLOSE, LOST_MARK = "=", "≈", "×"

Row = tuple[str, str, str]

_JOINT_TEXT = {
    "hinge": '`joint type="hinge"` (the default)',
    "slide": '`joint type="slide"`',
    "planar": "two slides `NAME_TX`, `NAME_TY` and a hinge `NAME_RZ`; limits are not exported",
    "free": "`freejoint`; its body is a child of the world, at its pose with all joints at zero",
    "ball": '`joint type="ball"`',
    "weld": "nothing: the body is nested without a joint, and never fused",
}


def _format_loops(kind: str) -> str:
    return ", ".join(name for name, made in CLOSERS.items() if made == kind)


ROBOT: tuple[Row, ...] = (
    (
        "`robot@name`",
        EXACT,
        "`mujoco@model`, the file's and the default class's name, without blanks and a version at "
        "its end; then the whole name is the text `robot_name` in `custom`",
    ),
    ("`robot/origin`", EXACT, "pose of the root body"),
    (
        "`link@name`",
        EXACT,
        "`body@name`: one body a link, also for fixed and massless ones; `site@name` with `--fuse`",
    ),
    ("root link `world`", EXACT, "`worldbody`; its mass is reported and not exported"),
    ("root link", EXACT, "a child of the world, or with `freejoint` (`--base`)"),
    (
        "`inertial`",
        EXACT,
        "`inertial` with `diaginertia` or `fullinertia`, numbers as written, without float noise",
    ),
    ("inconsistent inertia, welded", EXACT, "the surplus moves to a link of the same rigid body"),
    (
        "inconsistent inertia, moving",
        LOST_MARK,
        "lifted up to 1 %, else an error; `--fix-inertia` changes and reports it",
    ),
    ("no mass, moving", CLOSE, '2e-15 kg; a last link\'s joint gets `armature="0.0001"`'),
    ("`visual`", EXACT, '`geom class="visual"`, group 2, one for each material of a mesh'),
    (
        "`collision`",
        EXACT,
        '`geom class="collision"`, group 3; `class="foot"` of links named `foot`, `toe` or `sole`',
    ),
    (
        "`visual@name`, `collision@name`",
        EXACT,
        "`geom@name`, made unique by the link's name; a collision without name is `LINK_collision`",
    ),
    ("`box`, `cylinder`, `sphere`, `capsule`", EXACT, "the same, half sizes"),
    ("`drake:ellipsoid`, `drake:capsule`", EXACT, "`ellipsoid`, `capsule`"),
    ("a shape without size", LOST_MARK, "dropped"),
    (
        "`mesh` STL, OBJ",
        EXACT,
        "copied; converted where text, of several objects, over 200,000 triangles "
        "or with points of no face",
    ),
    (
        "`mesh` DAE, PLY, glTF",
        EXACT,
        "converted to OBJ, split by material, unit and axes as RViz has them",
    ),
    (
        "`mesh` of a collision",
        CLOSE,
        "MuJoCo uses the hull, reported if its volume is over 1.05 times that of the mesh; or "
        "convex pieces "
        "(`--decompose`)",
    ),
    ("flat `mesh` of a collision", CLOSE, "thickened to 0.1 % of its size"),
    ("`mesh@scale`", EXACT, "`mesh@scale`, mirrored ones too"),
    ("`material/color`", EXACT, "`material`, or `rgba` if it has no name"),
    ("`material/texture`", EXACT, "`texture`; PNG re-encoded, others converted"),
    (
        "colors and images of a mesh file",
        EXACT,
        "override the material of the URDF, as in RViz; other images than PNG are converted",
    ),
)

JOINT: tuple[Row, ...] = (
    ("`joint@name`, `origin`, `axis`", EXACT, "`joint@name`, pose of the body, `axis`"),
    ("`limit@lower`, `@upper`", EXACT, "`range`; absent ones count as 0, as URDF defines"),
    (
        "`limit` with lower = upper",
        EXACT,
        "the body is welded there, the name is a `site`; `--keep-locked-joints`: `equality`",
    ),
    ("no `limit`", CLOSE, "no `range`"),
    ("`limit@effort`", EXACT, "`actuatorfrcrange`; 0 cannot be exported and is reported"),
    ("`limit@velocity`", CLOSE, "number `NAME_velocity_limit` in `custom`"),
    ("`dynamics`", EXACT, ", ".join(f"`{row.mjcf_attribute}`" for row in RESISTANCE if row.path)),
    (
        "`mimic`",
        EXACT,
        '`equality/joint` with `polycoef="offset multiplier 0 0 0"` (soft, as all are); no '
        "actuator of its own",
    ),
    ("`safety_controller`, `calibration`", LOST_MARK, "settings of a controller"),
    (
        "`transmission`",
        CLOSE,
        "an actuator by its interface; `gear` is the reduction of an effort interface",
    ),
    (
        "`ros2_control` joint",
        CLOSE,
        "`position`, `velocity` or `motor` by its first command interface",
    ),
    ("`ros2_control` initial value", EXACT, "key `home`, clamped to the limits"),
    ("`ros2_control` sensor", CLOSE, "site at its `frame_id` and sensors by its interfaces"),
)

EXTENSIONS: tuple[Row, ...] = (
    (
        "`mujoco`",
        EXACT,
        "`option`, `size`, `visual`, `statistic`; `compiler` but for how to read URDF",
    ),
    (
        "gazebo `mu1`",
        CLOSE,
        "sliding `friction` of the link's collisions, below 1 with `priority`, as MuJoCo uses the "
        "larger of two and Gazebo the smaller; a different `mu2` is reported",
    ),
    ("gazebo `turnGravityOff`, `gravity`", EXACT, '`gravcomp="1"`'),
    ("gazebo `material`", CLOSE, "color of visuals that have none"),
    ("gazebo `springStiffness`, `springReference`", EXACT, "`stiffness`, `springref`"),
    ("gazebo `static`", EXACT, "the root is fixed"),
    (
        f"gazebo `joint` {_format_loops('connect')}",
        CLOSE,
        "`equality/connect`, for a hinge in space two; its limits and dynamics are reported",
    ),
    (f"gazebo `joint` {_format_loops('weld')}", CLOSE, "`equality/weld`"),
    ("gazebo `joint` of another type", LOST_MARK, "reported"),
    ("gazebo `light`", CLOSE, "`light`"),
    (
        "gazebo `plugin` that drives the robot",
        CLOSE,
        "the base is free; `velocity` for wheels, `position` for steering joints",
    ),
    ("any other gazebo `plugin`", LOST_MARK, "belongs to Gazebo"),
    ("SRDF `disable_collisions`", EXACT, "`exclude`, where MuJoCo would collide the pair"),
    ("SRDF `virtual_joint`", EXACT, "whether the base is free"),
    ("SRDF `group_state`", EXACT, "key `home`: the state of that name, or `--pose NAME`"),
)


def format_markdown() -> str:
    """Format the tables as Markdown for the documentation."""
    joints = [(f"`joint@type` {name}", EXACT, _JOINT_TEXT[kind]) for name, kind in KINDS.items()]
    sensors = [
        (f"sensor {_format_names((kind.type, *kind.others))}", CLOSE, _format_sensors(kind))
        for kind in SENSORS
        if kind.mjcf and kind.mjcf[0][0] not in ("touch", "rangefinder")
    ]
    cameras = [kind.type for kind in SENSORS if kind.section == "camera"]
    lidars = [kind.type for kind in SENSORS if kind.section == "lidar"]
    sensors.append(
        (f"sensor {_format_names(cameras)}", CLOSE, "`camera` with `fovy` and `resolution`")
    )
    sensors.append(
        (f"sensor {_format_names(lidars)}", CLOSE, "`rangefinder`s up to 36 rays, else its site")
    )
    sensors.append(
        ("sensor `contact`", CLOSE, "`touch` in a site over the link's first simple shape")
    )
    sensors.append(("any other sensor", LOST_MARK, "reported"))
    parameters = "parameters of sensors: noise, rate, topic, frame, clip"
    sensors.append((parameters, LOST_MARK, "`lossy-sensor-parameter`"))
    lost = [(_format_setting(row), LOST_MARK, MISSING[row.name].text)
            for row in (*SURFACE, *OF_LINKS, *OF_JOINTS) if row.name in MISSING]  # fmt: skip
    lost += [(f"gazebo `{tag}`", LOST_MARK, why) for tag, why in LOST.items()]
    parts = (
        ("Robot and links", ROBOT),
        ("Joints", (*joints, *JOINT)),
        ("Extensions", (*EXTENSIONS, *sensors, *lost)),
    )
    return "\n".join(_format_table(title, rows) for title, rows in parts)


def _format_setting(row: Setting) -> str:
    names = _format_names((*row.tags, row.path))
    return f"{row.name.replace('_', ' ')}: gazebo {names}"


def _format_sensors(kind: SensorKind) -> str:
    return "site with " + ", ".join(f"`{tag}`" for tag, _ in kind.mjcf)


def _format_names(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _format_table(title: str, rows: tuple[Row, ...]) -> str:
    lines = [f"### {title}", "", "| URDF | | MJCF |", "|---|---|---|"]
    lines += [f"| {urdf} | {mark} | {mjcf} |" for urdf, mark, mjcf in rows]
    return "\n".join([*lines, ""])
