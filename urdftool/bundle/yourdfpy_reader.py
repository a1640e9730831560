"""Comparison of a bundle with its source by yourdfpy, a reader that shares no code with ours."""

from __future__ import annotations

import io
import logging
import random
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import AccessError, UrdftoolError
from ..extras import require
from ..geometry.mesh import Array
from ..model.elements import Joint, Robot
from ..model.kinematics import compute_link_poses, find_movable_joints
from .defect import UNREADABLE_SOURCE, Defect
from .description import make_urdf

CONFIGURATIONS = 21
"""Compared configurations; the first is zero. Chosen, no source."""

_TOLERANCE = 1e-6
"""Difference of the poses of two readers that rounding explains. Chosen, no source."""


def load_robot(robot: Robot, **options: Any) -> Any:
    """Return a robot as a ``yourdfpy.URDF`` with every mesh resolved.

    Raises:
        ModelError: The robot was read from another format.
        MissingDependency: yourdfpy is not installed.
    """
    require("conversion to yourdfpy", "yourdfpy")
    import yourdfpy

    source = robot.source
    text = make_urdf(robot, robot.name).data

    def resolve(fname: str) -> str:
        try:
            return fname if source is None else str(source.resolve(fname))
        except AccessError:
            return f"refused/{Path(fname).name}"  # yourdfpy would open it
        except (UrdftoolError, ValueError):
            return fname

    with _without_messages():
        return yourdfpy.URDF.load(io.BytesIO(text), **{"filename_handler": resolve, **options})


def compare_with_source(
    robot: Robot, description: Path, path: str, errors: Mapping[str, float] | None = None
) -> list[Defect]:
    """Compare a bundle with its source as yourdfpy reads it.

    Compared are the names of links and joints, joint types, the pose of each link at 21
    configurations, and the bounds of each link's visual and collision geometry. The bounds of a
    link are not compared if a mesh has another format in the bundle, since yourdfpy reads the
    units and axes of formats differently.

    Args:
        robot: The source.
        description: The URDF of the bundle.
        path: Path of the URDF in the bundle, for messages.
        errors: Declared error of each reduced mesh by file name, relative to the diagonal of its
            bounding box; None for none.

    Raises:
        MissingDependency: yourdfpy is not installed.
    """
    require("--check of a new bundle", "yourdfpy")
    import yourdfpy

    both = {"load_collision_meshes": True, "build_collision_scene_graph": True}
    try:
        source = load_robot(robot, **both)
    except UrdftoolError:
        raise
    except Exception as error:
        message = f"not compared: yourdfpy cannot read the source: {error}"
        return [Defect(UNREADABLE_SOURCE, path, message)]
    try:
        with _without_messages():
            bundle = yourdfpy.URDF.load(str(description), **both)
    except Exception as error:
        return [Defect("unreadable", path, f"yourdfpy cannot read it: {error}")]
    found = list(_compare_names(robot, bundle))
    if not found:
        frames = _compare_frames(robot, source, bundle)
        found = [*frames, *_compare_bounds(source, bundle, errors or {})]
    return [Defect("differs-from-source", path, message) for message in found]


def _compare_names(robot: Robot, bundle: Any) -> Iterator[str]:
    links = [link.name for link in bundle.robot.links]
    if links != [link.name for link in robot.links]:
        yield "has other links than the source"
    joints = [(joint.name, joint.type) for joint in bundle.robot.joints]
    if joints != [(joint.name, joint.type) for joint in robot.joints]:
        yield "has other joints than the source"


def _compare_frames(robot: Robot, source: Any, bundle: Any) -> Iterator[str]:
    """Yield the links whose pose is neither that of our model nor that of the source."""
    movable = find_movable_joints(robot)
    leaders = {name: joint for name, joint in movable.items() if joint.mimic is None}
    compared = _list_comparable_links(robot)
    worst: dict[str, float] = {}
    for positions in _sample_positions(leaders):
        with _without_messages():
            bundle.update_cfg(positions)
            source.update_cfg(positions)
        poses = compute_link_poses(robot, positions)
        for name in compared:
            if name not in poses:
                continue
            matrix = np.asarray(bundle.get_transform(name))
            expected = np.eye(4)
            expected[:3, :3], expected[:3, 3] = poses[name].rotation, poses[name].translation
            off = _measure_difference(matrix, expected)
            if not off <= _TOLERANCE:  # loops and repeated names are read differently
                off = _measure_difference(matrix, np.asarray(source.get_transform(name)))
            worst[name] = max(worst.get(name, 0.0), off)
    for name, off in worst.items():
        if not off <= _TOLERANCE:
            yield f"the pose of link '{name}' differs from the source by {off:.3g}"


def _measure_difference(matrix: Array, expected: Array) -> float:
    """Return the largest difference of two poses; of positions beyond 1 m the relative one."""
    size = max(1.0, float(np.abs(expected[:3, 3]).max()))
    turned = np.abs(matrix[:3, :3] - expected[:3, :3]).max()
    return float(max(turned, np.abs(matrix[:3, 3] - expected[:3, 3]).max() / size))


