"""Checks of mass and inertia against the size of a link's shapes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product

import numpy as np

from ...mechanics.spatial_inertia import SpatialInertia
from ...mechanics.tensor import principal_axes, tensor_of_matrix
from ...model.elements import Link, Robot
from ..checks.thresholds import Thresholds
from ..extent import Extent, measure_extent
from ..fault import Fault
from ..recording import Array
from ..rigid_bodies import link_mass_properties
from ..run import Run

TOO_LARGE = "a tensor of ones, or of other units; the link turns far too slowly"


def has_shapes(robot: Robot, name: str) -> bool:
    """Tell whether a link has visual or collision geometry; one without is a frame."""
    return bool(robot.link[name].collisions or robot.link[name].visuals)


def check_mass_distribution(robot: Robot, link: Link, run: Run) -> Iterator[Fault]:
    """Report mass and inertia that no shape of a link's size could have."""
    bounds = run.thresholds
    own = link_mass_properties(link)
    if own is None or link.inertial is None:
        return
    share = own.mass / run.bodies.mass
    spread = math.sqrt(max(0.0, float(np.trace(own.inertia)) / 2 / own.mass))
    if not has_shapes(robot, link.name) and share < bounds.heavy_link:
        yield from _frame_inertia(robot, link, own, spread, run)
        return
    extent = _extent_around(robot, link, run, only_collisions=True)
    if _fits(extent, own, spread, bounds):
        return
    if not (share > bounds.light_link or _dominates(own.inertia, link.name, run)):
        return
    extent = _extent_around(robot, link, run)
    reach = extent.reach(np.array(own.com))
    heavy = share > bounds.light_link
    if reach and spread > (bounds.gyration_reach if heavy else bounds.light_gyration_reach) * reach:
        said = f"that of mass {spread:.3g} m from its centre; its shapes reach {reach:.3g} m"
    elif share > bounds.light_link and reach:
        said = _placeholder(own.inertia, own.mass, extent, bounds)
        if not said and _too_wide(own.inertia, own.mass, extent, bounds):  # or in what is fixed
            said = _too_wide(
                own.inertia, own.mass, _extent_around(robot, link, run, all_links=True), bounds
            )
    else:
        said = ""
    if said:
        yield Fault(
            "inertia-too-large",
            f"the inertia of link '{link.name}' is {said}",
            (link.inertial.inertia or link.inertial).place,
            "link",
            link.name,
            TOO_LARGE,
            "inertia-exceeds-geometry",
        )
    if share > bounds.light_link and extent.volume and own.mass > bounds.density * extent.volume:
        yield Fault(
            "too-dense",
            f"link '{link.name}' weighs {own.mass:.4g} kg, {own.mass / extent.volume:,.0f} kg/m³ "
            "of its shapes",
            link.inertial.place,
            "link",
            link.name,
            "lead is lighter: its mass is in grams, or its shapes in another unit",
            "implausible-density",
        )


def _frame_inertia(
    robot: Robot, link: Link, own: SpatialInertia, spread: float, run: Run
) -> Iterator[Fault]:
    """Report the tensor of a link without shapes that no part of the robot's size could have."""
    bodies = run.bodies.bodies
    if not run.bodies.size:  # nothing says how large it is
        return
    body = next(body for body in bodies if link.name in body.links)
    if any(has_shapes(robot, name) for name in body.links) or not _dominates(
        own.inertia, link.name, run
    ):
        return
    centre = np.array(body.places[link.name].transform(own.com))
    at = np.array(run.start.pose(bodies.index(body)).transform(tuple(centre.tolist())))
    reach = float(np.linalg.norm(_frame_origins(run) - at, axis=1).max())
    if spread > reach:  # on average, where not even the farthest corner is
        yield Fault(
            "inertia-too-large",
            f"the inertia of link '{link.name}' is that of mass {spread:.3g} m from its centre; "
            f"the whole robot reaches {reach:.3g} m",
            (link.inertial.inertia or link.inertial if link.inertial else link).place,
            "link",
            link.name,
            TOO_LARGE,
            "inertia-exceeds-geometry",
        )


def _frame_origins(run: Run) -> Array:
    """Collect frames of bodies and corners of their shapes at the start, shape (n, 3)."""
    found = []
    for number, body in enumerate(run.bodies.bodies):
        pose = run.start.pose(number)
        found.append(pose.translation)
        for shape in body.shapes:
            found += [
                pose.transform(corner) for corner in product(*zip(*shape.bounds(), strict=True))
            ]
    return np.array(found)


def _too_wide(tensor: Array, mass: float, extent: Extent, bounds: Thresholds) -> str:
    """Describe a tensor whose mass is spread beyond the shapes along an axis; empty if none."""
    moments, half = _halves(tensor, extent, bounds)
    spread = np.sqrt(np.maximum(0.0, moments.sum() / 2 - moments) / mass)
    worst = int((spread / half).argmax())
    if spread[worst] <= max(bounds.axis_spread * half[worst], bounds.axis_overhang * half.max()):
        return ""
    return (
        f"that of mass {spread[worst]:.3g} m to either side of its centre; its shapes reach "
        f"{half[worst]:.3g} m there"
    )


def _placeholder(tensor: Array, mass: float, extent: Extent, bounds: Thresholds) -> str:
    """Describe a placeholder: a power of ten about every axis, and too large; empty if none."""
    moment = float(tensor[0, 0])
    power = math.log10(moment) if moment > 0 else 0.5
    if abs(power - round(power)) > 1e-9 or not np.array_equal(tensor, moment * np.eye(3)):
        return ""
    _, half = _halves(tensor, extent, bounds)
    solid = mass / 3 * (float(half @ half) - half**2)
    if moment <= bounds.placeholder_ratio * solid.min():
        return ""
    return (
        f"{moment:g} kg·m² about every axis, which is made up; a solid of its size has "
        f"{solid.min():.2g} to {solid.max():.2g}"
    )


def _halves(tensor: Array, extent: Extent, bounds: Thresholds) -> tuple[Array, Array]:
    """Compute principal moments, and half the extent of the shapes along each axis [m]."""
    moments, axes = principal_axes(tensor_of_matrix(tensor))
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


def _extent_around(
    robot: Robot, link: Link, run: Run, *, only_collisions: bool = False, all_links: bool = False
) -> Extent:
    """Measure the extent of a link; without shapes, that of its rigid body, in its frame."""
    if has_shapes(robot, link.name) and not all_links:
        return measure_extent(robot, link.name, only_collisions=only_collisions)
    body = next(body for body in run.bodies.bodies if link.name in body.links)
    back = body.places[link.name].inverse()
    found = []
    for name in body.links:
        extent = measure_extent(robot, name, only_collisions=only_collisions)
        pose = back @ body.places[name]
        points = extent.points @ np.array(pose.rotation).T + np.array(pose.translation)
        found.append((points, extent.groups))
    every = zip(*(groups for _, groups in found if groups), strict=False)
    return Extent(
        np.concatenate([points for points, _ in found]),
        tuple(tuple(shape for shapes in group for shape in shapes) for group in every),
    )


def _fits(extent: Extent, own: SpatialInertia, spread: float, bounds: Thresholds) -> bool:
    reach = extent.reach(np.array(own.com))
    return bool(
        spread <= bounds.gyration_reach * reach
        and own.mass <= bounds.density * extent.volume
        and not (reach and _placeholder(own.inertia, own.mass, extent, bounds))
        and not (reach and _too_wide(own.inertia, own.mass, extent, bounds))
    )
