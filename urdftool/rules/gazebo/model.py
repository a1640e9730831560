"""Rules on the whole model in Gazebo."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Joint, Link, Robot
from ...model.kinematics import MOVABLE
from ...model.settings import is_set
from ...source.description import Description
from ...source.document import parse, parse_once
from ...source.xacro_names import CONDITIONS
from ..control.dependence import OF_GAZEBO, depends_on_control
from ..cross_file_references import check_not_included
from ..fix import Change, FixContext, Proposal, append_child, escape_attribute, is_computed, unsafe
from ..joint.range import is_locked
from ..renaming import get_part, rename_part
from ..rule import ERROR, GAZEBO, INFO, UNSAFE, WARNING, Problem, rule
from ..tree.mounted import is_arm
from ..words import quote
from .wheel_pair import find_wheel_pair


@rule(
    INFO,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "make the model static: no joint moves",
    },
)
def robot_level_static(robot: Robot) -> Iterator[Problem]:
    """A robot with joints is static.

    ``<gazebo><static>true`` makes the whole model static: nothing falls, and no joint moves, even
    with a controller. To fix only the base, add a fixed joint to a link named ``world``.
    """
    static = robot.settings.get("static")
    if static is not None and static.content and robot.moving_joints:
        yield Problem(
            static.xml.parent if static.xml is not None and static.xml.parent else robot,
            "the model is static, so no joint moves; fix the base to a link 'world' instead",
            at=static,
        )


@rule(
    INFO,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "turn gravity off for each link: the robot floats",
    },
)
def gravity_off_everywhere(robot: Robot) -> Iterator[Problem]:
    """Gravity is off for all links with mass.

    ``turnGravityOff`` on every link prevents that a robot falls, and is often left over from a
    test. The simulated controllers then carry no weight.
    """
    heavy = [link.name for link in robot.links if link.mass > 0]
    off = [name for name in heavy if robot.link[name].is_weightless]
    if heavy and len(heavy) == len(off):
        yield Problem(
            robot,
            f"gravity is off for all {len(heavy)} links with mass, so the robot floats",
            at=robot.link[off[0]].settings["gravity"],
        )


@rule(
    ERROR,
    on=(*GAZEBO, "mujoco"),
    effects={
        "gz, gazebo-classic": (
            "reject the model (Error 3: reserved), unless the link is merged into another "
            "(sdformat 12.3)"
        ),
        "mujoco (world)": "rejects the robot: it takes the link for its world",
    },
)
def reserved_name(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """A robot, link or joint has a name that SDF reserves.

    ``world`` is the fixed world and may only be the root: Gazebo rejects the robot, and so does
    MuJoCo if a joint moves the link. Names with two underscores at both ends, such as
    ``__model__``, are reserved in SDF only.
    """
    parts: list[Robot | Link | Joint] = [robot, *robot.links, *robot.joints]
    for part in parts:
        name = part.name
        is_framed = len(name) > 4 and name.startswith("__") and name.endswith("__")
        if is_framed and not targets.isdisjoint(GAZEBO):
            yield Problem(
                part,
                f"name '{name}' is reserved in SDF; remove the underscores",
                at=part.locate_attribute("name"),
            )
    joint = robot.tree.get_parent_joint("world") if "world" in robot.link else None
    if joint is not None and not (joint.is_fixed and targets.isdisjoint(GAZEBO)):
        link = robot.link["world"]
        yield Problem(
            link,
            "link 'world' is not the root, but the name is reserved for the fixed world; rename it",
            at=link.locate_attribute("name"),
            effects=("gz, gazebo-classic", *["mujoco (world)"] * (not joint.is_fixed)),
        )


_DRIVES = re.compile(
    r"control|drive|joint|steer|trajectory|planar|velocity|wheel|thruster|rotor|motor|gripper",
    re.IGNORECASE,
)

_SENSES = re.compile(
    r"(?<![a-z])(camera|kinect|depth|laser|lidar|ray|imu|gps|sonar|range|bumper|contact|ft|force|"
    r"p3d|magnetometer|sensors?)(?![a-z])",
    re.IGNORECASE,
)
"""Libraries of sensors and of ground truth, which show nothing about drives."""

_REPORTS = re.compile(r"joint[-_]?state", re.IGNORECASE)


@reserved_name.fix(UNSAFE, renames=True)
def rename_reserved(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the underscores; write ``world_link`` for a ``world`` that is not the root."""
    part = get_part(problem)
    if part is None:
        return None
    return rename_part(
        context, part, "world_link" if part.name == "world" else part.name.strip("_")
    )


