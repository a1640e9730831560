"""Mesh files as prims: points once for each file and scale, instanced if used twice."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from pxr import Sdf, Usd, UsdGeom, UsdPhysics, Vt

from ...diagnostic import Severity
from ...errors import MeshError
from ...finding import Finding
from ...geometry.load import load_mesh
from ...geometry.mesh import Faces, Part, Points
from ...geometry.mesh import Mesh as Triangles
from ...model.elements import Collision, Link, Mesh, Robot, Vector, Visual
from ..common.assets import find_file
from ..common.cut import Cut, Cutter
from ..common.missing_files import create_missing_mesh
from ..common.naming import UniqueNames
from ..defects import make_defect
from ..written import Written
from .materials import Look, MaterialWriter
from .names import make_identifier
from .stage import GEOMETRY, PHYSICS, StageBuilder, apply, set_value

Key = tuple[Path, Vector, bool]
"""File, scale, and whether it is collision geometry."""


@dataclass
class Meshes:
    """The mesh files of a robot, and where they are in the stage.

    Attributes:
        builder: The stage.
        materials: Writer of materials.
        written: Receives the losses.
        approximation: Token of UsdPhysics for collision meshes.
        uses: Key of each shape by the ``id`` of its ``Mesh``.
        loaded: Triangles of each key.
        pieces: Vertices and triangles of the convex pieces of each collision mesh that was
            decomposed.
    """

    builder: StageBuilder
    materials: MaterialWriter
    written: Written
    approximation: str
    uses: dict[int, Key] = field(default_factory=dict)
    loaded: dict[Key, Triangles] = field(default_factory=dict)
    pieces: dict[Key, list[tuple[Points, Faces]]] = field(default_factory=dict)
    _prototypes: dict[Key, Sdf.Path] = field(default_factory=dict)
    _names: UniqueNames = field(default_factory=UniqueNames)

    def load(self, robot: Robot) -> list[Finding]:
        """Read all mesh files, and return the defects of meshes."""
        wrong: list[Finding] = []
        failed: set[Key] = set()
        gltf_up = robot.source.gltf_up if robot.source is not None else "y"
        for link, shape in robot.shapes:
            mesh = shape.geometry
            if not isinstance(mesh, Mesh):
                continue
            key, problem = _make_key(robot, link, shape, mesh)
            if problem is not None:
                wrong.append(problem)
            if key is None or key in failed:
                continue
            try:
                if key not in self.loaded:
                    self.loaded[key] = load_mesh(key[0], key[1], gltf_up=gltf_up)
            except MeshError as error:
                failed.add(key)
                text = f"mesh {key[0]}: {error.message}"
                place = mesh.locate_attribute("filename")
                wrong.append(make_defect("corrupt-mesh", text, place, "link", link.name))
                continue
            self.uses[id(mesh)] = key
        return wrong

    def cut(self, robot: Robot, cutter: Cutter) -> None:
        """Decompose the collision meshes into convex pieces, and report how well they fit."""
        keys = [key for key in self.loaded if key[2]]
        cuts = cutter(list(dict.fromkeys(key[0] for key in keys))) if keys else {}
        for key in keys:
            result = cuts[key[0]]
            if isinstance(result, Cut):
                self.pieces[key] = [_scale(piece, key[1]) for piece in result.pieces]
        for link in robot.links:
            for shape in link.collisions:
                key_of = self.uses.get(id(shape.geometry))
                if key_of is not None:
                    self._report_cut(link, shape, cuts[key_of[0]], key_of[0].name)

    def _report_cut(self, link: Link, shape: Collision, result: Cut | str, name: str) -> None:
        if isinstance(result, Cut):
            count = len(result.pieces)
            text = (
                f"is written as {count} convex piece{'s' if count > 1 else ''}, whose surface is "
            )
            text += f"within {result.error:.2%} of its size"
        else:
            text = f"is not decomposed into convex pieces: {result}"
        self.written.report_loss(
            "convex",
            f"{name} of link '{link.name}' {text}",
            shape.place,
            kind="link",
            name=link.name,
            severity=Severity.INFO if isinstance(result, Cut) else Severity.WARNING,
        )

    @property
    def shared(self) -> set[Key]:
        """Return the keys that several shapes use."""
        return {key for key, count in Counter(self.uses.values()).items() if count > 1}

    def write(self, prim: Usd.Prim, mesh: Mesh, *, is_shared: bool = True) -> bool:
        """Write a mesh below a prim, or as an instance; return False if it cannot be read.

        Args:
            prim: The prim.
            mesh: The mesh.
            is_shared: Whether it may be an instance, whose parts have no materials of their own.
        """
        key = self.uses.get(id(mesh))
        if key is None:
            return False
        if is_shared and key in self.shared:
            prim.GetReferences().AddInternalReference(self._write_prototype(key))
            prim.SetInstanceable(True)
        else:
            scope = self.builder.root.AppendChild("materials")
            self._write_pieces(prim.GetPath(), key, scope)
        return True

    def _write_prototype(self, key: Key) -> Sdf.Path:
        """Return the path of an abstract prim with the mesh."""
        if key not in self._prototypes:
            stage = self.builder.stage
            scope = self.builder.root.AppendChild("prototypes")
            with self.builder.edit_layer(GEOMETRY):
                stage.CreateClassPrim(scope)
            path = scope.AppendChild(self._names.take(make_identifier(key[0].stem, "mesh")))
            with self.builder.edit_layer(GEOMETRY):
                UsdGeom.Xform.Define(stage, path)
            self._write_pieces(path, key, path.AppendChild("materials"))
            self._prototypes[key] = path
        return self._prototypes[key]

    def _write_pieces(self, parent: Sdf.Path, key: Key, scope: Sdf.Path) -> None:
        """Write the mesh prims of a file: one for collisions, one for each look of visuals."""
        mesh = self.loaded[key]
        if key[2]:
            parts = self.pieces.get(key, [(mesh.vertices, mesh.faces)])
            token = UsdPhysics.Tokens.convexHull if key in self.pieces else self.approximation
            for index, (vertices, faces) in enumerate(parts):
                name = "mesh" if len(parts) == 1 else f"mesh_{index}"
                prim = self._write_mesh(parent.AppendChild(name), vertices, faces, None)
                with self.builder.edit_layer(PHYSICS):
                    make_collider(prim)
                    approximate(prim, token)
            return
        groups = _group_by_look(mesh)
        for index, (look, faces, uv) in enumerate(groups):
            name = "mesh" if len(groups) == 1 else f"mesh_{index}"
            prim = self._write_mesh(parent.AppendChild(name), mesh.vertices, faces, uv)
            if look is not None:
                self.materials.bind(prim, look, scope)

    def _write_mesh(
        self, path: Sdf.Path, vertices: Points, faces: Faces, uv: Points | None
    ) -> Usd.Prim:
        with self.builder.edit_layer(GEOMETRY):
            return write_triangles(self.builder.stage, path, vertices, faces, uv)


def write_triangles(
    stage: Usd.Stage, path: Sdf.Path, vertices: Points, faces: Faces, uv: Points | None = None
) -> Usd.Prim:
    """Create a mesh prim with the used vertices, each once.

    Args:
        stage: The stage.
        path: Path of the prim.
        vertices: Points [m], shape (n, 3).
        faces: Corners of triangles, shape (m, 3).
        uv: Texture coordinates of the corners, shape (m, 3, 2).
    """
    used, corners = np.unique(faces, return_inverse=True)
    points, same = np.unique(vertices[used].astype(np.float32), axis=0, return_inverse=True)
    corners = same.reshape(-1)[corners.reshape(-1)].astype(np.int32)
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points + np.float32(0)))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(corners))
    counts = np.full(len(corners) // 3, 3, dtype=np.int32)
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(counts))
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    extent = np.array([points.min(axis=0), points.max(axis=0)], dtype=np.float32)
    mesh.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(extent))
    if uv is not None:
        variable = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(
            "st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying
        )
        texels = np.ascontiguousarray(uv.reshape(-1, 2), dtype=np.float32)
        variable.Set(Vt.Vec2fArray.FromNumpy(texels))
    return mesh.GetPrim()


def make_collider(prim: Usd.Prim) -> None:
    """Make a prim collision geometry, which is not drawn."""
    UsdPhysics.CollisionAPI.Apply(prim)
    UsdGeom.Imageable(prim).CreatePurposeAttr(UsdGeom.Tokens.guide)


def approximate(prim: Usd.Prim, token: str) -> None:
    """Write how simulators replace a collision mesh; Newton keeps all vertices of its hull."""
    UsdPhysics.MeshCollisionAPI.Apply(prim).CreateApproximationAttr(token)
    if token == UsdPhysics.Tokens.convexHull:
        apply(prim, "NewtonMeshCollisionAPI")
        set_value(prim, "newton:maxHullVertices", "int", -1)


def _scale(piece: tuple[Points, Faces], scale: Vector) -> tuple[Points, Faces]:
    """Scale a piece; a mirrored one keeps its faces outward."""
    vertices, faces = piece
    turned = faces[:, ::-1] if scale[0] * scale[1] * scale[2] < 0 else faces
    return vertices * np.array(scale), turned


def _make_key(
    robot: Robot, link: Link, shape: Visual | Collision, mesh: Mesh
) -> tuple[Key | None, Finding | None]:
    path = find_file(robot, mesh.filename)
    if path is None:
        return None, create_missing_mesh(robot, link, mesh)
    if not all(mesh.scale):
        text = f"scale of mesh '{mesh.filename}' of link '{link.name}' has a zero"
        place = mesh.locate_attribute("scale")
        return None, make_defect("bad-scale", text, place, "link", link.name)
    return (path.resolve(), mesh.scale, isinstance(shape, Collision)), None


def _group_by_look(mesh: Triangles) -> list[tuple[Look | None, Faces, Points | None]]:
    """Group the faces by color and image, with their texture coordinates, in file order."""
    groups: dict[Look | None, list[Part]] = {}
    for part in mesh.parts:
        groups.setdefault(_look(part), []).append(part)
    return [
        (
            look,
            np.concatenate([mesh.get_part_faces(part) for part in parts]),
            _join_coordinates(parts),
        )
        for look, parts in groups.items()
    ]


def _look(part: Part) -> Look | None:
    image = part.texture if part.texture is not None else part.image
    if image is not None and part.uv is not None and np.isfinite(part.uv).all():
        return Look("", part.rgba, image)
    return None if part.rgba is None else Look("", part.rgba)


def _join_coordinates(parts: Iterable[Part]) -> Points | None:
    found = [part.uv for part in parts]
    known = [uv for uv in found if uv is not None and np.isfinite(uv).all()]
    return np.concatenate(known) if known and len(known) == len(found) else None
