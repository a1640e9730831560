"""Fixes of ``<gazebo>`` blocks."""

from __future__ import annotations

from ...model.elements import Link, Robot
from ...model.read import numbers
from ...source.document import Element
from ..cross_file_references import check_not_included
from ..gazebo.contact import contact_role
from ..gazebo.keywords import JOINT_KEYWORDS, LINK_KEYWORDS, NOT_IN_GZ, SURFACE
from ..gazebo.lumping import is_lumped, keeps_joint
from ..gazebo.sensors import Frameless, without_frame
from ..gazebo.tags import _colours, _lacks_material
from ..gazebo.wheel_pair import wheel_pair
from ..rule import Problem
from .proposal import (
    Around,
    Change,
    Proposal,
    after,
    attribute_at,
    depends_on_a_call,
    element_at,
    insert,
    is_computed,
    lines_of,
    meant,
    put,
    quote,
    remove,
    retag,
    safe,
    say,
    sub,
    to_write,
    unsafe,
    written,
)

_FRICTION = {"caster": "0.0"}


def dangling_reference(problem: Problem, around: Around) -> Proposal | None:
    """The link or joint that was meant."""
    name = meant(problem, problem.element.get("reference") or "")
    if not name:
        return None
    return unsafe(f"write '{name}'", put(problem.element, "reference", name))


def unknown_extension(problem: Problem, around: Around) -> Proposal | None:
    """The word that was meant."""
    element, word = element_at(problem), to_write(problem)
    if element is None or not word or not word.replace("_", "").isalnum():
        return None
    parent = element.parent
    if parent is None or parent.child(word) is not None or " and " in problem.message:
        return None
    return unsafe(f"write <{word}>", retag(element, word))


def misplaced_extension(problem: Problem, around: Around) -> Proposal | None:
    """At the joint or link that it is about; gone where that joint is fixed and lumped."""
    block, name = problem.element, problem.element.get("reference") or ""
    robot = around.robot
    if name in robot.link:
        joint = robot.tree.parent_joint(name)
        if joint is None or is_computed(joint.element):
            return None
        right, wrong = joint.name, JOINT_KEYWORDS
        children = [child for child in block.children if child.tag in wrong]
        if children and is_lumped(robot, name) and not any(map(keeps_joint, children)):
            return _emptied(block, JOINT_KEYWORDS)
    elif name in robot.joint:
        right, wrong = robot.joint[name].child, LINK_KEYWORDS
        if right not in robot.link or is_computed(robot.link[right].element):
            return None
    else:
        return None
    moved = [child for child in block.children if child.tag in wrong]
    if not right or not moved:
        return None
    if len(moved) == len(block.children):
        return unsafe(f"write it at '{right}'", put(block, "reference", right))
    lines = (
        f'<gazebo reference="{quote(right)}">',
        *(f"\t{line}" for child in moved for line in lines_of(child)),
        "</gazebo>",
    )
    return unsafe(f"write it at '{right}'", *map(remove, moved), after(block, *lines))


def surface_without_collision(problem: Problem, around: Around) -> Proposal | None:
    """Gone, where nothing is seen either; the block too, where nothing else is in it."""
    link = around.robot.link.get(problem.element.get("reference") or "")
    if link is None or link.visuals:
        return None  # the collision is what is missing
    return _emptied(problem.element, SURFACE)


def _emptied(block: Element, words: frozenset[str]) -> Proposal | None:
    gone = [child for child in block.children if child.tag in words]
    if len(gone) == len(block.children):
        return unsafe("take the block away", remove(block))
    return unsafe("take it away", *map(remove, gone))


def half_friction(problem: Problem, around: Around) -> Proposal | None:
    """The same in both directions."""
    element = element_at(problem)
    if element is None or element.tag not in ("mu1", "mu2"):
        return None
    other = "mu2" if element.tag == "mu1" else "mu1"
    text = quote((element.get("value") or element.text).strip())
    line = f'<{other} value="{text}"/>' if element.get("value") else f"<{other}>{text}</{other}>"
    return unsafe(f"write {line}", after(element, line))


def bad_extension_number(problem: Problem, around: Around) -> Proposal | None:
    """What Gazebo reads of it."""
    element = element_at(problem)
    number = problem.message.partition("of which Gazebo reads ")[2].partition(";")[0]
    if not number or element is None:
        return None
    if "value" in element.attributes:
        return safe(f"write {number}", put(element, "value", number))
    return safe(f"write {number}", say(element, number))


