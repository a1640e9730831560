"""A second robot attached to a link of a first one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from ..errors import ModelError
from ..model.elements import Joint, Link, Vector
from ..model.part import Part
from ..model.world import WORLD
from ..source.document import Element
from .around import YamlDraft, apply_changes
from .cut import MARKS
from .draft import Draft, TextDraft, flatten_element, make_relative
from .inclusion import quote
from .numbers import format_number, format_vector
from .references import list_gazebo_blocks, list_others

BEGIN, END = MARKS["attach"]


@dataclass(frozen=True)
class Mount:
    """The fixed joint between two robots.

    Attributes:
        to: Link of the first robot.
        joint: Name of the joint; empty for ``TO_to_LINK``.
        xyz: Position of the second robot's first link in ``to`` [m].
        rpy: Its rotation [rad].
    """

    to: str
    joint: str = ""
    xyz: Vector = (0.0, 0.0, 0.0)
    rpy: Vector = (0.0, 0.0, 0.0)


def attach_robot(arm: Draft, part: Draft, mount: Mount, folder: Path | None = None) -> str:
    """Insert a robot, with its comments, at the end of another; return its first link.

    Names of the second have their prefix already; paths of meshes are relative to ``folder``, by
    default that of the first.

    Raises:
        ModelError: Names clash, or the link does not exist.
    """
    link = arm.find_link(mount.to)
    first, dropped = _find_first_link(part)
    name = mount.joint or f"{mount.to}_to_{first}"
    _check_clashes(arm, part, name, {id(element) for element in dropped})
    _check_encoding(arm, part)
    for element in dropped:
        part.remove(element)
    _drop_doubles(arm, part)
    _declare_settings(arm, part)
    move_paths(part, Path(arm.file.path).parent if folder is None else folder)
    text = _take_content(arm, part, first, format_joint(mount, name, first))
    arm.append_bytes(text)
    _copy_namespaces(arm, part)
    _join_semantics(arm, part, link.name, first)
    xyz, rpy = ([format_number(value) for value in three] for three in (mount.xyz, mount.rpy))
    arm.declare("mount", first, mount.to, "xyz", *xyz, "rpy", *rpy)
    arm.declare("added", first)
    return first


def _find_first_link(part: Draft) -> tuple[str, list[Element]]:
    """Return the link to attach, and the parts of an empty world above it, which are dropped."""
    robot = part.robot
    root = robot.tree.roots[0]
    below = robot.tree.get_child_joints(root.name)
    is_world = root.name == WORLD or root.name.endswith(WORLD)
    free = next((j for j in below if j.type in ("floating", "planar")), None)
    if root.is_frame and free is not None:
        raise ModelError(
            f"{free.type} joint '{free.name}' would let the attached robot move freely; "
            "make it fixed first",
            at=free.place,
        )
    if not (is_world and root.is_frame and len(below) == 1 and below[0].is_fixed):
        return root.name, []
    message = f"link '{root.name}' and joint '{below[0].name}' with its origin are not attached"
    part.report("world", message, root.place)
    return below[0].child, [root.element, below[0].element]


def _check_clashes(arm: Draft, part: Draft, joint: str, dropped: set[int]) -> None:
    """Check that no name occurs in both robots.

    Raises:
        ModelError: One does; materials may, if they have the same content.
    """
    _check_kind("link", arm.robot.link, part.robot.link, dropped)
    _check_kind("joint", {**arm.robot.joint, joint: None}, part.robot.joint, dropped)
    if joint in arm.robot.joint:
        raise ModelError(f"joint '{joint}' exists; choose another name with --joint")
    one, two = ({_get_name(e): e for e in list_others(d.root)} for d in (arm, part))
    _check_kind("transmission or component", one, two, dropped)


def _check_kind(
    kind: str,
    one: Iterable[str],
    two: Mapping[str, Link] | Mapping[str, Joint] | Mapping[str, Element],
    dropped: set[int],
) -> None:
    for name in one:
        other = two.get(name)
        element = other.xml if isinstance(other, Part) else other
        if name and element is not None and id(element) not in dropped:
            raise ModelError(
                f"{kind} '{name}' is in both robots; choose a prefix with --prefix",
                at=element.place,
            )


def _get_name(element: Element) -> str:
    return element.get("name") or ""


def _check_encoding(arm: Draft, part: Draft) -> None:
    for draft in (arm, part, *arm.around, *part.around):
        if not draft.file.data.isascii():
            try:
                draft.file.data.decode("utf-8")
            except UnicodeDecodeError:
                raise ModelError(
                    "is not in UTF-8; save both robots as UTF-8", path=draft.file.path
                ) from None


def _drop_doubles(arm: Draft, part: Draft) -> None:
    """Drop materials and plugins of the whole robot that the first one has."""
    known = {_get_name(e): e for e in arm.root.list_children("material")}
    for element in part.root.list_children("material"):
        same = known.get(_get_name(element))
        if same is None:
            continue
        if flatten_element(same) != flatten_element(element):
            raise ModelError(
                f"both robots have a material '{_get_name(element)}', which differ; choose a "
                "prefix with --prefix",
                at=element.place,
            )
        part.remove(element)
    plugins = {flatten_element(block) for block in list_gazebo_blocks(arm, "")}
    names = {name for block in list_gazebo_blocks(arm, "") for name in _list_plugins(block)}
    for block in list_gazebo_blocks(part, ""):
        if flatten_element(block) in plugins:
            part.remove(block)
        elif both := names & set(_list_plugins(block)):
            part.report(
                "plugin", f"both robots have plugin '{min(both)}'; both are kept", block.place
            )


def _declare_settings(arm: Draft, part: Draft) -> None:
    """Declare the settings of the whole robot that only one of both has: they hold for the other.

    Raises:
        ModelError: Both have a setting, with different values.
    """
    one, two = arm.robot.settings, part.robot.settings
    for name in dict.fromkeys((*one, *two)):
        if name in one and name in two:
            if one[name].content != two[name].content:
                raise ModelError(
                    f"setting {name} of the whole robot has another value in the first robot; "
                    "remove one of them",
                    at=two[name].place,
                )
            continue
        value, other = (one[name], part) if name in one else (two[name], arm)
        other.declare("setting", name, "true" if value.content else "false")
        message = f"setting {name} of this robot is now one of the other, too"
        part.report("setting", message, value.place)
    for block in (*arm.root.list_children("mujoco"), *part.root.list_children("mujoco")):
        part.report("setting", "<mujoco> of this robot is now one of the other, too", block.place)


def _list_plugins(block: Element) -> list[str]:
    return [name for e in block.list_children("plugin") if (name := e.get("filename"))]


def move_paths(draft: Draft, folder: Path) -> None:
    """Make relative paths of meshes and textures relative to another folder.

    From one package to another, they become ``package://`` paths.
    """
    here = Path(draft.file.path).parent
    if draft.description.path == "-" or here.resolve() == folder.resolve():
        return
    for element in draft.root.walk():
        if element.tag not in ("mesh", "texture"):
            continue
        uri = draft.get(element, "filename") or ""
        if uri and "://" not in uri and not uri.startswith(("/", "$")) and uri not in draft.meshes:
            draft.set(element, "filename", _refer(draft, here / uri, folder))


def _refer(draft: Draft, path: Path, folder: Path) -> str:
    """Return how a description in a folder refers to a file."""
    path, folder = path.resolve(), folder.resolve()
    packages = draft.description.packages
    owner, own = packages.find_owner(path), packages.find_owner(folder / path.name)
    if owner is None or own is None or owner == own:
        return make_relative(path, folder)
    return f"package://{owner[0]}/{path.relative_to(owner[1]).as_posix()}"


def format_joint(mount: Mount, name: str, first: str) -> list[str]:
    """Return the lines of the fixed joint between two robots."""
    xyz, rpy = format_vector(mount.xyz), format_vector(mount.rpy)
    return [
        f'<joint name="{quote(name)}" type="fixed">',
        f'\t<parent link="{quote(mount.to)}"/>',
        f'\t<child link="{quote(first)}"/>',
        f'\t<origin xyz="{xyz}" rpy="{rpy}"/>',
        "</joint>",
    ]


def _take_content(arm: Draft, part: Draft, first: str, joint: list[str]) -> bytes:
    """Return the lines to insert: comment, joint, content of the second robot, comment."""
    made = apply_changes(part)
    data, root = made.file.data, made.root
    start = made.file.find_tag_end(root.start)
    content = data[start : data.rfind(b"</", 0, root.end)].strip(b"\r\n").rstrip()
    end, step = arm.source.line_end, arm.source.step
    content = content.replace(b"\r\n", b"\n").replace(b"\n", end)
    lines = [
        step * (1 + len(line) - len(line.lstrip("\t"))) + line.lstrip("\t").encode("utf-8")
        for line in (f"<!--{BEGIN}{first} -->", *joint)
    ]
    closing = step + f"<!--{END}{first} -->".encode()
    return end.join([*lines, content, closing]) + end


def _copy_namespaces(arm: Draft, part: Draft) -> None:
    """Declare the namespaces of the second robot that its elements use."""
    used = {e.tag.partition(":")[0] for e in part.root.walk() if ":" in e.tag}
    for name, value in part.root.attributes.items():
        prefix = name.removeprefix("xmlns:")
        if name.startswith("xmlns:") and prefix in used and name not in arm.root.attributes:
            arm.set(arm.root, name, value)


def _join_semantics(arm: Draft, part: Draft, to: str, first: str) -> None:
    """Join the SRDFs of both robots; other files of the second one are kept as they are."""
    mine = next((file for file in arm.around if not isinstance(file, YamlDraft)), None)
    for file in part.around:
        if mine is None or isinstance(file, YamlDraft):
            arm.around.append(file)
            continue
        _join_semantic_file(part, mine, file)
    if mine is not None:
        reason = f'<disable_collisions link1="{to}" link2="{first}" reason="Adjacent"/>'
        mine.append_bytes(mine.source.step + mine.encode(reason) + mine.source.line_end)


def _join_semantic_file(part: Draft, mine: TextDraft, other: TextDraft) -> None:
    root = other.source.document.root
    for element in root.list_children("virtual_joint"):
        other.remove(element)
        part.report(
            "semantics", "the virtual joint of the attached robot is dropped", element.place
        )
    known = {(e.tag, _get_name(e)) for e in mine.source.document.root.children if _get_name(e)}
    for element in root.children:
        if element.tag != "virtual_joint" and (element.tag, _get_name(element)) in known:
            raise ModelError(
                f"both SRDFs have a <{element.tag}> '{_get_name(element)}'; rename one",
                at=element.place,
            )
    data = other.make_bytes()
    start = data.find(b">", data.find(b"<robot")) + 1
    content = data[start : data.rfind(b"</robot")].strip(b"\r\n").rstrip()
    mine.append_bytes(content + mine.source.line_end)


def list_origin_lines(part: Draft, first: str) -> list[list[str]]:
    """Return the lines of the correspondence of an attached robot, but for its names."""
    old = next((words[1] for words in part.lines if words[::2] == ["link", first]), first)
    return [["branch", old, first]]
