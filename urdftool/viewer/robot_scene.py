"""The robot in the scene: a node per link, its surfaces, and markers such as frames and axes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..diagnostic import Severity
from ..finding import Finding
from ..mechanics.tensor import compute_principal_axes, compute_second_moment
from ..model.elements import Inertial, Joint, Robot, Vector
from ..model.kinematics import MOVABLE, compute_motion
from ..model.pose import IDENTITY, Pose, Quaternion, make_pose, quaternion_from_rotation
from .marks import format_counts
from .properties import shorten_name
from .render_mesh import RenderMesh, compute_link_boxes, list_render_meshes

if TYPE_CHECKING:
    import viser

    from ..drawing.shapes import Shapes

KINDS = ("visual", "collision", "frames", "names", "axes", "com", "inertia", "errors", "warnings")
"""Parts of a robot's display that can be shown and hidden."""

CLEAR = 0.35
"""Opacity of visual geometry in see-through mode. Chosen, no source."""

COLLISION = (240, 140, 40)
"""Color of collision geometry. Chosen, no source."""

BOXES = {True: (60, 120, 230), False: (220, 30, 30)}
"""Color of the inertia box by whether the inertia is physically consistent."""

SELECTED = (255, 196, 0)
"""Color of the selected link. Chosen, no source."""

COLORS = {Severity.ERROR: (220, 30, 30), Severity.WARNING: (240, 130, 0)}
EDGES = [(0, 1), (0, 2), (0, 4), (3, 1), (3, 2), (3, 7), (5, 1), (5, 4), (5, 7), (6, 2), (6, 4),
         (6, 7)]  # fmt: skip


