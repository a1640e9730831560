"""Compare the mass properties of the left and the right side of a robot."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from ...mechanics.spatial_inertia import SpatialInertia, combine_links
from ...mechanics.tensor import SymmetricTensor, compute_principal_moments, rotate_tensor
from ...model.attached import find_attached_links
from ...model.elements import Link, Robot, Vector
from ...model.link import COMPONENTS
from ...model.part import Part
from ...model.pose import compute_norm, rotate, transpose
from ..fix import FixContext, Proposal, set_attribute, unsafe
from ..mesh.link_extents import get_extents
from ..rule import ANY_FORMAT, INFO, UNSAFE, WARNING, Problem, rule
from ..symmetry import Pair, Sides, get_family, get_sides, map_twin_links
from .tensors import is_accepted, is_zero

_CHECKING = "gz, gazebo-classic, mujoco, drake"


@rule(
    INFO,
    effects={
        _CHECKING: "take the two as written",
        "pinocchio": "takes the two as written",
        "pybullet": "takes the two as written",
    },
    of_motion=True,
    group="robot",
    caused_by=(
        *("zero-mass", "zero-inertia", "singular-inertia", "placeholder-inertia"),
        *("inertia-component-typo", "inertia-off-by-power-of-ten", "inertia-exceeds-geometry"),
        *("inertia-triangle-inequality", "inertia-not-positive-definite"),
    ),
    formats=ANY_FORMAT,
    infos=True,
    pedantic="moments, and distances of centers of mass, that differ by a factor below 1.5",
)
def left_right_asymmetry(
    robot: Robot,
    *,
    mass_difference: float = 0.05,
    com_difference: float = 0.1,
    inertia_difference: float = 0.2,
    least_distance: float = 0.005,
    certain: float = 5.0,
) -> Iterator[Problem]:
    """A link and its mirror image differ in mass, center of mass or inertia.

    Usually only one of the two was changed, or one was mistyped. Pairs are recognized by their
    names, such as ``left_arm`` and ``right_arm``. Compared are values that do not depend on the
    orientation of the frames: the mass, the distance of the center of mass from the frame, and the
    sum of the moments of inertia. ``mass_difference``, ``com_difference`` and
    ``inertia_difference`` are the tolerated relative differences, and ``least_distance`` [m] the
    smallest difference of two centers of mass that is reported. A mass that is ``certain`` times
    the other is a warning. Parts of rigid bodies that
    mirror each other as a whole are not reported. One finding names all links of a robot.
    """
    tolerances = mass_difference, com_difference, inertia_difference
    found = [
        (link, other, difference)
        for link, other in _list_unlike_bodies(robot, tolerances)
        if (difference := _compare(robot, link, other, tolerances, least_distance)) is not None
    ]
    keys = [_select_readers(link, other, difference) for link, other, difference in found]
    shared = [key for key in keys[0] if all(key in each for each in keys)] if keys else []
    for link, other, difference in found:
        masses = link.mass, other.mass
        yield Problem(
            other,
            difference.message,
            at=difference.at,
            data={"twin": link.name, **difference.data},
            severity=WARNING
            if difference.of == "mass" and max(masses) >= certain * min(masses)
            else None,
            effects=shared,
            pedantic=difference.ratio < _CLEARLY,
            group="{count} links differ from their mirror images in mass, center of mass or "
            f"inertia, first: {difference.message}; links: {{names}}",
        )


_CLEARLY = 1.5
"""Ratio of moments, or of distances of centers of mass, that two exports of one CAD model do not
have. Chosen, no source.
"""


class _Difference(NamedTuple):
    """The first difference of a link from its mirror image."""

    of: str
    message: str
    at: Part
    data: dict[str, float]
    ratio: float = math.inf
    """Ratio of the larger value to the smaller one; not computed for masses."""


def _list_unlike_bodies(
    robot: Robot, tolerances: tuple[float, float, float]
) -> Iterator[tuple[Link, Link]]:
    """Find links with a mass and their mirror images, unless their rigid bodies are alike."""
    twins = map_twin_links(robot)
    for link in robot.links:
        other = robot.link.get(twins.get(link.name, ""))
        if other is None or min(link.mass, other.mass) <= 0:
            continue
        bodies = _compute_bodies(robot, link, other)
        if bodies is None:
            yield link, other
            continue
        values = [(body.mass, compute_norm(body.com), _trace(body)) for body in bodies]
        if any(map(_is_different, *values, tolerances)):
            yield link, other


def _compare(
    robot: Robot,
    link: Link,
    other: Link,
    tolerances: tuple[float, float, float],
    least_distance: float,
) -> _Difference | None:
    """Compare a link with its mirror image: the first difference above a tolerance, or None."""
    if link.inertial is None or other.inertial is None:
        return None
    of_mass, of_com, of_inertia = tolerances
    if _is_different(link.mass, other.mass, of_mass):
        return _Difference(
            "mass",
            f"mass of link '{other.name}' is {other.mass:g} kg, but that of its mirror image "
            f"'{link.name}' is {link.mass:g} kg; make them equal",
            other.inertial,
            {"mass": other.mass, "mass_of_twin": link.mass},
        )
    here, there = _compute_com_distance(link), _compute_com_distance(other)
    is_far = _is_different(here, there, of_com) and abs(here - there) > least_distance
    if is_far and not _are_mirrored_in_root(get_sides(robot), link, other):
        return _Difference(
            "center",
            f"center of mass of link '{other.name}' is {there:.3g} m from its frame, but that "
            f"of its mirror image '{link.name}' {here:.3g} m; make the distances equal",
            other.inertial.origin or other.inertial,
            {"distance": there, "distance_of_twin": here},
            _divide(here, there),
        )
    # zero-inertia and others report moments that are none
    if not (_has_moments(link) and _has_moments(other)):
        return None
    if _is_different(_spread(link), _spread(other), of_inertia):
        return _Difference(
            "moments",
            f"principal moments of inertia of link '{other.name}', in ascending order, are "
            f"{_compute_factors(other, link)} times those of its mirror image '{link.name}'",
            other.inertial.inertia or other.inertial,
            {},
            _divide(_spread(link), _spread(other)),
        )
    return None


def _are_mirrored_in_root(sides: Sides, link: Link, other: Link) -> bool:
    """Tell whether two centers of mass are mirror images in the root frame.

    The frames may be displaced along the axes of their joints.
    """
    points = [_locate_com(sides, one) for one in (link, other)]
    if points[0] is None or points[1] is None:
        return False
    normal = 1 if sides.normal is None else sides.normal
    image = [-x if axis == normal else x for axis, x in enumerate(points[1])]
    return math.dist(points[0], image) <= _NEAR_IMAGE


_NEAR_IMAGE = 0.002
"""Largest distance of a center of mass from the mirror image of its twin [m]. Chosen, no source."""


def _locate_com(sides: Sides, link: Link) -> Vector | None:
    """Locate a center of mass in the root frame [m]; None if the pose of the link is unknown."""
    pose = sides.poses.get(link.name)
    origin = link.inertial.origin if link.inertial is not None else None
    return None if pose is None else pose.transform(origin.xyz if origin else (0.0, 0.0, 0.0))


def _compute_factors(link: Link, other: Link) -> str:
    """Divide the principal moments of a link by those of another: ``2``, or ``0.5 to 3``."""
    mine, its = (_compute_moments(one) for one in (link, other))
    factors = sorted(one / two for one, two in zip(mine, its, strict=True))
    least, most = (f"{factor:.2g}" for factor in (factors[0], factors[-1]))
    return least if least == most else f"{least} to {most}"


def _compute_moments(link: Link) -> Vector:
    assert link.inertial is not None
    assert link.inertial.inertia is not None
    return compute_principal_moments(link.inertial.inertia.six)


def _select_readers(link: Link, other: Link, difference: _Difference) -> list[str]:
    """Get the keys of effects for the readers that take a difference as written.

    PyBullet computes the moments itself.
    """
    accepted = all(
        one.inertial is not None
        and one.inertial.inertia is not None
        and is_accepted(one.inertial.inertia.six)
        for one in (link, other)
    )
    return [*[_CHECKING] * accepted, "pinocchio", *["pybullet"] * (difference.of != "moments")]


def _has_moments(link: Link) -> bool:
    """Tell whether all moments of an inertia are positive, beyond rounding."""
    inertia = link.inertial.inertia if link.inertial is not None else None
    if inertia is None:
        return False
    six = inertia.six
    return not is_zero(six, link.mass) and compute_principal_moments(six)[0] > 0


def _compute_bodies(
    robot: Robot, link: Link, other: Link
) -> tuple[SpatialInertia, SpatialInertia] | None:
    """Add up the bodies of two links; None if they are one body, or only the two links."""
    first, second = find_attached_links(robot, link), find_attached_links(robot, other)
    if len(first) == len(second) == 1 or any(one is other for one, _ in first):
        return None
    return combine_links(first), combine_links(second)


def _trace(body: SpatialInertia) -> float:
    """Sum the moments of a body [kg·m²]."""
    return body.tensor[0] + body.tensor[3] + body.tensor[5]


def _divide(one: float, other: float) -> float:
    """Divide the larger of two numbers by the smaller one."""
    least = min(abs(one), abs(other))
    return max(abs(one), abs(other)) / least if least else math.inf


def _is_different(one: float, other: float, part: float) -> bool:
    return abs(one - other) > part * max(abs(one), abs(other))


def _compute_com_distance(link: Link) -> float:
    """Compute the distance of the center of mass from the frame of the link [m]."""
    origin = link.inertial.origin if link.inertial is not None else None
    return math.hypot(*origin.xyz) if origin is not None else 0.0


def _spread(link: Link) -> float:
    """Compute the sum of the moments [kg·m²], which is the same in every frame."""
    inertia = link.inertial.inertia if link.inertial is not None else None
    return sum(inertia.moments) if inertia is not None else 0.0


@rule(
    WARNING,
    effects={"mujoco, pybullet, pinocchio": "take it as written"},
    formats=ANY_FORMAT,
    infos=True,
)
def com_not_mirrored(
    robot: Robot,
    *,
    least: float = 0.002,
    similar: float = 0.1,
    clear: float = 0.05,
    slight: float = 1e-4,
) -> Iterator[Problem]:
    """A link's center of mass has the wrong sign, compared with the link of the other side.

    The ``<inertial>`` of one side was copied to the other, or a sign was lost: a coordinate is
    equal on both sides but must be opposite, or is opposite but must be equal. Left and right are
    recognized by the names of the links, in robots of which most such pairs mirror each other.
    If a center of mass was copied, so were the products of inertia, which need opposite signs too.

    It is reported only if the robot shows which sign is right: the geometry of the two links lies
    on mirrored sides of their frames, or the joints of their children do, or the same links at the
    other end of the robot mirror each other. Identical parts, of which one is rotated, are not
    reported. Both ``xyz`` of the message are in the link frame, as the file has them. The fix
    writes the signs of the products of inertia too.

    It is off by default, and an info, if it moves the center of mass of the robot by less than
    ``slight`` [m]. ``least`` [m] is the smallest coordinate that is compared, ``similar`` the
    relative difference of two equal ones, and ``clear`` the part of the size of a link by which its
    geometry must lie
    to one side.
    """
    found = get_sides(robot)
    if found.normal is None:
        return
    off = {id(pair.left) for pair, _ in found.off}
    pairs = [(pair, *coms) for pair in found.pairs if (coms := _compute_com_vectors(found, pair))]
    for pair, left, right in pairs:
        if id(pair.left) in off:
            continue
        signs = [-1 if axis == found.normal else 1 for axis in range(3)]
        wrong = [
            axis
            for axis, sign in enumerate(signs)
            if min(abs(left[axis]), abs(right[axis])) >= least
            and _is_near(right[axis], -sign * left[axis], similar)
        ]
        mirrored = [
            axis
            for axis, sign in enumerate(signs)
            if axis not in wrong
            and (
                abs(right[axis] - sign * left[axis]) <= least
                or _is_near(right[axis], sign * left[axis], similar)
            )
        ]
        if len(wrong) != 1 or len(mirrored) != 2:
            continue
        axis, sign = wrong[0], signs[wrong[0]]
        others = [(one, a, b) for one, a, b in pairs if one is not pair]
        shown = _find_side_by_shapes(robot, found, pair, axis, sign, similar, clear)
        shown = shown or _find_side_by_joints(robot, found, pair, axis, sign, similar, 5 * least)
        shown = shown or _find_side_by_similar_links(pair, left[axis], axis, sign, others, similar)
        if shown is None:
            continue
        side, why = shown
        odd_left = (left[axis] > 0) != (side > 0)
        link, twin = (pair.left, pair.right) if odd_left else (pair.right, pair.left)
        right_one = right if odd_left else left
        image = mirror_image(found, link, right_one)
        assert link.inertial is not None
        assert twin.inertial is not None
        origin, other = link.inertial.origin, twin.inertial.origin
        assert origin is not None
        assert other is not None
        products = _find_copied_products(found, link, twin)
        remedy = f'write xyz="{image}"' if link.xml is not None else "check its sign"
        if products and link.xml is not None:
            remedy += f" and the opposite sign of {', '.join(products)}"
        xyz, of_twin = (
            " ".join(f"{value:.6g}" for value in one) for one in (origin.xyz, other.xyz)
        )
        moved = 2 * abs(left[axis]) * link.mass / sum(one.mass for one in robot.links)
        yield Problem(
            link,
            f"center of mass xyz=\"{xyz}\" of link '{link.name}' is not the mirror image of "
            f"xyz=\"{of_twin}\" of '{twin.name}', but {why}; {remedy}",
            at=origin,
            severity=INFO if moved < slight else None,
            data={
                "twin": twin.name,
                "axis": "xyz"[axis],
                "write": image,
                "products": products,
            },
        )


def mirror_image(found: Sides, link: Link, com: Vector) -> str:
    """Mirror a center of mass of one side, as ``xyz`` [m] in the frame of the link of the other."""
    x, y, z = (-value if axis == found.normal else value for axis, value in enumerate(com))
    back = transpose(found.poses[link.name].rotation)
    return " ".join(f"{round(value, 9) + 0.0:.6g}" for value in rotate(back, (x, y, z)))


def _find_copied_products(found: Sides, link: Link, twin: Link) -> list[str]:
    """Name the products of inertia of a link that have the sign of those of its mirror image.

    They are compared with the tensor of the other side, mirrored in the root frame and rotated into
    the frame of the link. Empty if the tensors do not agree but for these signs.
    """
    own, other = _get_tensor(link), _get_tensor(twin)
    if own is None or other is None:
        return []
    image = list(rotate_tensor(other, found.poses[twin.name].rotation))
    for index, (i, j) in enumerate(((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))):
        if (i == found.normal) != (j == found.normal):
            image[index] = -image[index]
    xx, xy, xz, yy, yz, zz = image
    right = rotate_tensor((xx, xy, xz, yy, yz, zz), transpose(found.poses[link.name].rotation))
    small = 1e-3 * max(map(abs, own))
    both = list(zip(COMPONENTS, own, right, strict=True))
    if any(abs(abs(a) - abs(b)) > max(small, 0.1 * abs(b)) for _, a, b in both):
        return []
    return [name for name, a, b in both if a * b < 0 and abs(a) > small]


def _get_tensor(link: Link) -> SymmetricTensor | None:
    """Get the tensor of a link along the axes of its frame; None if it is missing or rotated."""
    inertial = link.inertial
    if inertial is None or inertial.inertia is None:
        return None
    if inertial.origin is not None and any(inertial.origin.rpy):
        return None
    return inertial.inertia.six


@com_not_mirrored.fix(UNSAFE)
def write_mirror_image(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the mirror image of the center of mass of the other side."""
    inertial = context.get_link(problem).inertial
    if inertial is None or inertial.origin is None:
        return None
    image, products = problem.data["write"], problem.data["products"]
    changes = [set_attribute(inertial.origin.element, "xyz", image)]
    what = f'write xyz="{image}"'
    if inertial.inertia is None:
        return unsafe(what, *changes)
    element = inertial.inertia.element
    for name in products:
        written = (element.get(name) or "").strip()
        value = written[1:] if written.startswith("-") else f"-{written.removeprefix('+')}"
        changes.append(set_attribute(element, name, value))
        what += f' {name}="{value}"'
    return unsafe(what, *changes)


