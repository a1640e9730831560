"""How far joints move the points of two links within a box of joint values.

The theorem of the proof. Let c be the center of a box of joint values and q any point of it, with
half widths h. Number the joints on the path from link A to link B with 1 to n, and choose a split
s. Seen from the frame between the joints s and s + 1, only the joints s + 1 … n move B, and only
1 … s move A. Move the joints from c to q one after the other, n first. The joint k then turns about
the axis that it has at c, because the joints between the frame and k are still at c. A point at the
distance ρ from that axis at c, which the joints after k have moved by at most D, is at most at the
distance ρ + D from it, and moves along a chord of at most ``2 sin(min(h, π) / 2) (ρ + D)``; a
prismatic joint moves it by at most h. The sum over the joints bounds the displacement of each point
of B, and in the same way of A. So two bodies whose distance at c is larger than the sum of both
bounds do not touch at any q of the box, for each s.

A second bound is for a direction u, a unit vector in that frame. A joint k that turns by θ about
the axis (p, ω) moves a point z by ``sin θ ω × (z − p) + (1 − cos θ) ω × (ω × (z − p))``. Along u,
that is at most ``sin h |(u × ω) · (z − p)| + (1 − cos h) (ρ + D)``, and z differs from the point y
at c by at most D, so the first term is at most ``sin h (|(u × ω) · (y − p)| + D)``. A prismatic
joint moves z by at most ``h |u · ω|``. What depends on y is linear in y or the absolute value of
that, so its least sum with ``u · y`` over a convex piece is at a corner. The rest is of second
order in h: where the distance is least, the terms of first order vanish, and boxes can be as wide
as the root of the gap.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry.mesh import Array, Points
from .chain import Chain, Placement, Step


@dataclass(frozen=True, eq=False)
class Motion:
    """Bounds on the displacement of the pieces of A and of B within boxes.

    Attributes:
        bounds: Largest displacement of each piece of A and of B [m], shape (n, k).
        curves: Terms of second order along any direction [m], shape (n, k).
        turns: For A and for B, and for each joint, the sine of the half width; 0 of joints that do
            not move the side, shape (joints, n).
        slides: The same for the half width of translations [m].
        share: Share of each coordinate in the bounds [m], shape (n, number of coordinates).
        curve_share: Share of each coordinate in the terms of second order.
    """

    bounds: tuple[Array, Array]
    curves: tuple[Array, Array]
    turns: tuple[Array, Array]
    slides: tuple[Array, Array]
    share: Array
    curve_share: Array


def bound_motion(
    chain: Chain,
    placed: Placement,
    halves: Array,
    centers: tuple[Points, Points],
    radii: tuple[Array, Array],
) -> Motion:
    """Bound the displacement of each piece within boxes, for the best split of the joints.

    Args:
        chain: Joints.
        placed: Bodies at the centers of the boxes.
        halves: Half widths of the boxes [rad, m], shape (n, number of coordinates).
        centers: Centers of the pieces of A and of B in the placed frame [m], shape (n, k, 3).
        radii: Radii of their bounding spheres [m], shape (k,).
    """
    steps = chain.steps
    order = range(len(steps))
    of_a, curves_a = _accumulate(steps, placed, halves, centers[0], radii[0], order)
    of_b, curves_b = _accumulate(steps, placed, halves, centers[1], radii[1], order[::-1])
    of_b, curves_b = of_b[::-1], curves_b[::-1]
    worst_a, worst_b = _find_worst(of_a), _find_worst(of_b)
    split = np.argmin(worst_a + worst_b, axis=0)
    rows = np.arange(len(halves))
    return Motion(
        (np.stack(of_a)[split, rows], np.stack(of_b)[split, rows]),
        (np.stack(curves_a)[split, rows], np.stack(curves_b)[split, rows]),
        *_list_widths(steps, halves, split),
        _compute_share(steps, halves, split, worst_a, worst_b),
        _compute_share(steps, halves, split, _find_worst(curves_a), _find_worst(curves_b)),
    )


def _find_worst(bounds: Sequence[Array]) -> Array:
    return np.stack([bound.max(axis=1) for bound in bounds])


def _compute_share(
    steps: Sequence[Step], halves: Array, split: np.ndarray, worst_a: Array, worst_b: Array
) -> Array:
    """Return the share of each coordinate in bounds of A and of B."""
    share = np.zeros_like(halves)
    for index, step in enumerate(steps):
        of_a, of_b = worst_a[index + 1] - worst_a[index], worst_b[index] - worst_b[index + 1]
        share[:, step.column] += np.where(split > index, of_a, of_b)
    return share


def _list_widths(
    steps: Sequence[Step], halves: Array, split: np.ndarray
) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Return the sines and the translations of the joints that move A, and that move B."""
    sines, slides = np.zeros((2, len(steps), len(halves)))
    on_a = split > np.arange(len(steps))[:, None]
    for index, step in enumerate(steps):
        half = abs(step.scale) * halves[:, step.column]
        sines[index] = np.sin(np.minimum(half, np.pi / 2)) if step.turn else 0.0
        slides[index] = abs(step.slide) * half
    return (sines * on_a, sines * ~on_a), (slides * on_a, slides * ~on_a)


def _accumulate(
    steps: Sequence[Step],
    placed: Placement,
    halves: Array,
    centers: Points,
    radii: Array,
    order: Sequence[int],
) -> tuple[list[Array], list[Array]]:
    """List the bounds after none, one, two … of the joints in an order, each of shape (n, k).

    The second list has the terms of second order.
    """
    total = curve = np.zeros(centers.shape[:2])
    totals, curves = [total], [curve]
    for index in order:
        step = steps[index]
        half = abs(step.scale) * halves[:, step.column]
        more = (abs(step.slide) * half)[:, None]
        if step.turn:
            chord = 2 * np.sin(np.minimum(half, np.pi) / 2)
            between = centers - placed.points[index][:, None]
            along = np.einsum("nki,ni->nk", between, placed.axes[index])
            squared = np.einsum("nki,nki->nk", between, between) - along * along
            distance = np.sqrt(np.maximum(squared, 0.0)) + radii
            more = more + chord[:, None] * (distance + total)
            sine = np.sin(np.minimum(half, np.pi / 2))
            bend = (chord * chord / 2)[:, None] * (distance + total)
            curve = curve + sine[:, None] * total + bend
        total = total + more
        totals.append(total)
        curves.append(curve)
    return totals, curves