def _list_comparable_links(robot: Robot) -> list[str]:
    """Return the links whose joints up to the root have at most one position each."""
    found: dict[str, bool] = {}
    roots = [name for name in robot.tree.order if robot.tree.get_parent_joint(name) is None]
    for name in robot.tree.order:
        joint = robot.tree.get_parent_joint(name)
        if joint is None:
            found[name] = len(roots) == 1
        else:
            simple = joint.type in ("fixed", "revolute", "continuous", "prismatic")
            unit = joint.type != "prismatic" or joint.axis is None or _is_unit(joint)
            chained = joint.mimic is not None and _is_chained(robot, joint)
            found[name] = found.get(joint.parent, False) and simple and unit and not chained
    return [name for name, is_comparable in found.items() if is_comparable]


def _is_unit(joint: Joint) -> bool:
    """Tell whether the axis has length 1; yourdfpy does not normalize that of a prismatic joint."""
    assert joint.axis is not None
    return abs(float(np.linalg.norm(joint.axis.xyz)) - 1.0) < 1e-9


def _is_chained(robot: Robot, joint: Joint) -> bool:
    """Tell whether a joint mimics a mimic joint, which yourdfpy does not follow."""
    leader = robot.joint.get(joint.mimic.joint) if joint.mimic is not None else None
    return leader is None or leader.mimic is not None


def _sample_positions(joints: Mapping[str, Joint]) -> Iterator[dict[str, float]]:
    """Yield zero and random positions within limits [rad, m]; the same in every run."""
    yield dict.fromkeys(joints, 0.0)
    chosen = random.Random(0)
    for _ in range(CONFIGURATIONS - 1):
        positions = {}
        for name, joint in joints.items():
            lower, upper = -1.0, 1.0
            if joint.limit is not None and joint.type != "continuous":
                lower = -1.0 if joint.limit.lower is None else max(joint.limit.lower, -10.0)
                upper = 1.0 if joint.limit.upper is None else min(joint.limit.upper, 10.0)
            positions[name] = chosen.uniform(lower, upper)
        yield positions


def _compare_bounds(source: Any, bundle: Any, errors: Mapping[str, float]) -> Iterator[str]:
    """Yield the links whose bounds differ by more than the declared errors of their meshes."""
    allowed = {
        link.name: max((errors.get(name, 0.0) for name in _list_meshes(link.visuals)), default=0.0)
        for link in bundle.robot.links
    }
    changed = {
        new.name
        for old, new in zip(source.robot.links, bundle.robot.links, strict=True)
        if _list_suffixes(old) != _list_suffixes(new)
    }
    scenes = (
        ("visual", source.scene, bundle.scene),
        ("collision", source.collision_scene, bundle.collision_scene),
    )
    for kind, old_scene, new_scene in scenes:
        old, new = _measure_links(source, old_scene), _measure_links(bundle, new_scene)
        for name in sorted((old.keys() | new.keys()) - changed):
            if name not in old or name not in new:
                yield f"the {kind} meshes of link '{name}' are not those of the source"
                continue
            error = allowed.get(name, 0.0) if kind == "visual" else 0.0
            off = _TOLERANCE + error * float(np.linalg.norm(old[name][1] - old[name][0]))
            if not np.allclose(old[name], new[name], _TOLERANCE, off, equal_nan=True):
                yield f"the bounds of the {kind} geometry of link '{name}' differ from the source"


def _list_suffixes(link: Any) -> list[str]:
    names = _list_meshes((*link.visuals, *link.collisions))
    return [Path(name).suffix.lower() for name in names]


def _list_meshes(shapes: Iterable[Any]) -> list[str]:
    """Return the file names of the meshes of visuals or collisions."""
    meshes = [shape.geometry.mesh for shape in shapes if shape.geometry is not None]
    return [Path(mesh.filename).name for mesh in meshes if mesh is not None]


def _measure_links(urdf: Any, scene: Any) -> dict[str, Array]:
    """Return the bounds of each link's geometry in its frame, shape (2, 3) [m]."""
    names = {link.name for link in urdf.robot.links}
    parents = scene.graph.transforms.parents
    links: dict[str, Array] = {}
    for node in sorted(scene.graph.nodes_geometry):
        link = node
        while link not in names and link in parents:
            link = parents[link]
        matrix, geometry = scene.graph.get(node, link)
        vertices = np.asarray(scene.geometry[geometry].vertices) @ matrix[:3, :3].T + matrix[:3, 3]
        bounds = np.array([vertices.min(axis=0), vertices.max(axis=0)])
        if link in links:
            bounds = np.array(
                [np.minimum(links[link][0], bounds[0]), np.maximum(links[link][1], bounds[1])]
            )
        links[link] = bounds
    return links


@contextmanager
def _without_messages() -> Iterator[None]:
    """Disable log messages of libraries during a ``with`` block."""
    level = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(level)
