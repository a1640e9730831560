"""Mirror images of parts that a robot has in addition to the other one, such as a second arm."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import replace

import numpy as np

from ..errors import ConfigError
from ..mechanics.reference import Array, Mechanics, get_origin_matrix
from ..model.elements import Joint, Robot
from ..model.urdf_schema import BLOCKS
from ..source.document import Element
from .conventions import make_origin, mirror_joint, mirror_link
from .correspondence import PLANES, Image
from .frames import invert


def add_images(robot: Robot, images: Sequence[Image]) -> Robot:
    """Return the robot with mirror images of some links and joints at a plane of the root.

    A link frame R becomes S R S, with the reflection S, when all positions are zero. A joint whose
    parent has no image is fixed to that parent. Positions and limits of the images keep their
    values. Blocks of simulators and controllers that are about such a link or joint are copied
    with the names of the images, except for elements with a pose.

    Raises:
        ConfigError: A link or joint does not exist, the name of an image does, or the link of a
            joint has no image.
    """
    if not images:
        return robot
    links = {i.name: i.image for i in images if i.kind == "link"}
    joints = {i.name: i.image for i in images if i.kind == "joint"}
    _check_names(robot, links, joints)
    index = PLANES[images[0].plane]
    flip = np.eye(4)
    flip[index, index] = -1.0
    frames = Mechanics(robot).compute_frames({})
    new_links = [
        replace(mirror_link(robot.link[name], flip, index), name=new) for name, new in links.items()
    ]
    new_joints = [
        _make_joint(robot.joint[name], new, flip, frames, (links, joints))
        for name, new in joints.items()
    ]
    made = replace(robot, links=[*robot.links, *new_links], joints=[*robot.joints, *new_joints])
    others = {i.name: i.image for i in images if i.kind == "part"}
    if robot.xml is None:
        return made
    return replace(made, provenance=_copy_blocks(robot.xml, {**links, **joints}, others))


def _check_names(robot: Robot, links: Mapping[str, str], joints: Mapping[str, str]) -> None:
    for kind, known, names in (("link", robot.link, links), ("joint", robot.joint, joints)):
        for name, new in names.items():
            if name not in known:
                raise ConfigError(
                    f"{kind} '{name}' of the correspondence is not in robot '{robot.name}'"
                )
            if new in known:
                raise ConfigError(f"{kind} '{new}' of the correspondence is in both robots")
    for name in joints:
        if robot.joint[name].child not in links:
            child = robot.joint[name].child
            raise ConfigError(f"joint '{name}' has an image, but not its link '{child}'")


def _make_joint(
    joint: Joint,
    name: str,
    flip: Array,
    frames: Mapping[str, Array],
    names: tuple[Mapping[str, str], Mapping[str, str]],
) -> Joint:
    links, joints = names
    made = mirror_joint(joint, flip)
    if joint.parent not in links:
        frame = frames[joint.parent]
        pose = invert(frame) @ flip @ frame @ get_origin_matrix(joint.origin) @ flip
        made = replace(made, origin=make_origin(pose, joint.origin))
    mimic = joint.mimic and replace(
        joint.mimic, joint=joints.get(joint.mimic.joint, joint.mimic.joint)
    )
    parent, child = links.get(joint.parent, joint.parent), links[joint.child]
    return replace(made, name=name, parent=parent, child=child, mimic=mimic)


def _copy_blocks(root: Element, names: Mapping[str, str], others: Mapping[str, str]) -> Element:
    """Return a description with copies of the blocks about parts that have an image.

    A block is copied if it refers to such a part by its reference, or if all its joints have
    images; a ``<ros2_control>`` some of whose joints have images gets these joints.
    """
    made = copy(root)
    made.children = list(root.children)
    for number, block in enumerate(root.children):
        if block.tag not in BLOCKS:
            continue
        own = [e.get("name") or "" for e in block.list_children("joint")]
        known = [name for name in own if name in names]
        if block.get("reference") in names:
            if not has_pose(block):
                made.children.append(_rename(block, names))
        elif known and (block.get("name") or "") in others:
            made.children.append(_rename(block, {**names, **others}))
        elif known and block.tag == "ros2_control":
            part = copy(block)
            copies = [_rename(e, names) for e in block.list_children("joint")]
            part.children = [
                *block.children,
                *(new for new, name in zip(copies, own, strict=True) if name in names),
            ]
            made.children[number] = part
    return made


POSED = ("pose", "sensor", "plugin", "xyz", "rpy", "xyzOffset", "rpyOffset", "axis")
"""Elements of ``<gazebo>`` whose mirror image is not known."""


def has_pose(block: Element) -> bool:
    """Tell whether a block has an element whose mirror image is not known."""
    return any(element.tag in POSED for element in block.walk())


def _rename(element: Element, names: Mapping[str, str]) -> Element:
    """Return a copy of an element with other names in attributes and texts."""
    made = copy(element)
    made.attributes = {key: names.get(value, value) for key, value in element.attributes.items()}
    made.text = names.get(element.text.strip(), element.text)
    made.children = [_rename(child, names) for child in element.children]
    return made