def _compute_com_vectors(found: Sides, pair: Pair) -> tuple[Vector, Vector] | None:
    """Compute the vectors from the links' frames to their centers of mass, in root axes [m]."""
    vectors = []
    for link in (pair.left, pair.right):
        origin = link.inertial.origin if link.inertial is not None else None
        if origin is None or link.mass <= 0 or link.name not in found.poses:
            return None
        vectors.append(rotate(found.poses[link.name].rotation, origin.xyz))
    return vectors[0], vectors[1]


def _is_near(one: float, other: float, part: float) -> bool:
    return abs(one - other) <= part * abs(other)


def _find_side_by_shapes(
    robot: Robot, found: Sides, pair: Pair, axis: int, sign: int, similar: float, clear: float
) -> tuple[float, str] | None:
    """Find the side of the left frame that has the geometry, if the pair mirrors each other.

    Returns:
        The coordinate along the axis [m], and what shows it.
    """
    sides_of: list[float] = []
    for link in (pair.left, pair.right):
        box = get_extents(robot).get_link_box(link)
        if box is None:
            return None
        side = rotate(found.poses[link.name].rotation, box.center)[axis]
        if abs(side) < clear * max(box.size):
            return None
        sides_of.append(side)
    left, right = sides_of
    if not _is_near(right, sign * left, similar):
        return None
    return left, "the geometry of the two links is mirrored"