def deprecated_cfm_damping(problem: Problem, around: Around) -> Proposal | None:
    """By its new name."""
    element = element_at(problem)
    parent = element.parent if element is not None else None
    if element is None or parent is None or parent.child("implicitSpringDamper") is not None:
        return None
    return safe("write <implicitSpringDamper>", retag(element, "implicitSpringDamper"))


def no_effect_in_gz(problem: Problem, around: Around) -> Proposal | None:
    """Gone, all of it."""
    changes = []
    for block in around.robot.gazebo:
        if not block.reference:
            continue
        gone = [child for child in block.element.children if child.tag in NOT_IN_GZ]
        if gone and len(gone) == len(block.element.children):
            changes.append(remove(block.element))
        else:
            changes += map(remove, gone)
    return unsafe("take all of it away", *changes)


def missing_gazebo_material(problem: Problem, around: Around) -> Proposal | None:
    """The colour of the URDF, in its block."""
    link = around.link(problem)
    lines = _material(link, around.robot)
    blocks = around.robot.extensions.get(link.name)
    if lines is None or not blocks:
        return None
    block = blocks[0].element
    visual = block.child("visual")
    if visual is not None:
        return safe("write its colour", insert(visual, *lines))
    inside = ("<visual>", *(f"\t{line}" for line in lines), "</visual>")
    return safe("write its colour", insert(block, *inside))


def _material(link: Link, robot: Robot) -> tuple[str, ...] | None:
    """The colour of a link's visuals as SDF; None where they have several."""
    colours = _colours(robot)
    found = set()
    for visual in link.visuals:
        material = visual.material
        if material is not None and depends_on_a_call(link.element, "visual"):
            return None
        if material is not None and material.color is None:
            material = colours.get(material.name)
        found.add(None if material is None else material.color)
    if len(found) != 1 or (color := found.pop()) is None:
        return None
    text = " ".join(f"{part:.6g}" for part in color)
    return (
        "<material>",
        f"\t<ambient>{text}</ambient>",
        f"\t<diffuse>{text}</diffuse>",
        "</material>",
    )


def ogre_material_script(problem: Problem, around: Around) -> Proposal | None:
    """Gone wherever it stands, where the URDF has a colour for each of the links."""
    said = problem.message.partition("'")[2].partition("'")[0]
    changes = []
    for block in around.robot.gazebo:
        link = around.robot.link.get(block.reference or "")
        for element in block.element.walk():
            if element.tag == "script":
                uri = element.child("uri")
                named = uri is not None and uri.text.strip() == said
            else:
                value = (element.get("value") or element.text).strip()
                named = element.tag == "material" and value == said
            if not named:
                continue
            if link is None or _material(link, around.robot) is None:
                return None
            changes.append(remove(element))
    return safe("leave it to the colour of the URDF", *changes) if changes else None


def missing_friction(problem: Problem, around: Around) -> Proposal | None:
    """Rubber's, or none for a caster."""
    link = around.link(problem)
    role = contact_role(around.robot, link)
    blocks = around.robot.extensions.get(link.name)
    if not role or not blocks:
        return None
    mu = _FRICTION.get(role, "1.0")
    change = Change(
        "insert", blocks[0].element, blocks=((f"<mu1>{mu}</mu1>",), (f"<mu2>{mu}</mu2>",))
    )
    return unsafe(f"write mu1 and mu2 of {mu}", change)


def missing_gazebo_tags(problem: Problem, around: Around) -> Proposal | None:
    """A block with its friction, and its colour for Gazebo Classic."""
    if not isinstance(problem.subject, Link):
        return None
    link, robot = problem.subject, around.robot
    inside: list[str] = []
    role = contact_role(robot, link)
    if role:
        mu = _FRICTION.get(role, "1.0")
        inside += [f"<mu1>{mu}</mu1>", f"<mu2>{mu}</mu2>"]
    if "gazebo-classic" in around.targets and _lacks_material(robot, link, _colours(robot)):
        lines = _material(link, robot)
        if lines is not None:
            inside += ["<visual>", *(f"\t{line}" for line in lines), "</visual>"]
    if not inside:
        return None
    block = (
        f'<gazebo reference="{quote(written(link.element, "name"))}">',
        *(f"\t{line}" for line in inside),
        "</gazebo>",
    )
    return unsafe("add the block", after(link.element, *block))