@rule(
    WARNING,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "load the robot, but nothing drives its joints",
    },
    pedantic="files without a plugin in packages that do not depend on a control plugin of Gazebo",
)
def missing_control_plugin(
    robot: Robot, description: Description, targets: frozenset[str], guessed: frozenset[str]
) -> Iterator[Problem]:
    """Joints move, but no plugin controls them or publishes their state.

    In Gazebo a joint without a plugin moves freely: an arm collapses after spawning. Without joint
    states RViz has no transforms of the links. Joints with equal limits are ignored, and robots
    with a part for Gazebo in a xacro condition are not reported. For a robot with two wheels on one
    axle about its y axis, the message has the parameters of a differential drive.

    A plugin in an XML comment counts as one that the author left out. A file whose plugins are all
    of sensors is reported as one without; a file without plugins but with transmissions or
    ``<ros2_control>`` is an info, and off by default without such a dependency.

    A file without plugins, transmissions and ``<ros2_control>`` is not reported, because a world,
    a wrapper or a program may add the plugin, nor one without plugins that only a ``<gazebo>`` tag
    shows to be for Gazebo: unless its package depends on a control plugin of
    Gazebo (an info), or it has such a pair of wheels and more than a ``<gazebo>`` tag shows that it
    is for new Gazebo.
    """
    joints = [
        joint
        for joint in robot.moving_joints
        if joint.mimic is None and joint.type in MOVABLE and not is_locked(joint)
    ]
    if not joints:
        return
    plugins = [
        f"{plugin.filename} {plugin.name}" for block in robot.gazebo for plugin in block.plugins
    ]
    plugins += [element.attributes["plugin"] for element in robot.old_plugins]
    if not plugins and _has_gazebo_part(description):
        return
    acting = [text for text in plugins if _DRIVES.search(text)]
    reported = any(_REPORTS.search(text) for text in acting)
    if any(not _REPORTS.search(text) for text in acting) or _has_commented_plugin(description):
        return
    plugins = [text for text in plugins if not _SENSES.search(text.partition(" ")[0])]
    pair = find_wheel_pair(robot) if "gz" in targets - guessed else None
    controls = robot.transmissions or robot.ros2_controls
    is_named = not targets.isdisjoint(GAZEBO) and targets.isdisjoint(guessed)
    is_driven = bool(plugins or (is_named and controls)) or pair is not None
    if (reported and pair is None) or not (is_driven or depends_on_control(description, OF_GAZEBO)):
        return
    if pair is not None:
        joints = [pair.left, pair.right]
    names = quote(joint.name for joint in joints)
    which, verb = ("joints", "move") if len(joints) > 1 else ("joint", "moves")
    if pair is None:
        remedy = "one, such as ros2_control or a joint state publisher"
    else:
        remedy = (
            f"gz-sim-diff-drive-system with <left_joint>{pair.left.name}</left_joint>, "
            f"<right_joint>{pair.right.name}</right_joint>, "
            f"<wheel_separation>{pair.separation:.4g}</wheel_separation> and "
            f"<wheel_radius>{pair.radius:.4g}</wheel_radius>"
        )
    acts = "drives them" if reported else "drives any joint or publishes its state"
    data: dict[str, object] = {"joints": [joint.name for joint in joints]}
    if pair is not None:
        data |= {"wheel_separation": pair.separation, "wheel_radius": pair.radius}
    message = f"{which} {names} {verb}, but no Gazebo plugin {acts}; add {remedy}"
    is_complete = bool(plugins) or pair is not None
    is_expected = is_complete or depends_on_control(description, OF_GAZEBO)
    severity = None if is_complete else INFO
    yield Problem(robot, message, data=data, severity=severity, pedantic=not is_expected)


