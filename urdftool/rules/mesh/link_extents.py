"""Compute bounding boxes of shapes, meshes included; each mesh is read once."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ...model.attached import Attached, find_attached_links
from ...model.bounds import Bounds, compute_bounds, compute_bounds_at
from ...model.elements import Collision, Link, Mesh, Robot, Visual
from ...model.millimeters import find_shapes_in_millimeters
from ...model.pose import IDENTITY, Pose, make_pose
from ...source.description import GltfUp
from ...workspace import Workspace, memoize_by_workspace
from .file_references import find_buffers
from .mesh_uses import MeshUse, get_mesh_uses

if TYPE_CHECKING:
    from ...geometry.convex_points import ConvexPoints

ShapeKind = Literal["visuals", "collisions", "all"]

LARGEST = 10.0
"""[m] a longer mesh is in millimeters. Chosen, no source."""

SMALLEST = 0.001
"""Extent of a shape [m] up to which its unit is not believed. Chosen, no source."""


def get_convex_points(use: MeshUse) -> ConvexPoints | None:
    """Get the convex points of a mesh in its own frame, unscaled; None if it has none."""
    if use.path is None or not use.exists:
        return None
    try:
        return _read_convex_points(use.workspace, use.path, use.gltf_up)
    except OSError:
        return None


@memoize_by_workspace
def _read_convex_points(workspace: Workspace, path: Path, gltf_up: GltfUp) -> ConvexPoints | None:
    from ...geometry.convex_points import read_convex_points

    for buffer in find_buffers(workspace, path):
        workspace.record("file", buffer)
    return read_convex_points(workspace.materialize(path), gltf_up)


def compute_mesh_box(use: MeshUse, pose: Pose = IDENTITY) -> Bounds | None:
    """Compute the bounding box of a scaled mesh [m], in a frame in which its link has a pose."""
    found = get_convex_points(use)
    at = pose @ make_pose(use.shape.origin)
    return None if found is None else Bounds(*found.compute_box(use.mesh.scale, *at))


class LinkExtents:
    """Bounding boxes of the shapes of a robot's links, each computed on first use."""

    def __init__(self, robot: Robot) -> None:
        """Store the robot; meshes are read later."""
        self.robot = robot
        self._uses: dict[int, MeshUse] | None = None
        self._boxes: dict[int, Bounds | None] = {}
        self._links: dict[int, Bounds | None] = {}
        self._attached: dict[int, Attached] = {}
        self._in_millimeters = {
            id(shape) for link in robot.links for shape in find_shapes_in_millimeters(link)
        }

    def get_use(self, shape: Visual | Collision) -> MeshUse | None:
        """Get the mesh use of a shape; None if it is not a mesh."""
        if self._uses is None:
            source = self.robot.source
            uses = get_mesh_uses(self.robot, source) if source is not None else []
            self._uses = {id(use.shape): use for use in uses}
        return self._uses.get(id(shape))

    def get_shape_box(self, shape: Visual | Collision) -> Bounds | None:
        """Get the bounding box of one shape, in the frame of its link; None if unknown."""
        if id(shape) in self._in_millimeters:
            return None
        if id(shape) not in self._boxes:
            is_mesh = isinstance(shape.geometry, Mesh)
            self._boxes[id(shape)] = self._get_mesh_box(shape) if is_mesh else compute_bounds(shape)
        return self._boxes[id(shape)]

    def _get_mesh_box(self, shape: Visual | Collision) -> Bounds | None:
        box = self._get_written_box(shape)
        # a mesh in another unit is reported by itself, and does not show the size of the link
        return box if box is not None and SMALLEST < max(box.size) < LARGEST else None

    def _get_written_box(self, shape: Visual | Collision) -> Bounds | None:
        """Get the bounding box of a mesh at its scale; None if unknown."""
        use = self.get_use(shape)
        return compute_mesh_box(use) if use is not None and 0 not in use.mesh.scale else None

    def is_in_another_unit(self, shapes: Sequence[Visual | Collision]) -> bool:
        """Tell whether a mesh is so large or small that it is in another unit than meters."""
        boxes = [self._get_written_box(one) for one in shapes if isinstance(one.geometry, Mesh)]
        return any(box and not SMALLEST < max(box.size) < LARGEST for box in boxes)

    def get_shapes_box(self, shapes: Sequence[Visual | Collision]) -> Bounds | None:
        """Get the bounding box of several shapes; None if one is unknown or there are none."""
        box: Bounds | None = None
        for shape in shapes:
            other = self.get_shape_box(shape)
            if other is None:
                return None
            box = other if box is None else box.join(other)
        return box

    def get_link_box(self, link: Link) -> Bounds | None:
        """Get the bounding box of all shapes of a link; None if unknown.

        It is also unknown if visuals and collisions do not overlap, because one is misplaced.
        """
        if id(link) not in self._links:
            self._links[id(link)] = self._compute_link_box(link)
        return self._links[id(link)]

    def get_attached(self, link: Link) -> Attached:
        """Get a link and all links rigidly attached to it, with poses in its frame."""
        if id(link) not in self._attached:
            self._attached[id(link)] = find_attached_links(self.robot, link)
        return self._attached[id(link)]

    def get_counted(self, link: Link) -> Attached:
        """Get the attached links with geometry that hardly have a mass of their own."""
        return [
            (other, at)
            for other, at in self.get_attached(link)[1:]
            if other.mass <= 0.1 * link.mass and (other.visuals or other.collisions)
        ]

    def get_inertial_box(self, link: Link, box: Bounds) -> Bounds | None:
        """Get the bounding box of all geometry that a link's inertial may describe.

        It includes attached links that hardly have a mass of their own.

        Returns:
            The box [m]; None if that of an attached link is unknown.
        """
        for other, at in self.get_counted(link):
            more = self.get_body_box(link, "all", [(other, at)])
            if more is None:
                return None
            box = box.join(more)
        return box

    def get_body_box(
        self, link: Link, part: ShapeKind = "all", members: Attached | None = None
    ) -> Bounds | None:
        """Get the bounding box of a link and of all links rigidly attached to it.

        Args:
            link: The link in whose frame the box is.
            part: Which shapes count: ``visuals``, ``collisions`` or ``all``.
            members: The links that count, with their poses; all attached links if None.

        Returns:
            The box [m]; None if there is no such shape, or the box of one is unknown.
        """
        box: Bounds | None = None
        for member, pose in self.get_attached(link) if members is None else members:
            shapes: list[Visual | Collision] = []
            shapes += member.visuals if part != "collisions" else ()
            shapes += member.collisions if part != "visuals" else ()
            for shape in shapes:
                other = self._compute_box_at(shape, pose)
                if other is None:
                    return None
                box = other if box is None else box.join(other)
        return box if box is not None and any(box.size) else None

    def _compute_box_at(self, shape: Visual | Collision, pose: Pose) -> Bounds | None:
        """Compute the bounding box of a shape whose link has a pose."""
        if pose is IDENTITY:
            return self.get_shape_box(shape)
        if id(shape) in self._in_millimeters:
            return None
        if not isinstance(shape.geometry, Mesh):
            return compute_bounds_at(shape.geometry, pose @ make_pose(shape.origin))
        use = self.get_use(shape)
        return (
            None
            if use is None or self.get_shape_box(shape) is None
            else compute_mesh_box(use, pose)
        )

    def _compute_link_box(self, link: Link) -> Bounds | None:
        boxes = [self.get_shapes_box(part) for part in (link.visuals, link.collisions) if part]
        box: Bounds | None = None
        for other in boxes:
            if other is None or (box is not None and not box.meets(other)):
                return None
            box = other if box is None else box.join(other)
        return box if box is not None and any(box.size) else None


def get_extents(robot: Robot) -> LinkExtents:
    """Get the bounding boxes of a robot, shared by all rules."""
    return robot.memo.get("reaches", lambda: LinkExtents(robot))
