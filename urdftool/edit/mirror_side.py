"""The mirror image of one side of a robot, such as a right arm to a left one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ..compare.images import has_pose
from ..errors import ModelError
from ..model.elements import Joint
from ..model.kinematics import link_poses
from ..model.pose import Pose, make_pose
from ..source.document import Element, parse
from ..source.edit import Edit
from ..source.location import SourceFile
from ..source.yaml_tree import list_scalars
from .around import YamlDraft, apply_changes
from .closed_loops import check_loops
from .cut import MARKS, cut_branch
from .draft import Draft, TextDraft, is_identity
from .mirror import (
    PLANES,
    compute_reflected,
    exchange_part,
    mirror_joint,
    mirror_link,
    mirror_meshes,
)
from .mirror_semantics import copy_semantics
from .references import Names, list_names_in_text, list_others, rename

BEGIN, END = MARKS["mirror"]


def remove_side(draft: Draft, exchange: tuple[str, str]) -> Draft:
    """Return a draft without the side that the mirror image of the other replaces.

    Args:
        draft: The robot.
        exchange: Part of names of the side that stays, and of the one that is replaced.
    """
    one, other = exchange
    names = find_side(draft, one, other)
    around = draft.around
    for top in list(_find_tops(draft, _list_side(draft, other, one))):
        if exchange_part(top, other, one) in names.links:
            draft.around = around
            cut_branch(draft, top)
            draft = apply_changes(draft)
            around = [*draft.around, *(file for file in around if isinstance(file, YamlDraft))]
    draft.around = around
    return draft


def add_side(
    draft: Draft,
    plane: str,
    exchange: tuple[str, str],
    *,
    meshes: str = "files",
    mesh_dir: str = "meshes",
) -> None:
    """Add the mirror image of one side at a plane through the frame of the root.

    Copied are the branches whose names have a part, with their ``<gazebo>`` blocks, transmissions,
    hardware, and what is about them in the SRDF. All positions are zero in the mirror image.

    Arguments are those of :func:`.mirror.mirror_robot`.

    Raises:
        ModelError: No name has the part, a name within a branch does not, or a new name exists.
        MeshError: A mesh cannot be mirrored.
    """
    if plane not in PLANES:
        raise ModelError(f"plane '{plane}' is not one of {', '.join(PLANES)}")
    names = find_side(draft, *exchange)
    _check_free(draft, names)
    check_loops(draft, names.links, "whose mirror image is not known")
    image = Draft(draft.file, robot=draft.robot, meshes=draft.meshes, notes=draft.notes)
    _mirror(image, names, PLANES[plane], (meshes, mesh_dir))
    rename(image, names)
    blocks = [block for block in draft.root.children if _is_copied(draft, block, names)]
    _insert(draft, image, blocks, names)
    _add_interfaces(draft, image, names)
    for kind, known in (("link", names.links), ("joint", names.joints), ("part", names.others)):
        for old, new in known.items():
            draft.declare("image", plane, kind, old, new)
    for file in draft.around:
        if not isinstance(file, YamlDraft):
            copy_semantics(draft, file, names, lambda name: _name_image(name, *exchange))
    _report_yaml(draft, names)
    parts = [*names.links, *names.joints]
    seen = [block for block in draft.root.children if block in blocks or block.get("reference")]
    list_names_in_text(draft, parts, "its mirror image is not in it", skipped=seen)


def _check_free(draft: Draft, names: Names) -> None:
    """Check that no name of the image exists.

    Raises:
        ModelError: One does.
    """
    robot = draft.robot
    known = {e.get("name"): e for e in list_others(draft.root)}
    for kind, parts, new in (
        ("link", robot.link, names.links),
        ("joint", robot.joint, names.joints),
    ):
        for name in new.values():
            if name in parts:
                raise ModelError(
                    f"{kind} '{name}' exists; --sides replace removes that side before its mirror "
                    "image is added",
                    at=parts[name].place,
                )
    for name in names.others.values():
        if name in known:
            raise ModelError(f"'{name}' exists; rename it first", at=known[name].place)


def _list_side(draft: Draft, one: str, other: str) -> set[str]:
    return {name for name in draft.robot.link if exchange_part(name, one, other) != name}


def find_side(draft: Draft, one: str, other: str) -> Names:
    """Return the names of the mirror image of one side.

    Raises:
        ModelError: No link has the part of the name, or a link or joint within a branch has not.
    """
    robot = draft.robot
    side = _list_side(draft, one, other) - {robot.tree.roots[0].name}
    if not one or not side:
        raise ModelError(f"no link below the root has '{one}' in its name", path=draft.file.path)
    tops = list(_find_tops(draft, side))
    links = {name for top in tops for name in (top, *robot.tree.list_descendants(top))}
    joints = [joint for joint in robot.joints if joint.child in links]
    for kind, parts in (
        ("link", [robot.link[n] for n in robot.link if n in links]),
        ("joint", joints),
    ):
        for part in parts:
            if exchange_part(part.name, one, other) == part.name:
                raise ModelError(
                    f"{kind} '{part.name}' of that side has no '{one}' in its name, so that its "
                    "mirror image has no name; rename it first",
                    at=part.place,
                )
    known = {joint.name: exchange_part(joint.name, one, other) for joint in joints}
    blocks = [b for b in draft.root.children if _has_only(b, known)]
    others = [e.get("name") or "" for block in blocks for e in list_others_of(block)]
    return Names(
        {name: exchange_part(name, one, other) for name in robot.link if name in links},
        known,
        {},
        {name: _name_image(name, one, other) for name in others if name and name not in known},
    )


def _has_only(block: Element, joints: Mapping[str, str]) -> bool:
    """Tell whether a transmission or hardware component is about joints of a side only."""
    own = [e.get("name") for e in block.list_children("joint")]
    return (
        block.tag in ("transmission", "ros2_control")
        and bool(own)
        and all(name in joints for name in own)
    )


def list_others_of(block: Element) -> Iterator[Element]:
    """Yield a transmission or hardware component, and the named parts of it."""
    assert block.parent is not None
    own = {id(e) for e in block.walk()}
    return (e for e in list_others(block.parent) if id(e) in own)


def _name_image(name: str, one: str, other: str) -> str:
    """Return the name with the part exchanged, or else with the new part before or behind it."""
    new = exchange_part(name, one, other)
    if new != name:
        return new
    return name + other if other.startswith("_") else other + name


def _find_tops(draft: Draft, side: set[str]) -> Iterator[str]:
    """Yield the first link of each branch of some links."""
    for name in draft.robot.tree.order:
        if name in side and side.isdisjoint(draft.robot.tree.list_ancestors(name)):
            yield name


def _mirror(image: Draft, names: Names, index: int, how: tuple[str, str]) -> None:
    robot = image.robot
    poses = link_poses(robot)
    for name in names.joints:
        joint = robot.joint[name]
        mirror_joint(image, joint, index)
        if joint.parent in names.links:
            continue
        frame = poses[joint.parent]
        turn = frame.invert() @ compute_reflected(frame, index)
        if not is_identity(turn):
            _set_origin(image, joint, turn @ compute_reflected(make_pose(joint.origin), index))
    written: dict[str, str] = {}
    for name in names.links:
        mirror_link(image, robot.link[name], index)
        mirror_meshes(image, robot.link[name], index, how, written)


def _set_origin(image: Draft, joint: Joint, pose: Pose) -> None:
    if joint.origin is not None and joint.origin.xml is not None:
        for name in ("xyz", "rpy"):
            image.values.pop((joint.origin.xml.start, name), None)
    image.set_pose(joint.element, joint.origin, pose)


def _is_copied(draft: Draft, block: Element, names: Names) -> bool:
    name = block.get("name") or ""
    if block.tag in ("link", "joint"):
        return name in (names.links if block.tag == "link" else names.joints)
    if block.tag != "gazebo":
        return _has_only(block, names.joints)
    if block.get("reference") not in {**names.links, **names.joints}:
        return False
    if has_pose(block):
        message = f"<gazebo> of '{block.get('reference')}' has sensors, plugins or poses; its "
        draft.report("gazebo", message + "mirror image is not written", block.place)
        return False
    return True


def _insert(draft: Draft, image: Draft, blocks: list[Element], names: Names) -> None:
    """Insert the images of blocks at the end, each branch between two comments."""
    copies = _list_copies(image)
    numbers = {id(block): number for number, block in enumerate(draft.root.children)}
    step, end = draft.source.step, draft.source.line_end
    for top in _find_tops(draft, set(names.links)):
        own = _list_names(draft, top)
        inner = [block for block in blocks if own & _get_names(block)]
        blocks = [block for block in blocks if block not in inner]
        new = names.links[top]
        lines = [
            draft.encode(f"<!--{BEGIN}{new} -->"),
            *(copies[numbers[id(block)]].text for block in inner),
            draft.encode(f"<!--{END}{new} -->"),
        ]
        draft.append_bytes(b"".join(step + line + end for line in lines))


def _list_names(draft: Draft, top: str) -> set[str]:
    """Return the names of the links of a branch and of the joints that move them."""
    robot = draft.robot
    links = {top, *robot.tree.list_descendants(top)}
    return links | {joint.name for joint in robot.joints if joint.child in links}


def _get_names(block: Element) -> set[str]:
    if block.tag in ("link", "joint", "gazebo"):
        return {block.get("name") or "", block.get("reference") or ""}
    return {joint.get("name") or "" for joint in block.list_children("joint")}


class _Copy(NamedTuple):
    """An element of the image: its bytes, and those of its children."""

    text: bytes
    joints: list[bytes]


def _list_copies(image: TextDraft) -> list[_Copy]:
    """Return the elements of the root of a file with its changes."""
    made = SourceFile(image.file.path, image.make_bytes())
    return [
        _Copy(
            made.data[block.start : block.end],
            [made.data[e.start : e.end] for e in block.list_children("joint")],
        )
        for block in parse(made).root.children
    ]


def _add_interfaces(draft: Draft, image: Draft, names: Names) -> None:
    """Insert joints into hardware components that are about other joints, too."""
    for block, copy in zip(draft.root.children, _list_copies(image), strict=True):
        if block.tag != "ros2_control" or _has_only(block, names.joints):
            continue
        pairs = list(zip(block.list_children("joint"), copy.joints, strict=True))
        new = [(e, text) for e, text in pairs if e.get("name") in names.joints]
        if new:
            space = draft.source.get_indentation(new[0][0]) or b""
            text = b"".join(draft.source.line_end + space + text for _, text in new)
            at = pairs[-1][0].end
            draft.edits.append(Edit(at, at, text))


def _report_yaml(draft: Draft, names: Names) -> None:
    """List the files with names of the side, to which the image is not added."""
    known = {*names.links, *names.joints}
    for file in draft.around:
        nodes = list_scalars(file.file) if isinstance(file, YamlDraft) else []
        found = [n for n in nodes if not known.isdisjoint((n.text or "").split("/"))]
        if found:
            message = f"'{found[0].text}' and its values have no mirror image in this file"
            draft.report("yaml", message, found[0].place)
    draft.around = [file for file in draft.around if not isinstance(file, YamlDraft)]