@missing_control_plugin.fix(UNSAFE)
def add_control_plugin(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a joint state publisher for new Gazebo, or gazebo_ros_control for Gazebo Classic.

    A pair of wheels on one axle gets a differential drive in new Gazebo. gazebo_ros_control is
    added only if the package depends on it. A robot that other robots include is not changed,
    because they have the plugin.
    """
    if {"gz", "gazebo-classic"} <= context.targets:
        return None
    check_not_included(context)
    if "gz" not in context.targets:
        if not context.robot.transmissions or not depends_on_control(context.description):
            return None
        control = '\t<plugin name="gazebo_ros_control" filename="libgazebo_ros_control.so"/>'
        lines = ("<gazebo>", control, "</gazebo>")
        return unsafe("add gazebo_ros_control", append_child(context.robot.element, *lines))
    report = (
        '\t<plugin filename="gz-sim-joint-state-publisher-system"'
        ' name="gz::sim::systems::JointStatePublisher"/>'
    )
    reported = any("joint-state-publisher" in one.filename for one in context.robot.plugins)
    pair = find_wheel_pair(context.robot)
    systems = [] if reported else [report]
    what = "" if reported else "a joint state publisher"
    if pair is not None:
        systems += [
            '\t<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">',
            f"\t\t<left_joint>{escape_attribute(pair.left.name)}</left_joint>",
            f"\t\t<right_joint>{escape_attribute(pair.right.name)}</right_joint>",
            f"\t\t<wheel_separation>{pair.separation:.6g}</wheel_separation>",
            f"\t\t<wheel_radius>{pair.radius:.6g}</wheel_radius>",
            "\t</plugin>",
        ]
        what = " and ".join(filter(None, ("a differential drive", what)))
    return unsafe(
        f"add {what}", append_child(context.robot.element, "<gazebo>", *systems, "</gazebo>")
    )


def _has_commented_plugin(description: Description) -> bool:
    """Tell whether a plugin that may drive joints is in a comment of a file."""
    return any(
        "<plugin" in comment.text and _DRIVES.search(comment.text)
        for file in description.files
        for comment in parse_once(file).comments
    )


_FOR_GAZEBO = re.compile(r"gazebo|(?<![a-z])(gz|ign|sim)(?![a-z])", re.IGNORECASE)


def _has_gazebo_part(description: Description) -> bool:
    """Tell whether a xacro condition contains an include or element for Gazebo."""
    if description.expansion is None:
        return False
    return any(
        part.tag == "gazebo" or _FOR_GAZEBO.search(part.get("filename") or "")
        for file in description.files
        for element in parse(file).root.walk()
        if element.tag in CONDITIONS
        for part in element.walk()
    )


@rule(
    INFO,
    on=GAZEBO,
    effects={
        "gz, gazebo-classic": "load the robot as a free body",
    },
    infos=True,
    pedantic="robots without a plugin, which nothing moves in Gazebo",
)
def root_not_anchored(robot: Robot) -> Iterator[Problem]:
    """A robot without wheels and legs is not fixed to the world.

    Gazebo loads the root of a robot as a free body, so an arm without wheels or legs falls over
    when it moves. Add a link named ``world`` and a fixed joint. A robot with root
    ``base_footprint``, or with a wheel, caster or leg by name, is mobile and not reported. A robot
    without a plugin is off by default.
    """
    root = robot.tree.root
    if root is None or root.name == "world" or is_set(robot.settings, "static"):
        return
    if is_arm(robot):
        yield Problem(
            robot,
            f"root '{root.name}' of '{robot.name}', which has no wheel or leg, is not fixed to the "
            "world, so its base moves freely; add a link 'world' and a fixed joint",
            at=root,
            data={"link": root.name},
            pedantic=not any(element.tag == "plugin" for element in robot.element.walk()),
        )


@root_not_anchored.fix(UNSAFE)
def anchor_root(problem: Problem, context: FixContext) -> Proposal | None:
    """Add a link ``world`` and a fixed joint, if no other robot includes the arm."""
    robot = context.robot
    root = robot.tree.root
    if root is None or "world" in robot.link or "world_joint" in robot.joint:
        return None
    if is_computed(root.element):
        return None
    check_not_included(context)
    blocks = (
        ('<link name="world"/>',),
        (
            '<joint name="world_joint" type="fixed">',
            '\t<parent link="world"/>',
            f'\t<child link="{escape_attribute(root.name)}"/>',
            "</joint>",
        ),
    )
    return unsafe("fix it to a link 'world'", Change("first", robot.element, blocks=blocks))
