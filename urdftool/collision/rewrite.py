"""A robot's source with new collisions; all other bytes are unchanged."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from ..errors import SourceError
from ..model.angles import format_angles
from ..model.elements import Mesh, Robot
from ..model.pose import Pose, make_pose, rpy_from_rotation
from ..model.read import read_robot
from ..source import edit
from ..source.document import Element
from ..source.location import SourceFile
from ..source.packages import find_own_package
from .compute import Result, Task
from .links import LinkPlan, Shape
from .mesh_files import encode_mesh
from .piece import Piece

_LITERAL = re.compile(r"\$\(find [^)$]*\)")


@dataclass
class Layout:
    """File layout of a robot, and the URIs of its meshes.

    Attributes:
        target: The description to write.
        mesh_dir: Folder of the pieces.
        uri: ``"package"``, ``"relative"`` or ``"file"``.
        suffix: ``".stl"`` or ``".obj"``.
        capsules: Whether the robot's URDF version has capsules.
        whole: Whether the URIs of the robot's other meshes are rewritten as well.
    """

    target: Path
    mesh_dir: Path
    uri: str
    suffix: str = ".stl"
    capsules: bool = False
    whole: bool = False
    files: dict[Path, bytes] = field(default_factory=dict)
    """Content of the mesh files, by path."""
    names: dict[int, list[str]] = field(default_factory=dict)
    """URIs of a result's pieces, by the id of the result; empty for a primitive."""


def determine_layout(
    robot: Robot, target: Path, mesh_dir: Path | None, uri: str, suffix: str
) -> Layout:
    """Determine the layout for a robot.

    Pieces without ``mesh_dir`` are in the target's folder; the URI ``auto`` is as the robot's own.

    Raises:
        SourceError: ``package`` is requested but the folder is not in a package.
    """
    folder = Path(os.path.abspath(mesh_dir or target.parent / f"{_make_plain(target)}_collision"))
    package = find_own_package(folder / "piece")
    whole = uri == "relative"
    if uri == "auto":
        names = [s.geometry.filename for _, s in robot.shapes if isinstance(s.geometry, Mesh)]
        own = sum(name.startswith(("package://", "model://")) for name in names)
        uri = "package" if package is not None and 2 * own >= len(names) else "relative"
    if uri == "package" and package is None:
        raise SourceError(
            f"--uri package requires a folder of a ROS package; {folder} is not in one; "
            "choose another with --mesh-dir, or use --uri relative"
        )
    capsules = (robot.version or "1.0") not in ("1.0", "1")
    return Layout(Path(os.path.abspath(target)), folder, uri, suffix, capsules, whole)


def _make_plain(path: Path) -> str:
    name = path.name
    for ending in (".xacro", ".urdf"):
        name = name.removesuffix(ending)
    return name or "robot"


def name_pieces(
    layout: Layout, results: Mapping[Task, Result], links: Mapping[Task, str] | None = None
) -> None:
    """Assign a file and a URI to each mesh piece, numbered.

    Args:
        layout: Receives the files and names.
        results: The results; their pieces are named after the mesh, or the link of several meshes.
        links: Name of the first link of each task.
    """
    taken: dict[str, int] = {}
    for task, result in results.items():
        if id(result) in layout.names:
            continue
        name = (links or {}).get(task, "") if task.others else task.path.stem
        stem = re.sub(r"[^A-Za-z0-9_.-]", "_", name) or "mesh"
        taken[stem.casefold()] = count = taken.get(stem.casefold(), 0) + 1
        if count > 1:
            stem = f"{stem}-{count}"
        meshes = [piece for piece in result.pieces if not piece.is_primitive]
        uris = []
        for piece in result.pieces:
            if piece.is_primitive:
                uris.append("")
                continue
            number = f"_{len([u for u in uris if u])}" if len(meshes) > 1 else ""
            path = layout.mesh_dir / f"{stem}{number}{layout.suffix}"
            layout.files[path] = encode_mesh([piece], layout.suffix)
            uris.append(make_uri(path, layout))
        layout.names[id(result)] = uris


def make_uri(path: Path, layout: Layout) -> str:
    """Return the URI of a file in the robot."""
    if layout.uri == "file":
        return path.as_uri()
    if layout.uri == "package":
        package = find_own_package(path)
        assert package is not None
        return f"package://{package[0]}/{path.relative_to(package[1]).as_posix()}"
    return Path(os.path.relpath(path, layout.target.parent)).as_posix()


def rewrite_robot(
    robot: Robot,
    plans: Sequence[LinkPlan],
    results: Mapping[Task, Result],
    layout: Layout,
) -> bytes:
    """Return the robot's text with new collisions; xacro is expanded.

    If the target is in another folder, relative names of other files are adjusted.
    """
    assert robot.source is not None
    file = robot.source.files[0]
    if robot.source.expansion is not None:
        file = SourceFile(file.path, robot.source.expansion.text.encode())
    source = edit.parse_source(file)
    again = read_robot(source.document.root)
    edits = []
    gone: set[int] = set()
    for item in plans:
        link = again.links[item.index]
        blocks = _make_blocks(item, results, layout)
        old = [link.collisions[number].element for number in item.replaced]
        gone.update(id(element) for element in old)
        edits += link_edits(source, link.element, old, blocks)
    elsewhere = os.path.realpath(layout.target.parent) != os.path.realpath(_format_folder(robot))
    if elsewhere or layout.whole:
        edits += _move_references(robot, again, source, layout, gone)
    return edit.apply(source.file, edits)