class RobotScene:
    """A robot in a scene.

    Parts that are hidden at first are created when first shown. Links are nodes below their
    parents, so a joint motion takes one message, regardless of the number of descendants.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        robot: Robot,
        load: Callable[[str], Shapes],
        clicked: Callable[[str], None],
        *,
        root: str = "/robot",
    ) -> None:
        """Create the nodes of the links; nothing is shown yet."""
        self.scene, self.robot = scene, robot
        self.shapes: dict[str, Shapes] = {}
        self._load, self._clicked = load, clicked
        self._nodes: dict[str, list[tuple[str, Any]]] = {}
        self._tinted: list[tuple[Any, tuple[int, int, int]]] = []
        self._outline: list[Any] = []
        self._opacity: dict[str, float | None] = {}
        self._findings: Mapping[str, list[Finding]] = {}
        self._paths: dict[str, str] = {}
        self._frames: dict[str, Any] = {}
        self._at: dict[str, float] = {}
        self.size = 1.0
        self._root = scene.add_frame(root, show_axes=False)
        for number, name in enumerate(robot.tree.order):
            joint = robot.tree.get_parent_joint(name)
            above = root if joint is None else self._paths.get(joint.parent)
            if above is None:
                continue
            self._paths[name] = f"{above}/{number}"
            pose = replace_invalid_pose(IDENTITY if joint is None else make_pose(joint.origin))
            self._frames[name] = scene.add_frame(
                self._paths[name],
                show_axes=False,
                wxyz=to_quaternion(pose),
                position=pose.translation,
            )

    @property
    def links(self) -> tuple[str, ...]:
        """Return the links in the scene; those without a path to a root are missing."""
        return tuple(self._paths)

    def remove(self) -> None:
        """Remove the robot from the scene."""
        self._root.remove()

    def move(self, positions: Mapping[str, float]) -> int:
        """Move joints to positions [rad or m]; joints without one move to 0.

        Returns:
            Number of links with a new pose.
        """
        moved = 0
        for name, frame in self._frames.items():
            joint = self.robot.tree.get_parent_joint(name)
            if joint is None or joint.type not in MOVABLE:
                continue
            value = positions.get(joint.name, 0.0)
            if value == self._at.get(name, 0.0):
                continue
            self._at[name] = value
            pose = replace_invalid_pose(make_pose(joint.origin) @ compute_motion(joint, value))
            frame.wxyz, frame.position = to_quaternion(pose), pose.translation
            moved += 1
        return moved

    def measure(self, poses: Mapping[str, Pose]) -> tuple[Vector, Vector]:
        """Compute the bounding box of the loaded geometry and the link frames [m].

        Returns:
            Lower and upper corner. ``size`` becomes the length of the diagonal.
        """
        points = [[*pose.translation] for name, pose in poses.items() if name in self._paths]
        points = [point for point in points if all(map(math.isfinite, point))]
        for shapes in self.shapes.values():
            corners, _, there = shapes.transform(poses)
            if there.any():
                seen = corners[there].reshape(-1, 3)
                points += [seen.min(axis=0).tolist(), seen.max(axis=0).tolist()]
        cloud = np.array(points or [[0.0, 0.0, 0.0]])
        low, high = cloud.min(axis=0), cloud.max(axis=0)
        self.size = float(np.linalg.norm(high - low)) or 1.0
        return (low[0], low[1], low[2]), (high[0], high[1], high[2])

    def load(self, kind: str) -> Shapes:
        """Return the triangles of ``"visual"`` or ``"collision"``, read once."""
        if kind not in self.shapes:
            self.shapes[kind] = self._load(kind)
        return self.shapes[kind]

    def show(self, kind: str, visible: bool) -> None:
        """Show or hide one of ``KINDS``."""
        if kind not in self._nodes:
            if not visible:
                return
            self._nodes[kind] = list(getattr(self, f"_make_{kind}")())
        for _, node in self._nodes[kind]:
            node.visible = visible

    def set_transparent(self, transparent: bool) -> None:
        """Make visual geometry see-through or restore it; textured meshes are unchanged."""
        for _, node in self._nodes.get("visual", []):
            if hasattr(node, "opacity"):
                before = self._opacity.setdefault(node.name, node.opacity)
                node.opacity = min(before or 1.0, CLEAR) if transparent else before

    def mark(self, findings: Mapping[str, list[Finding]], shown: Iterable[str]) -> None:
        """Mark each link with its findings."""
        self._findings = findings
        for kind in ("errors", "warnings"):
            for _, node in self._nodes.pop(kind, []):
                node.remove()
            self.show(kind, kind in shown)

    def select(self, *links: str) -> None:
        """Highlight links, and no others."""
        for node, color in self._tinted:
            node.color = color
        for node in self._outline:
            node.remove()
        self._tinted, self._outline = [], []
        for link in links:
            if link in self._paths:
                self._highlight(link)

    def _highlight(self, link: str) -> None:
        path = self._paths[link]
        for kind in ("visual", "collision"):
            for name, node in self._nodes.get(kind, []):
                if name == link and hasattr(node, "color"):
                    self._tinted.append((node, tuple(node.color)))
                    node.color = SELECTED
        for kind, shapes in self.shapes.items():
            box = compute_link_boxes(shapes).get(link)
            if box is not None and kind in self._nodes:
                self._outline.append(self._make_edges(f"{path}/outline", *box))
                break
        self._outline.append(self._make_frame(f"{path}/selected"))
        name = shorten_name(link)
        self._outline.append(self.scene.add_label(f"{path}/called", name, anchor="bottom-center"))

    def _make_visual(self) -> Iterable[tuple[str, Any]]:
        return self._make_surfaces("visual")

    def _make_collision(self) -> Iterable[tuple[str, Any]]:
        return self._make_surfaces("collision")

    def _make_surfaces(self, kind: str) -> Iterable[tuple[str, Any]]:
        for number, (link, look) in enumerate(list_render_meshes(self.load(kind))):
            if link in self._paths:
                node = self._make_surface(f"{self._paths[link]}/{kind}{number}", look, kind)
                node.on_click(lambda _, link=link: self._clicked(link))
                yield link, node

    def _make_surface(self, path: str, look: RenderMesh, kind: str) -> Any:
        if kind == "collision":
            return self.scene.add_mesh_simple(
                path, look.vertices, look.faces, color=COLLISION, opacity=0.5, side="double",
                cast_shadow=False, receive_shadow=False,
            )  # fmt: skip
        if look.glb is not None:
            return self.scene.add_glb(path, look.glb, cast_shadow=False, receive_shadow=False)
        return self.scene.add_mesh_simple(
            path,
            look.vertices,
            look.faces,
            color=look.rgb,
            opacity=None if look.opacity >= 1.0 else look.opacity,
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )

    def _make_frames(self) -> Iterable[tuple[str, Any]]:
        for link, path in self._paths.items():
            yield link, self._make_frame(f"{path}/frame")

    def _make_frame(self, path: str) -> Any:
        long = 0.1 * self.size
        return self.scene.add_frame(path, axes_length=long, axes_radius=long / 25)

    def _make_names(self) -> Iterable[tuple[str, Any]]:
        for link, path in self._paths.items():
            yield (
                link,
                self.scene.add_label(f"{path}/name", shorten_name(link), anchor="bottom-left"),
            )

    def _make_axes(self) -> Iterable[tuple[str, Any]]:
        long = 0.14 * self.size
        for link, path in self._paths.items():
            joint = self.robot.tree.get_parent_joint(link)
            direction = get_unit_axis(joint)
            if direction is None:
                continue
            ends = np.array([[[-0.5 * long * part for part in direction],
                              [long * part for part in direction]]])  # fmt: skip
            yield link, self.scene.add_arrows(
                f"{path}/axis", ends, (170, 40, 200), shaft_radius=long / 40,
                head_radius=long / 16, head_length=long / 6,
            )  # fmt: skip

    def _make_com(self) -> Iterable[tuple[str, Any]]:
        for link, path in self._paths.items():
            inertial = self.robot.link[link].inertial
            if inertial is None or not inertial.mass:
                continue
            at = replace_invalid_pose(make_pose(inertial.origin)).translation
            yield link, self.scene.add_icosphere(
                f"{path}/com", 0.012 * self.size, (20, 20, 20), position=at, cast_shadow=False,
                subdivisions=2,
            )  # fmt: skip

    def _make_inertia(self) -> Iterable[tuple[str, Any]]:
        for link, path in self._paths.items():
            box = compute_inertia_box(self.robot.link[link].inertial)
            if box is None:
                continue
            yield link, self.scene.add_box(
                f"{path}/inertia", BOXES[box.possible], box.size, wxyz=to_quaternion(box.pose),
                position=box.pose.translation, opacity=0.45, cast_shadow=False,
                receive_shadow=False,
            )  # fmt: skip

    def _make_errors(self) -> Iterable[tuple[str, Any]]:
        return self._make_marks(Severity.ERROR, "top-left")

    def _make_warnings(self) -> Iterable[tuple[str, Any]]:
        return self._make_marks(Severity.WARNING, "center-left")

    def _make_marks(self, severity: Severity, anchor: Any) -> Iterable[tuple[str, Any]]:
        """Create a ball and a label at each link with findings of a severity."""
        for link, path in self._paths.items():
            some = [f for f in self._findings.get(link, []) if f.severity == severity]
            if not some:
                continue
            radius = (0.010 + 0.002 * severity) * self.size
            yield link, self.scene.add_icosphere(
                f"{path}/{severity.label}", radius, COLORS[severity], cast_shadow=False,
                subdivisions=2,
            )  # fmt: skip
            yield (
                link,
                self.scene.add_label(
                    f"{path}/{severity.label}s", format_counts(some), anchor=anchor
                ),
            )

    def _make_edges(self, path: str, low: Any, high: Any) -> Any:
        corners = [[(low, high)[(k >> axis) & 1][axis] for axis in range(3)] for k in range(8)]
        points = np.array([[corners[a], corners[b]] for a, b in EDGES])
        return self.scene.add_line_segments(path, points, SELECTED, **_make_thickness(2.0))


def _make_thickness(pixels: float) -> dict[str, Any]:
    return {"thickness": pixels, "thickness_units": "screen"}


def get_unit_axis(joint: Joint | None) -> Vector | None:
    """Return the unit axis of a revolute, continuous or prismatic joint; None if it has none."""
    if joint is None or joint.type not in MOVABLE:
        return None
    x, y, z = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    length = math.hypot(x, y, z)
    if not (length and math.isfinite(length)):
        return None
    return x / length, y / length, z / length


def replace_invalid_pose(pose: Pose) -> Pose:
    """Return the pose if all its numbers are finite, or else the identity."""
    numbers = (*(part for row in pose.rotation for part in row), *pose.translation)
    return pose if all(map(math.isfinite, numbers)) else IDENTITY


def to_quaternion(pose: Pose) -> Quaternion:
    """Return the rotation of a pose as a quaternion in the scene's order (w, x, y, z)."""
    return quaternion_from_rotation(pose.rotation)