def _find_side_by_joints(
    robot: Robot, found: Sides, pair: Pair, axis: int, sign: int, similar: float, least: float
) -> tuple[float, str] | None:
    """Find the side of the left frame that has the child joint, if the pair mirrors each other."""
    means = []
    for link in (pair.left, pair.right):
        offsets = [
            rotate(found.poses[link.name].rotation, joint.origin.xyz)[axis]
            for joint in robot.tree.get_child_joints(link.name)
            if joint.origin is not None and not joint.is_fixed
        ]
        if len(offsets) != 1:
            return None
        means.append(offsets[0])
    left, right = means
    if abs(left) < least or not _is_near(right, sign * left, similar):
        return None
    return left, "the joints of their children are mirrored"


def _find_side_by_similar_links(
    pair: Pair,
    left: float,
    axis: int,
    sign: int,
    others: list[tuple[Pair, Vector, Vector]],
    similar: float,
) -> tuple[float, str] | None:
    """Find the side of the center of mass of the left link at the other end of the robot."""
    family = get_family(pair.left.name)
    for other, one, two in others:
        if get_family(other.left.name) != family or get_family(other.right.name) != family:
            continue
        if _is_near(two[axis], sign * one[axis], similar) and _is_near(
            abs(one[axis]), abs(left), similar
        ):
            return one[axis], f"those of '{other.left.name}' and '{other.right.name}' are mirrored"
    return None