def missing_contact_parameters(problem: Problem, around: Around) -> Proposal | None:
    """A stiffness of a million, a damping of a hundred, a millimetre of depth."""
    link = around.link(problem)
    lines = (("<kp>1e6</kp>",), ("<kd>100</kd>",), ("<minDepth>0.001</minDepth>",))
    blocks = around.robot.extensions.get(link.name)
    if blocks:
        return unsafe("write them", Change("insert", blocks[0].element, blocks=lines))
    block = (
        f'<gazebo reference="{quote(written(link.element, "name"))}">',
        *(f"\t{line}" for one in lines for line in one),
        "</gazebo>",
    )
    return unsafe("write them", after(link.element, *block))


def lumped_joint_loses_content(problem: Problem, around: Around) -> Proposal | None:
    """Kept."""
    block = problem.element
    if block.child("preserveFixedJoint") is not None:
        return None
    line = "<preserveFixedJoint>true</preserveFixedJoint>"
    return unsafe(f"write {line}", insert(block, line))


def lumped_flag_leaks(problem: Problem, around: Around) -> Proposal | None:
    """Gone."""
    element = element_at(problem)
    if element is None:
        return None
    return _emptied(problem.element, frozenset((element.tag,)))


def named_geometry_loses_extensions(problem: Problem, around: Around) -> Proposal | None:
    """Put the name of its link in front, where nothing names it; friction applies from then on."""
    found = attribute_at(problem)
    link = around.link(problem)
    if found is None:
        return None
    element, attribute = found
    name = element.get(attribute) or ""
    if name in around.texts:
        return None
    new = f"{link.name}_{name}"
    return unsafe(f"call it '{new}'", put(element, attribute, new))


def lumped_link_referenced(problem: Problem, around: Around) -> Proposal | None:
    """By the name it will have."""
    element = element_at(problem)
    new = problem.message.partition("will be called '")[2].partition("'")[0]
    if element is None or not new:
        return None
    return unsafe(f"write {new}", say(element, new))


def root_not_anchored(problem: Problem, around: Around) -> Proposal | None:
    """Add a link ``world`` and a fixed joint to it, where no other robot includes the arm."""
    robot = around.robot
    root = robot.tree.root
    if root is None or "world" in robot.link or "world_joint" in robot.joint:
        return None
    if is_computed(root.element):
        return None
    check_not_included(around)
    blocks = (
        ('<link name="world"/>',),
        (
            '<joint name="world_joint" type="fixed">',
            '\t<parent link="world"/>',
            f'\t<child link="{quote(root.name)}"/>',
            "</joint>",
        ),
    )
    return unsafe("fix it to a link 'world'", Change("first", robot.element, blocks=blocks))


def missing_control_plugin(problem: Problem, around: Around) -> Proposal | None:
    """Add one that reports the joints in new Gazebo; that of ros_control in Gazebo Classic.

    A pair of wheels on one axle gets a differential drive in new Gazebo. An end effector that
    another robot includes is driven by the plugin of that robot.
    """
    if {"gz", "gazebo-classic"} <= around.targets:
        return None
    check_not_included(around)
    if "gz" not in around.targets:
        if not around.robot.transmissions:
            return None
        control = '\t<plugin name="gazebo_ros_control" filename="libgazebo_ros_control.so"/>'
        lines = ("<gazebo>", control, "</gazebo>")
        return unsafe("add that of ros_control", insert(around.robot.element, *lines))
    report = (
        '\t<plugin filename="gz-sim-joint-state-publisher-system"'
        ' name="gz::sim::systems::JointStatePublisher"/>'
    )
    reported = any("joint-state-publisher" in one.filename for one in around.robot.plugins)
    pair = wheel_pair(around.robot)
    systems = [] if reported else [report]
    what = "" if reported else "a joint state publisher"
    if pair is not None:
        systems += [
            '\t<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">',
            f"\t\t<left_joint>{quote(pair.left.name)}</left_joint>",
            f"\t\t<right_joint>{quote(pair.right.name)}</right_joint>",
            f"\t\t<wheel_separation>{pair.separation:.6g}</wheel_separation>",
            f"\t\t<wheel_radius>{pair.radius:.6g}</wheel_radius>",
            "\t</plugin>",
        ]
        what = " and ".join(filter(None, ("a differential drive", what)))
    return unsafe(f"add {what}", insert(around.robot.element, "<gazebo>", *systems, "</gazebo>"))


