"""Mesh assets of a robot: one for each file, scale and role, each file converted once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from lxml import etree

from ...diagnostic import Severity
from ...finding import Finding
from ...geometry.mesh import MeshNote
from ...model.elements import Collision, Mesh, Robot, Vector, Visual
from ...model.numbers import format_numbers_text
from ..common.assets import find_file
from ..common.cut import Cut, Cutter
from ..common.missing_files import create_missing_mesh
from ..common.naming import UniqueNames, replace_file_name
from ..defects import make_defect
from ..written import Written
from .convert import Converted, Image, Piece, Rgba
from .obj import write_obj_bytes
from .options import Options

ONE: Vector = (1.0, 1.0, 1.0)

HULL = 1.05
"""Ratio of hull to mesh volume above which a collision mesh is reported as not convex."""


@dataclass(frozen=True)
class MeshPiece:
    """A mesh asset for a geom: its name, color, image, and source file."""

    name: str
    rgba: Rgba | None
    texture: Image | None
    file: str


@dataclass(frozen=True)
class Assets:
    """The mesh assets of a robot.

    Attributes:
        pieces: Mesh assets of a shape, by the ``id`` of its ``Mesh``.
        elements: ``<mesh>`` elements, visual meshes first, then collision meshes.
        sources: Mesh files that were read.
    """

    pieces: dict[int, list[MeshPiece]]
    elements: list[etree._Element]
    sources: list[Path]


def create_mesh_assets(
    robot: Robot, written: Written, options: Options
) -> tuple[Assets, list[Finding]]:
    """Create the mesh assets, add their files to ``written``, and return the defects of meshes."""
    uses, wrong = _report_uses(robot)
    jobs = list(dict.fromkeys((path, collides) for path, collides, _ in uses))
    made: dict[tuple[Path, bool], Converted] = {}
    if jobs and robot.source is not None:
        from .cache import convert_all

        results = convert_all([(*job, robot.source.gltf_up) for job in jobs])
        for job, result in zip(jobs, results, strict=True):
            if isinstance(result, Converted):
                made[job] = result
            else:
                wrong.extend(_report_unreadable(uses, job, result))
    if options.decompose and options.cutter is not None:
        _cut(options.cutter, uses, made, written)
    _report_notes(uses, made, written)
    files = _Files(written, options.mesh_dir)
    pieces: dict[int, list[MeshPiece]] = {}
    known: dict[tuple[str, Vector], str] = {}
    elements: dict[bool, list[etree._Element]] = {True: [], False: []}
    names = UniqueNames()
    for path, collides, shape in sorted(uses, key=lambda use: use[1]):
        if (path, collides) not in made:
            continue
        mesh = _make_mesh(shape)
        for index, piece in enumerate(made[path, collides].pieces):
            many = len(made[path, collides].pieces) > 1
            file = files.place(path, piece, index if many else None, collides)
            key = (file, mesh.scale)
            if key not in known:
                stem = file.rpartition(".")[0]
                known[key] = names.take(stem)
                elements[collides].append(_build_element(known[key], file, mesh.scale, piece))
            used = MeshPiece(known[key], piece.rgba, piece.texture, path.name)
            pieces.setdefault(id(mesh), []).append(used)
    sources = list(dict.fromkeys(path for path, _, _ in uses))
    return Assets(pieces, [*elements[False], *elements[True]], sources), wrong


_Use = tuple[Path, bool, Visual | Collision]


def _make_mesh(shape: Visual | Collision) -> Mesh:
    assert isinstance(shape.geometry, Mesh)
    return shape.geometry


def _report_uses(robot: Robot) -> tuple[list[_Use], list[Finding]]:
    uses: list[_Use] = []
    wrong: list[Finding] = []
    for link, shape in robot.shapes:
        mesh = shape.geometry
        if not isinstance(mesh, Mesh):
            continue
        path = find_file(robot, mesh.filename)
        if path is None:
            wrong.append(create_missing_mesh(robot, link, mesh))
        elif not all(mesh.scale):
            text = f"scale of mesh '{mesh.filename}' of link '{link.name}' has a zero in it"
            place = mesh.locate_attribute("scale")
            wrong.append(make_defect("bad-scale", text, place, "link", link.name))
        else:
            uses.append((path.resolve(), isinstance(shape, Collision), shape))
    return uses, wrong


def _report_unreadable(uses: list[_Use], job: tuple[Path, bool], message: str) -> Iterator[Finding]:
    path, collides = job
    shape = next(shape for file, role, shape in uses if (file, role) == job)
    if collides and any((file, role) == (path, False) for file, role, _ in uses):
        return  # reported for the visual
    place = _make_mesh(shape).locate_attribute("filename")
    link = shape.xml.parent if shape.xml is not None else None
    name = (link.get("name") or "") if link is not None else ""
    yield make_defect("corrupt-mesh", f"mesh {path}: {message}", place, "link", name)


def _cut(
    cutter: Cutter, uses: list[_Use], made: dict[tuple[Path, bool], Converted], written: Written
) -> None:
    """Replace collision meshes that are not convex by their convex decomposition."""
    places = {path: _make_mesh(shape) for path, collides, shape in uses if collides}
    uncut = [
        path
        for path in places
        if (path, True) in made and not made[path, True].thick
        if (ratio := made[path, True].hull) is None or ratio > HULL
    ]
    for path, result in cutter(uncut).items() if uncut else ():
        old = made[path, True]
        if isinstance(result, Cut):
            pieces = [Piece(write_obj_bytes(*piece)) for piece in result.pieces]
            made[path, True] = Converted(pieces, None, old.notes)
            count = "1 convex piece" if len(pieces) == 1 else f"{len(pieces)} convex pieces"
            text = f"is exported as {count}, whose surface is within {result.error:.2%} of its size"
            severity = Severity.INFO
        else:
            text = f"is not decomposed into convex pieces: {result}"
            severity = Severity.WARNING
        written.report_loss(
            "convex",
            f"{path.name} {text}",
            places[path].locate_attribute("filename"),
            kind="mesh",
            name=path.name,
            severity=severity,
        )


def _report_notes(
    uses: list[_Use], made: dict[tuple[Path, bool], Converted], written: Written
) -> None:
    """Report the notes of each conversion, and meshes that are not convex, once for each file."""
    reported: set[tuple[Path, MeshNote | None]] = set()
    for path, collides, shape in uses:
        result = made.get((path, collides))
        if result is None:
            continue
        place = _make_mesh(shape).locate_attribute("filename")
        for note in result.notes:
            if (path, note) not in reported:
                reported.add((path, note))
                written.report_loss(
                    "mesh",
                    f"{path.name}: {note.message}",
                    place,
                    kind="mesh",
                    name=path.name,
                    severity=Severity.WARNING if note.lossy else Severity.INFO,
                    data={"note": note.code},
                )
        if result.hull is not None and result.hull > HULL and (path, None) not in reported:
            reported.add((path, None))
            written.report_loss(
                "nonconvex",
                f"{path.name}: MuJoCo uses its convex hull for collision, whose volume is "
                f"{result.hull:.2f} "
                "times the mesh's",
                place,
                kind="mesh",
                name=path.name,
                hint="--decompose decomposes it into convex pieces",
                data={"hull_ratio": result.hull},
            )


class _Files:
    """Paths of mesh files in the export; equal content is stored once."""

    def __init__(self, written: Written, mesh_dir: str) -> None:
        self._written = written
        self._folder = mesh_dir
        self._names = UniqueNames(fold=True)
        self._known: dict[tuple[Path, bytes | None], str] = {}
        self._seen: set[str] = set()

    def place(self, path: Path, piece: Piece, index: int | None, collides: bool) -> str:
        """Return the name of a piece's file in the mesh folder, and add it to the export."""
        key = (path, piece.data)
        if key not in self._known:
            stem = replace_file_name(path.stem)
            folder = replace_file_name(path.parent.name)
            end = "" if index is None else f"_{index}"
            if collides and stem.casefold() in self._seen:
                candidates = [f"{stem}_collision{end}", f"{stem}_{folder}_collision{end}"]
            else:
                candidates = [f"{stem}{end}", f"{stem}_{folder}{end}"]
            if not collides:
                self._seen.add(stem.casefold())
            name = self._names.take(*candidates)
            suffix = path.suffix.lower() if piece.data is None else ".obj"
            self._known[key] = name + suffix
            where = f"{self._folder}/{name}{suffix}" if self._folder else name + suffix
            self._written.files[where] = path if piece.data is None else piece.data
        return self._known[key]


def _build_element(name: str, file: str, scale: Vector, piece: Piece) -> etree._Element:
    element = etree.Element("mesh")
    if name != file.rpartition(".")[0]:
        element.set("name", name)
    element.set("file", file)
    if scale != ONE:
        element.set("scale", format_numbers_text(scale))
    if piece.shell:
        element.set("inertia", "shell")
    return element