@dataclass(frozen=True)
class InertiaBox:
    """A box in the frame of its link.

    Attributes:
        size: Edges [m].
        pose: Pose of its center, along its edges.
        possible: Whether the inertia is physically consistent; if not, an edge whose square would
            be negative has length 0.
    """

    size: Vector
    pose: Pose
    possible: bool


def compute_inertia_box(inertial: Inertial | None) -> InertiaBox | None:
    """Compute the box of uniform density with the mass and inertia of a link.

    The edge along a principal axis is √(12 s / m), with s = ∫ x² dm the second moment, which is m
    a² / 12 for a box of edge a.

    Returns:
        None if mass or inertia is missing, not positive or not finite.
    """
    if inertial is None or inertial.inertia is None or not inertial.mass:
        return None
    pose = make_pose(inertial.origin)
    numbers = (*inertial.inertia.six, inertial.mass, *pose.translation, *pose.rotation[0])
    if (
        inertial.mass < 0
        or not all(map(math.isfinite, numbers))
        or not any(inertial.inertia.moments)
    ):
        return None
    moments, axes = compute_principal_axes(compute_second_moment(inertial.inertia.six))
    squares = 12.0 * moments / inertial.mass
    x, y, z = (float(edge) for edge in np.sqrt(np.maximum(squares, 0.0)))
    rows = axes.tolist()
    turned = Pose((tuple(rows[0]), tuple(rows[1]), tuple(rows[2])), (0.0, 0.0, 0.0))
    possible = bool(squares.min() >= -1e-9 * squares.max())
    return InertiaBox((x, y, z), pose @ turned, possible)