def link_edits(
    source: edit.Source, link: Element, old: Sequence[Element], blocks: Sequence[Sequence[str]]
) -> list[edit.Edit]:
    """Create the edits that replace a link's collisions or add new ones after its visuals."""
    if old:
        first = edit.replace_element(source, old[0], blocks)
        return [first, *(edit.remove_element(source, element) for element in old[1:])]
    after = None
    for tag in ("visual", "inertial", "collision"):
        found = list(link.list_children(tag))
        if found:
            after = found[-1]
            break
    return [edit.insert_child(source, link, _join_blocks(blocks), after=after)]


def _join_blocks(blocks: Sequence[Sequence[str]]) -> list[str]:
    return [line for block in blocks for line in block]


def _make_blocks(item: LinkPlan, results: Mapping[Task, Result], layout: Layout) -> list[list[str]]:
    blocks: list[list[str]] = []
    for use in item.uses:
        if use.task is None:
            blocks.append(_copy_primitive(use.shape))
            continue
        result = results[use.task]
        blocks += format_piece_blocks(use.shape, result, layout)
    return blocks


def format_piece_blocks(shape: Shape, result: Result, layout: Layout) -> list[list[str]]:
    """Return a ``<collision>`` for each piece of a mesh, as lines."""
    blocks = []
    for piece, uri in zip(result.pieces, layout.names[id(result)], strict=True):
        if piece.is_primitive:
            for part in _split_capsule(piece, layout.capsules):
                blocks.append(_format_primitive_block(shape, part))
        else:
            blocks.append(_block(_format_origin(shape), f"<mesh filename={_quote(uri)}/>"))
    return blocks


def _split_capsule(piece: Piece, capsules: bool) -> list[Piece]:
    """Split a capsule into a cylinder and two spheres if URDF has no capsules."""
    if piece.kind != "capsule" or capsules:
        return [piece]
    from .piece import make_primitive

    radius, length = piece.size
    reach = piece.rotation[:, 2] * length / 2
    upright = np.eye(3)
    return [
        make_primitive("cylinder", (radius, length), piece.rotation, piece.center),
        make_primitive("sphere", (radius,), upright, piece.center + reach),
        make_primitive("sphere", (radius,), upright, piece.center - reach),
    ]


def _format_primitive_block(shape: Shape, piece: Piece) -> list[str]:
    x, y, z = piece.rotation.tolist()
    a, b, c = piece.center.tolist()
    pose = make_pose(shape.origin) @ Pose((tuple(x), tuple(y), tuple(z)), (a, b, c))
    xyz = _format_numbers(pose.translation)
    rpy = format_angles(round(angle, 9) for angle in rpy_from_rotation(pose.rotation))
    origin = "" if xyz == rpy == "0 0 0" else f'<origin xyz="{xyz}" rpy="{rpy}"/>'
    return _block(origin, format_geometry_tag(piece))


def format_geometry_tag(piece: Piece) -> str:
    """Return the geometry element of a primitive."""
    if piece.kind == "box":
        return f'<box size="{_format_numbers(piece.size)}"/>'
    if piece.kind == "sphere":
        return f'<sphere radius="{_format_numbers(piece.size)}"/>'
    radius, length = map(_number, piece.size)
    return f'<{piece.kind} radius="{radius}" length="{length}"/>'


def _copy_primitive(shape: Shape) -> list[str]:
    """Copy a visual primitive as a collision."""
    assert shape.geometry is not None
    element = shape.geometry.element
    words = "".join(f" {name}={_quote(value)}" for name, value in element.attributes.items())
    return _block(_format_origin(shape), f"<{element.tag}{words}/>")


def _format_origin(shape: Shape) -> str:
    if shape.origin is None:
        return ""
    words = shape.origin.element.attributes.items()
    return "<origin" + "".join(f" {name}={_quote(value)}" for name, value in words) + "/>"


def _block(origin: str, geometry: str) -> list[str]:
    lines = ["<collision>", "\t<geometry>", f"\t\t{geometry}", "\t</geometry>", "</collision>"]
    if origin:
        lines.insert(1, f"\t{origin}")
    return [line.encode("ascii", "xmlcharrefreplace").decode() for line in lines]


def _quote(value: str) -> str:
    return quoteattr(value, {'"': "&quot;", "\n": "&#10;", "\t": "&#9;"})


def _format_numbers(values: Sequence[float]) -> str:
    return " ".join(map(_number, values))


def _number(value: float) -> str:
    rounded = round(float(value), 9) + 0.0
    return f"{rounded:.9g}"


def _format_folder(robot: Robot) -> str:
    assert robot.source is not None
    return str(robot.source.packages.file.parent)


def _move_references(
    robot: Robot, again: Robot, source: edit.Source, layout: Layout, gone: set[int]
) -> list[edit.Edit]:
    """Create edits that make relative file names relative to the target's folder."""
    assert robot.source is not None
    edits = []
    kept = [shape for _, shape in again.shapes if id(shape.element) not in gone]
    for element in [
        *(s.geometry.element for s in kept if isinstance(s.geometry, Mesh)),
        *(e for e in again.element.walk() if e.tag == "texture"),
    ]:
        name = element.get("filename") or ""
        if not name or (not layout.whole and ("://" in name or os.path.isabs(name))):
            continue
        path = robot.source.resolve(name)
        moved = Path(os.path.relpath(path, layout.target.parent)).as_posix()
        edits.append(edit.set_attribute(source, element, "filename", moved))
    return edits


def is_literal(text: str) -> bool:
    """Tell whether a text of a xacro file is the same in every expansion."""
    return "$" not in _LITERAL.sub("", text)
