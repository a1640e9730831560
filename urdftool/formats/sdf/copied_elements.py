"""Copying of SDF elements in ``<gazebo>`` blocks: lights, projectors, emitters, batteries."""

from __future__ import annotations

from ...model.block_elements import find_owner, list_model_elements
from ...model.elements import Joint, Link
from ...model.pose import Pose, rotation_from_rpy
from ...model.read import parse_numbers
from ...model.sdf_schema import find_requirement, get_children
from ...model.settings import describe_rejected
from ...source.document import Element
from ..common.naming import get_free_name
from .imu import is_old_noise
from .pose import set_pose
from .translation import Translation
from .xml import Node, add, append_comment, append_copy, format_one_line

PLACED = frozenset(
    ("light", "projector", "sensor", "audio_source", "particle_emitter", "collision", "visual")
)
"""Elements with a pose in their link."""

NAMED = frozenset(("frame", "link", "joint", "model", "gripper", "particle_emitter", "battery"))
"""Elements that require a name."""

OWN_FRAMES = frozenset(("frame", "link", "model", "joint"))
"""Elements of a model that define a frame."""

BEFORE_SDF = frozenset(
    ("body", "controller", "geom", "interface", "joint", "model", "physics", "rendering", "sensor")
)
"""Prefixes of Gazebo's XML format before SDF, which current readers ignore."""


def copy_raw_element(
    node: Node, t: Translation, element: Element, about: Link | Joint | None = None
) -> Node | None:
    """Copy an element of a block if SDF defines it, otherwise keep it as a comment.

    Returns:
        The copy; None if the element is not valid SDF.
    """
    if not _is_known(str(node.tag), element):
        _keep_as_comment(node, t, element, about)
        return None
    if element.tag in NAMED and not (element.get("name") or "").strip():
        text = f"<{element.tag}> of a <gazebo> block has no name; it is not exported"
        t.report_loss("element", text, element, about)
        return None
    if required := find_requirement(str(node.tag), element):
        text = _describe(t, element, required.text)
        t.report_loss("extension", f"{text}; it is not exported", element, about)
        return None
    if about is None and element.tag in OWN_FRAMES - {"joint"} and _is_taken(node, element):
        name = element.get("name")
        text = f"<{element.tag}> '{name}' of a <gazebo> block is not exported: the name is taken"
        t.report_loss("reference", text, element)
        return None
    made = append_copy(node, element)
    remove_invalid(made, t, element, about)
    if element.tag in ("light", "projector"):
        _name_once(node, made)
    if isinstance(about, Link) and element.tag in PLACED:
        move_to_owner(made, t, about)
    return made


def _is_taken(model: Node, element: Element) -> bool:
    """Tell whether a link, joint, frame or model of a model has the name of an element."""
    name = element.get("name")
    return any(other.get("name") == name for other in model if other.tag in OWN_FRAMES)


def _name_once(node: Node, made: Node) -> None:
    """Rename an element if a sibling has the same name."""
    name = made.get("name") or made.tag
    taken = {other.get("name") for other in node if other is not made}
    made.set("name", get_free_name(name, taken))


def _is_known(parent: str, element: Element) -> bool:
    """Tell whether SDF defines an element in a parent; prefixed elements are program-specific."""
    prefix, colon, _ = element.tag.partition(":")
    if colon:
        return prefix not in BEFORE_SDF
    known = get_children(parent, newest=True)
    return known is None or element.tag in known


def remove_invalid(
    made: Node, t: Translation, element: Element, about: Link | Joint | None
) -> None:
    """Remove children that are not SDF elements or have invalid values."""
    if element.tag == "plugin":
        return
    for child, source in zip(list(made), element.children, strict=True):
        if is_old_noise(source):
            made.remove(child)
        elif required := find_requirement(str(made.tag), source):
            made.remove(child)
            text = _describe(t, source, required.text)
            t.report_loss("extension", f"{text}; it is not exported", source, about)
        elif _is_known(element.tag, source):
            remove_invalid(child, t, source, about)
        else:
            _keep_as_comment(made, t, source, about)
            made.replace(child, made[-1])


def _describe(t: Translation, element: Element, required: str) -> str:
    owner = find_owner(t.robot, element)
    return describe_rejected(owner, element.tag, element.text.strip(), required)


def _keep_as_comment(
    node: Node, t: Translation, element: Element, about: Link | Joint | None
) -> None:
    """Append an unknown element as a comment, and report it."""
    append_comment(node, format_one_line(element))
    what = f"<{element.tag}>"
    t.report_loss(
        "element",
        f"{what} in <{node.tag}> is not an SDF element; it is kept as a comment",
        element,
        about,
    )


def move_to_owner(made: Node, t: Translation, link: Link) -> None:
    """Convert the pose of an element of a link to the link's owner."""
    rename_frames(made, t, link)
    pose = made.find("pose")
    if t.plan.stays(link.name) or (pose is not None and pose.get("relative_to")):
        return
    if not t.options.classic:
        if pose is None:
            pose = add(made, "pose", "0 0 0 0 0 0")
            made.remove(pose)
            made.insert(0, pose)
        pose.set("relative_to", t.names.link(link.name))
        return
    six = parse_numbers(pose.text if pose is not None else "0 0 0 0 0 0", 6)
    if six is None:
        return
    local = Pose(rotation_from_rpy(six[3:]), six[:3])  # type: ignore[arg-type]
    if pose is not None:
        made.remove(pose)
    set_pose(made, t.plan.in_owner[link.name] @ local)
    placed = made.find("pose")
    if placed is not None:
        made.insert(0, placed)


def rename_frames(node: Node, t: Translation, part: Link | Joint) -> None:
    """Update references to renamed frames, and remove those to missing frames."""
    for pose in node.iter("pose"):
        frame = pose.get("relative_to")
        if frame is None:
            continue
        if not is_frame(t, frame):
            del pose.attrib["relative_to"]
            text = f"a pose of <{node.tag}> '{node.get('name')}' is relative to '{frame}'"
            t.report_loss(
                "reference",
                f"{text}, which does not exist; the attribute is not exported",
                part,
                part,
            )
        elif ("link", frame) in t.names.renamed:
            pose.set("relative_to", t.names.link(frame))


def is_frame(t: Translation, name: str) -> bool:
    """Tell whether a link, joint or frame exists; of a scoped name, whether its model may."""
    if name in t.robot.link or name in t.robot.joint or name in ("", "__model__"):
        return True
    elements = list(list_model_elements(t.robot))
    model, scope, _ = name.partition("::")
    if scope:
        named = (e for e in elements if e.tag == "include" or e.get("name") == model)
        return t.robot.format != "urdf" or any(e.tag in ("model", "include") for e in named)
    return any(e.get("name") == name for e in elements if e.tag in OWN_FRAMES)
