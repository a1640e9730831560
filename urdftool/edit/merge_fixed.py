"""Links that fixed joints carry, merged into one; frames that others refer to stay."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase
from typing import NamedTuple

from ..mechanics.spatial_inertia import SpatialInertia, combine, link_inertia
from ..mechanics.tensor import get_components
from ..model.elements import Collision, Link, Visual
from ..model.pose import IDENTITY, Pose, make_pose
from ..rules.moveit.semantic import find_references
from ..source.document import Element
from ..source.edit import Edit
from ..source.yaml_tree import list_scalars
from .around import YamlDraft
from .closed_loops import list_ends
from .draft import Draft, TextDraft
from .numbers import format_relative, format_vector
from .references import list_gazebo_blocks, list_names_in_text


class Merged(NamedTuple):
    """A link that becomes part of another one."""

    link: Link
    owner: str
    pose: Pose


def merge_fixed(draft: Draft, keep: Sequence[str] = (), *, frames: bool = False) -> list[str]:
    """Merge links that are fixed to others; return the names of the merged ones.

    Kept are links that match ``keep``, those that an SRDF, a YAML file around or a ``<gazebo>``
    refers to, those on joints that another joint, an SRDF, a YAML file, a transmission or a
    controller refers to, links fixed to an empty world, and frames without mass and geometry.

    Args:
        draft: The robot.
        keep: Names of links to keep, with ``*`` and ``?``.
        frames: Merge frames, too.

    Raises:
        ModelError: A name to keep does not exist.
    """
    for pattern in keep:
        if not any(fnmatchcase(name, pattern) for name in draft.robot.link):
            draft.find_link(pattern)
    merged = _plan(draft, _find_kept(draft, keep, frames=frames))
    owners: dict[str, list[Merged]] = {}
    for entry in merged.values():
        owners.setdefault(entry.owner, []).append(entry)
    for owner, entries in owners.items():
        link = draft.robot.link[owner]
        _insert_chunks(
            draft, link, [*_write_inertia(draft, link, entries), *_render_all(draft, entries)]
        )
        draft.declare("merged", owner, *(entry.link.name for entry in entries))
    _move_joints(draft, merged)
    _move_references(draft, merged)
    return list(merged)


def _find_kept(draft: Draft, keep: Sequence[str], *, frames: bool) -> set[str]:
    robot = draft.robot
    kept = {name for name in robot.link if any(fnmatchcase(name, one) for one in keep)}
    kept |= {link.name for link in robot.links if link.is_frame and not frames}
    kept |= {link.name for link in robot.links if _has_settings(link.element)}
    kept |= {e.get("reference") or "" for e in draft.root.list_children("gazebo")}
    kept |= list_ends(draft)
    kept |= {joint.child for joint in robot.joints if _has_sensor(draft, joint.name)}
    joints = {joint.mimic.joint for joint in robot.joints if joint.mimic is not None}
    for block in draft.root.children:
        if block.tag in ("transmission", "ros2_control"):
            joints |= {element.get("name") or "" for element in block.walk()}
    for file in draft.around:
        if isinstance(file, YamlDraft):
            named = {part for n in list_scalars(file.file) for part in (n.text or "").split("/")}
            kept |= named
            joints |= named
            continue
        for names, kind in ((kept, "link"), (joints, "joint")):
            found = find_references(file.source.document.root, kind)
            names |= {element.get(at) or "" for element, at, essential in found if essential}
    return kept | {joint.child for joint in robot.joints if joint.name in joints}


def _has_sensor(draft: Draft, joint: str) -> bool:
    """Tell whether a sensor, such as one of forces, is on a joint."""
    blocks = list_gazebo_blocks(draft, joint)
    return any(block.find_child("sensor") is not None for block in blocks)


def _has_same_surface(one: Link, other: Link) -> bool:
    """Tell whether all collisions of two links have the same friction and contact."""
    contents = ({name: v.content for name, v in link.surface.items()} for link in (one, other))
    return next(contents) == next(contents)


def _has_settings(link: Element) -> bool:
    """Tell whether a link has elements about all its shapes, such as ``<contact>`` of PyBullet."""
    return any(e.tag not in ("inertial", "visual", "collision") for e in link.children)


def _plan(draft: Draft, kept: set[str]) -> dict[str, Merged]:
    robot = draft.robot
    merged: dict[str, Merged] = {}
    for name in robot.tree.order:
        joint = robot.tree.get_parent_joint(name)
        if joint is None or not joint.is_fixed or name in kept:
            continue
        above = merged.get(joint.parent)
        owner, pose = (joint.parent, IDENTITY) if above is None else (above.owner, above.pose)
        is_root = robot.tree.get_parent_joint(owner) is None
        if robot.link[owner].is_frame and is_root:
            continue
        link = robot.link[name]
        if link.collisions and not _has_same_surface(link, robot.link[owner]):
            continue
        merged[name] = Merged(robot.link[name], owner, pose @ make_pose(joint.origin))
    return merged


def _write_inertia(draft: Draft, owner: Link, entries: list[Merged]) -> list[bytes]:
    """Write the sum of the mass properties; return it if the owner has none to replace."""
    moved = [link_inertia(e.link).transform(e.pose) for e in entries if e.link.inertial]
    if not moved:
        return []
    total = combine([*([link_inertia(owner)] if owner.inertial else []), *moved])
    origin = f'<origin xyz="{format_vector(total.com)}"/>'
    mass = f'<mass value="{format_relative(total.mass)}"/>'
    lines = ["<inertial>", f"\t{origin}", f"\t{mass}", f"\t{_format_tensor(total)}", "</inertial>"]
    if owner.inertial is None or owner.inertial.xml is None:
        return ["".join(line.strip() for line in lines).encode("utf-8")]
    from ..source.edit import replace_element

    draft.edits.append(replace_element(draft.source, owner.inertial.xml, [lines]))
    return []


def _format_tensor(total: SpatialInertia) -> str:
    values = get_components(total.tensor).items()
    return "<inertia " + " ".join(f'{n}="{format_relative(v)}"' for n, v in values) + "/>"


def _render_all(draft: Draft, entries: list[Merged]) -> list[bytes]:
    """Return the bytes of visuals and collisions, of which only the origins are rewritten."""
    return [_render(draft, s, entry.pose) for entry in entries for s in _list_shapes(entry.link)]


def _insert_chunks(draft: Draft, owner: Link, chunks: list[bytes]) -> None:
    """Insert elements after the last child of a link."""
    if not chunks:
        return
    data, element, source = draft.file.data, owner.element, draft.source
    own = source.get_indentation(element) or b""
    inner = source.get_inner_indentation(element) or own + source.step
    text = b"".join(source.line_end + inner + chunk for chunk in chunks)
    tag_end = draft.file.find_tag_end(element.start)
    if data[tag_end - 2 : tag_end] == b"/>":
        tail = source.line_end + own + b"</link>"
        draft.edits.append(Edit(tag_end - 2, tag_end, b">" + text + tail))
        return
    at = element.children[-1].end if element.children else tag_end
    draft.edits.append(Edit(at, at, text))


def _list_shapes(link: Link) -> list[Visual | Collision]:
    return [*link.visuals, *link.collisions]


def _render(draft: Draft, shape: Visual | Collision, pose: Pose) -> bytes:
    """Return the bytes of a shape at another pose."""
    part, element = Draft(file=draft.file, robot=draft.robot), shape.element
    part.set_pose(element, shape.origin, pose @ make_pose(shape.origin))
    data = part.make_bytes()
    grown = len(data) - len(draft.file.data)
    return data[element.start : element.end + grown]


def _move_joints(draft: Draft, merged: dict[str, Merged]) -> None:
    robot = draft.robot
    for joint in robot.joints:
        if joint.child in merged:
            draft.remove(joint.element)
            draft.remove(robot.link[joint.child].element)
            for block in list_gazebo_blocks(draft, joint.name):
                if joint.name not in robot.link:
                    draft.remove(block)
                    message = f"<gazebo> of fixed joint '{joint.name}' was removed with it"
                    draft.report("gazebo", message, block.place)
        elif joint.parent in merged:
            entry = merged[joint.parent]
            assert joint.parent_element is not None
            draft.set(joint.parent_element, "link", entry.owner)
            pose = entry.pose @ make_pose(joint.origin)
            draft.set_pose(joint.element, joint.origin, pose)


def _move_references(draft: Draft, merged: dict[str, Merged]) -> None:
    """Write the owners in pairs of an SRDF, and list the names that are lost."""
    for file in draft.around:
        if isinstance(file, YamlDraft):
            continue
        for element, attribute, _ in find_references(file.source.document.root, "link"):
            name = element.get(attribute) or ""
            if name in merged:
                file.set(element, attribute, merged[name].owner)
        _drop_equal_pairs(file)
    draft.around = [file for file in draft.around if not isinstance(file, YamlDraft)]
    list_names_in_text(draft, merged, "the link does not exist any more")


def _drop_equal_pairs(file: TextDraft) -> None:
    """Remove pairs of one link, and pairs that occur twice."""
    seen = set()
    for element in _list_pairs(file.source.document.root):
        pair = frozenset((file.get(element, "link1"), file.get(element, "link2")))
        if len(pair) == 1 or (pair in seen and file.values):
            file.remove(element)
        seen.add(pair)


def _list_pairs(root: Element) -> Iterator[Element]:
    return (element for element in root.children if element.tag == "disable_collisions")