def unknown_sensor_type(problem: Problem, around: Around) -> Proposal | None:
    """The type that was meant."""
    name = meant(problem, problem.element.get("type") or "")
    return unsafe(f"write {name}", put(problem.element, "type", name)) if name else None


def cpu_ray_in_gz(problem: Problem, around: Around) -> Proposal | None:
    """Write the one of the graphics card, which Gazebo Classic does not know."""
    sensor = problem.element
    changes = [put(sensor, "type", "gpu_lidar")]
    if sensor.child("lidar") is None:
        changes += [retag(child, "lidar") for child in sensor.all("ray")]
    return unsafe("write gpu_lidar", *changes)


def ros_plugin_inside_sensor(problem: Problem, around: Around) -> Proposal | None:
    """A topic in the place of the plugin."""
    sensor = problem.element
    plugins = [p for p in sensor.all("plugin") if "libgazebo_ros_" in (p.get("filename") or "")]
    if len(plugins) != 1:
        return None
    plugin = plugins[0]
    words = ("topicName", "topic_name", "imageTopicName", "topic")
    texts = [child.text.strip() for word in words for child in plugin.all(word)]
    for argument in plugin.walk():
        if argument.tag == "remapping" and ":=" in argument.text:
            texts.append(argument.text.partition(":=")[2].strip())
    topic = next((text for text in texts if text), (sensor.get("name") or "").strip())
    if not topic or "$" in topic:
        return None
    changes: list[Change] = [remove(plugin)]
    if sensor.child("topic") is None:
        changes.append(after(plugin, f"<topic>{quote(topic)}</topic>"))
    return unsafe(f"write <topic>{topic}</topic>", *changes)


def missing_gz_frame_id(problem: Problem, around: Around) -> Proposal | None:
    """The link where the sensor is, and that of all others where they are one finding."""
    found = [one for one in without_frame(around.robot) if one.frame is not None]
    if " more) " not in problem.message:
        found = [one for one in found if one.sensor.element is problem.element]
    changes = []
    for one in found:
        name = _name_of_frame(one)
        if name is None:
            return None
        line = f"<gz_frame_id>{quote(name)}</gz_frame_id>"
        changes.append(insert(one.sensor.element, line))
    if not changes or "add one there" in problem.message:
        return None
    more = " and so on" if len(changes) > 1 else ""
    return safe(f"write {changes[0].blocks[0][0]}{more}", *changes)


def _name_of_frame(one: Frameless) -> str | None:
    """Write the name of a sensor's frame as the source does; None where it is made elsewhere."""
    block, frame = one.sensor.element.parent, one.frame
    if frame is None or block is None:
        return None
    if frame is one.link:
        return written(block, "reference") or None
    if is_computed(frame.element) and frame.element.calls != one.sensor.element.calls:
        return None
    return written(frame.element, "name") or None


def _has_pose(sensor: Element) -> bool:
    """Tell whether a sensor stands elsewhere than the frame of its link."""
    pose = sensor.child("pose")
    return pose is not None and (bool(pose.attributes) or numbers(pose.text, 6) != (0.0,) * 6)


def camera_sensor_not_optical(problem: Problem, around: Around) -> Proposal | None:
    """The optical frame."""
    sensor = problem.element
    written = problem.message.partition("publishes in '")[2].partition("'")[0]
    optical = problem.message.partition("its optical frame is '")[2].partition("'")[0]
    tags = ("frameName", "frame_name", "gz_frame_id", "ignition_frame_id")
    for element in sensor.walk():
        if element.tag in tags and element.text.strip() == written and optical:
            return unsafe(f"publish in '{optical}'", say(element, optical))
    return None


def duplicate_sensor_name(problem: Problem, around: Around) -> Proposal | None:
    """A number behind the second."""
    taken = {s.name for block in around.robot.gazebo for s in block.sensors}
    return _numbered(problem, taken)


def duplicate_plugin_name(problem: Problem, around: Around) -> Proposal | None:
    """A number behind the second."""
    return _numbered(problem, {plugin.name for plugin in around.robot.plugins})


def _numbered(problem: Problem, taken: set[str]) -> Proposal | None:
    found = attribute_at(problem)
    if found is None:
        return None
    name = (found[0].get(found[1]) or "").strip()
    number = 2
    while f"{name}_{number}" in taken:
        number += 1
    return unsafe(f"call it '{name}_{number}'", sub(*found, r"(?<=\S)(?=\s*$)", f"_{number}"))
