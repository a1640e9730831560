"""Decide whether the mass and inertia of a link affect a run, by the size of its shapes."""

from __future__ import annotations

import math
from itertools import product

import numpy as np

from ...mechanics.spatial_inertia import SpatialInertia
from ...mechanics.tensor import compute_principal_axes, from_matrix
from ...model.elements import Link, Robot
from ..checks.thresholds import Thresholds
from ..extent import Extent, measure_extent
from ..recording import Array
from ..rigid_bodies import link_mass_properties
from ..run import Run


def has_shapes(robot: Robot, name: str) -> bool:
    """Tell whether a link has visual or collision geometry; one without is a frame."""
    return bool(robot.link[name].collisions or robot.link[name].visuals)


def compute_mass_share(link: Link, run: Run) -> float:
    """Return the mass of a link over that of the robot."""
    own = link_mass_properties(link)
    return 0.0 if own is None else own.mass / run.bodies.mass


def slows_link(robot: Robot, link: Link, run: Run, *, placeholder: bool) -> bool:
    """Tell whether an inertia that is too large for its link slows what the engine simulated.

    The link must have a large part of the robot's mass, or of the inertia of its rigid body, and
    the tensor must imply mass outside of its shapes.
    """
    bounds = run.thresholds
    own = link_mass_properties(link)
    if own is None:
        return False
    share = compute_mass_share(link, run)
    spread = math.sqrt(max(0.0, float(np.trace(own.inertia)) / 2 / own.mass))
    if not has_shapes(robot, link.name) and share < bounds.heavy_link:
        return _slows_frame(robot, link, own, spread, run)
    heavy = share > bounds.light_link
    if not (heavy or _dominates(own.inertia, link.name, run)):
        return False
    extent = _measure_extent_around(robot, link, run)
    reach = extent.measure_reach(np.array(own.com))
    if reach and spread > (bounds.gyration_reach if heavy else bounds.light_gyration_reach) * reach:
        return True
    if not heavy or not reach:
        return False
    if placeholder and _exceeds_solid(own.inertia, own.mass, extent, bounds):
        return True
    around = _measure_extent_around(
        robot, link, run, all_links=True
    )  # the mass may be in fixed links
    return all(_is_too_wide(own.inertia, own.mass, one, bounds) for one in (extent, around))


def _slows_frame(robot: Robot, link: Link, own: SpatialInertia, spread: float, run: Run) -> bool:
    """Tell whether the tensor of a link without shapes implies mass outside of the robot."""
    bodies = run.bodies.bodies
    if not run.bodies.size:  # the size of the robot is unknown
        return False
    body = next(body for body in bodies if link.name in body.links)
    if any(has_shapes(robot, name) for name in body.links) or not _dominates(
        own.inertia, link.name, run
    ):
        return False
    center = np.array(body.places[link.name].transform(own.com))
    at = np.array(run.start.get_pose(bodies.index(body)).transform(tuple(center.tolist())))
    reach = float(np.linalg.norm(_collect_frame_origins(run) - at, axis=1).max())
    return spread > reach  # radius of gyration beyond the farthest corner


def _collect_frame_origins(run: Run) -> Array:
    """Collect frames of bodies and corners of their shapes at the start, shape (n, 3)."""
    found = []
    for number, body in enumerate(run.bodies.bodies):
        pose = run.start.get_pose(number)
        found.append(pose.translation)
        for shape in body.shapes:
            found += [
                pose.transform(corner) for corner in product(*zip(*shape.get_bounds(), strict=True))
            ]
    return np.array(found)


def _is_too_wide(tensor: Array, mass: float, extent: Extent, bounds: Thresholds) -> bool:
    """Tell whether the mass of a tensor is spread beyond the shapes along an axis."""
    moments, half = _compute_halves(tensor, extent, bounds)
    spread = np.sqrt(np.maximum(0.0, moments.sum() / 2 - moments) / mass)
    worst = int((spread / half).argmax())
    return bool(
        spread[worst] > max(bounds.axis_spread * half[worst], bounds.axis_overhang * half.max())
    )


def _exceeds_solid(tensor: Array, mass: float, extent: Extent, bounds: Thresholds) -> bool:
    """Tell whether a placeholder is larger than the tensor of a solid of the link's size."""
    _, half = _compute_halves(tensor, extent, bounds)
    solid = mass / 3 * (float(half @ half) - half**2)
    return bool(tensor[0, 0] > bounds.placeholder_ratio * solid.min())


def _compute_halves(tensor: Array, extent: Extent, bounds: Thresholds) -> tuple[Array, Array]:
    """Compute principal moments, and half the extent of the shapes along each axis [m]."""
    moments, axes = compute_principal_axes(from_matrix(tensor))
    along = extent.points @ axes
    half = (along.max(axis=0) - along.min(axis=0)) / 2
    return moments, np.maximum(half, bounds.sheet_thickness * half.max())


def _dominates(tensor: Array, name: str, run: Run) -> bool:
    """Tell whether a light link's tensor dominates that of its rigid body."""
    body = next(body for body in run.bodies.bodies if name in body.links)
    assert body.properties is not None
    return bool(
        np.trace(tensor) > run.thresholds.dominant_inertia * np.trace(body.properties.inertia)
    )


def _measure_extent_around(
    robot: Robot, link: Link, run: Run, *, all_links: bool = False
) -> Extent:
    """Measure the extent of a link; without shapes, that of its rigid body, in its frame."""
    if has_shapes(robot, link.name) and not all_links:
        return measure_extent(robot, link.name)
    body = next(body for body in run.bodies.bodies if link.name in body.links)
    back = body.places[link.name].invert()
    found = []
    for name in body.links:
        extent = measure_extent(robot, name)
        pose = back @ body.places[name]
        points = extent.points @ np.array(pose.rotation).T + np.array(pose.translation)
        found.append((points, extent.groups))
    every = zip(*(groups for _, groups in found if groups), strict=False)
    return Extent(
        np.concatenate([points for points, _ in found]),
        tuple(tuple(shape for shapes in group for shape in shapes) for group in every),
    )
