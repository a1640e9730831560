"""Compare collision geometry with visual geometry."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

from ...diagnostic import Severity
from ...model.bounds import Bounds, compute_size
from ...model.elements import Collision, Link, Robot, Visual
from ...model.gltf_axes import is_gltf
from ...source.description import Description
from ..fix import FixContext, Proposal, depends_on_arguments, unsafe
from ..mesh.link_extents import LinkExtents, get_extents
from ..mesh.mesh_uses import MeshUse, get_mesh_uses, is_concave
from ..rule import (
    ANY_FORMAT,
    ERROR,
    GAZEBO,
    INFO,
    UNSAFE,
    URDF_AND_SDF,
    WARNING,
    Problem,
    rule,
)
from ..shape_changes import copy_origin, set_in_origin
from ..words import join_some
from .displaced import find_displaced
from .larger_shapes import (
    CLEARLY,
    SPANNED,
    find_longer_axis,
    is_ball_around,
    is_ball_of_wheel,
    is_composed,
    is_doubled,
    is_inside,
    is_swept,
    join_neighbor_visuals,
)
from .misalignment import Misalignment, compare_places, join_attached_boxes, measure_boxes
from .z_up_visuals import find_z_up_visuals

APPLIES_TO = ("collision",)

_SIMPLER = "'urdftool collision' creates simpler geometry, and measures its error"

_FOR_CONTACT = re.compile(r"collision|convex|hull|simpl|low[-_]?poly", re.IGNORECASE)
"""Names of meshes that were made for contact, and are shown because no other mesh exists."""

_Z_UP = "RViz rotates it: export it with Y up, or use --gltf-up z"
_AXES = f"; if a glTF file has Z up, {_Z_UP}"


def count_faces(use: MeshUse) -> int:
    """Count the triangles of a binary STL file; 0 if that is slow or impossible."""
    if use.path is None or use.path.suffix.lower() != ".stl":
        return 0
    try:
        from ..mesh.formats import read_stl_facts

        facts = read_stl_facts(use.workspace, use.path)
    except OSError:
        return 0
    return (facts.triangles or 0) if facts.size_agrees else 0


def _count_triangles(use: MeshUse) -> int:
    """Count the triangles of an STL or OBJ file, at least; 0 for other formats."""
    word = {".obj": b"\nf ", ".stl": b"facet normal"}.get(
        use.path.suffix.lower() if use.path else ""
    )
    if use.path is None or word is None:
        return 0
    binary = count_faces(use)
    if binary or (use.size or 0) < _SHORTEST * _DENSE:
        return binary
    try:
        return use.workspace.read_bytes(use.path).count(word)
    except OSError:
        return 0


_DENSE = 5000
"""Triangles above which a mesh costs time in contacts. Chosen, no source."""

_OF_TRIANGLES = frozenset(("moveit", *GAZEBO))
"""Targets that collide the triangles of a mesh."""

_SHORTEST = 8
"""Bytes of ``f 1 2 3`` and a newline, by definition the shortest face of an OBJ file."""


@rule(
    WARNING,
    effects={
        "moveit": "builds the collision geometry from all triangles of the mesh",
        "mujoco": "uses the convex hull",
        "pybullet": "uses the convex hull; for an OBJ with several objects, the hull of each",
        "pybullet (concave)": "uses its triangles for contact, because the collision is concave",
    },
    pedantic="objects and scenes, which have no moving joint",
)
def visual_mesh_as_collision(
    robot: Robot, description: Description, targets: frozenset[str], *, dense: float = _DENSE
) -> Iterator[Problem]:
    """A link uses its visual mesh as collision geometry.

    Visual meshes have details, such as screws, that contacts do not need and that make planning
    and simulation slow: simpler shapes have made planning scenes up to 60 times faster. Use
    primitives or simplified meshes.

    Reported are STL and OBJ files of more than ``dense`` triangles, because lighter ones cost
    little. Files of another format are not counted. One finding names all links; a ``<collision>``
    with the attribute ``concave``, of which PyBullet keeps the triangles, is a finding of its own.
    A mesh or description that is named for collisions is skipped. It is an info, which is off by
    default, unless a reader among the targets collides the triangles: MoveIt, Gazebo, and PyBullet
    if the collision is concave; MuJoCo and PyBullet else take the convex hull.
    """
    if _FOR_CONTACT.search(os.path.basename(description.path)):
        return
    seen: dict[str, set[str]] = {}
    heavy = []
    for use in get_mesh_uses(robot, description):
        if not use.collides:
            seen.setdefault(use.link.name, set()).add(use.uri)
            continue
        if use.uri not in seen.get(use.link.name, ()) or _FOR_CONTACT.search(use.uri):
            continue
        faces = _count_triangles(use) if use.exists else 0
        if faces > dense:
            heavy.append((use, faces))
    for concave in (False, True):
        yield from _report_visual_meshes(
            robot,
            [one for one in heavy if is_concave(one[0]) is concave],
            ("moveit", "mujoco", "pybullet (concave)" if concave else "pybullet"),
            None if concave or not targets.isdisjoint(_OF_TRIANGLES) else INFO,
        )


def _report_visual_meshes(
    robot: Robot,
    heavy: list[tuple[MeshUse, int]],
    effects: tuple[str, ...],
    severity: Severity | None,
) -> Iterator[Problem]:
    """Report dense visual meshes used as collision geometry."""
    if heavy:
        names = list(dict.fromkeys(use.link.name for use, _ in heavy))
        most = max(faces for _, faces in heavy)
        others = ", ".join(f"'{name}'" for name in names[1:])
        yield Problem(
            heavy[0][0].link,
            f"link '{names[0]}' uses its visual mesh of {heavy[0][1]} triangles as collision "
            "geometry"
            + (f"; so do {others}, with up to {most}" if others else "")
            + ". Use primitives or simpler meshes",
            at=heavy[0][0].mesh.locate_attribute("filename"),
            hint=_SIMPLER,
            effects=effects,
            severity=severity,
            pedantic=not robot.moving_joints,
        )


@rule(
    WARNING,
    effects={
        "mujoco": "rejects an STL file of more than 200 000 triangles",
    },
    formats=URDF_AND_SDF,
)
def collision_mesh_too_dense(
    robot: Robot, description: Description, *, most: float = 20000, mujoco: float = 200000
) -> Iterator[Problem]:
    """A collision mesh has very many triangles.

    Each triangle is checked for contact in every step, and a tenth of them gives the same contacts.
    95 % of collision meshes have fewer than ``most``. MuJoCo rejects more than ``mujoco``.
    Simplify the mesh.
    """
    checked: set[str] = set()
    for use in get_mesh_uses(robot, description):
        if not use.collides or not use.exists or use.uri in checked:
            continue
        checked.add(use.uri)
        faces = count_faces(use)
        shared = any(
            other.uri == use.uri and not other.collides and other.link is use.link
            for other in get_mesh_uses(robot, description)
        )
        is_too_many = faces > mujoco and use.uri.lower().endswith(".stl")
        if is_too_many or (faces > most and (not shared or faces > mujoco)):
            yield Problem(
                use.link,
                f"collision mesh '{use.uri}' has {faces} triangles; simplify it to a few thousand",
                at=use.mesh.locate_attribute("filename"),
                data={"uri": use.uri, "triangles": faces, "limit": mujoco if is_too_many else most},
                hint=_SIMPLER,
                severity=ERROR if is_too_many else None,
                effects=None if is_too_many else (),
            )


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco, pybullet": "use the collision geometry as written",
    },
    caused_by=("mesh-scale-differs",),
    formats=ANY_FORMAT,
    pedantic="less than 3.5 times as long, unless a radius is a diameter",
)
def collision_much_larger_than_visual(
    robot: Robot, description: Description, *, ratio: float = 2.0, least: float = 0.1
) -> Iterator[Problem]:
    """The collision geometry of a link is far larger than its visual geometry.

    Often a unit is wrong, or a diameter was written as the radius. The robot then makes contact at
    a distance. It is reported if the bounding box of the collisions is more than ``ratio`` times as
    long as that of the visuals, and by more than ``least`` [m]; visuals of links that are fixed to
    this one count too. Ignored are the disc that the blades of a rotor sweep, a sphere with the
    radius of a wheel, which makes contact with the ground in one point on purpose, and three or
    more primitives, composed on purpose, such as a capsule for coarse checks. So are a sphere
    around a flat body, such as a drone, and geometry that spans the visuals of the links that
    joints connect to it, as a capsule for a whole thigh or the housing of a joint.
    """
    reach = get_extents(robot)
    for link in robot.links:
        visual_box, collision_box = measure_boxes(reach, link)
        if (
            visual_box is None
            or collision_box is None
            or find_longer_axis(collision_box, visual_box, ratio, least) is None
        ):
            continue
        if find_displaced(robot, link) or link in find_z_up_visuals(robot, description):
            continue
        around = join_attached_boxes(reach, link, "visuals", visual_box, collision_box)
        if (
            around is None
            or (axis := find_longer_axis(collision_box, around, ratio, least)) is None
        ):
            continue
        a, b = collision_box.size[axis], around.size[axis]
        if is_swept(robot, link, collision_box, around) or is_ball_of_wheel(link, around):
            continue
        if is_composed(link) or is_ball_around(robot, link, around):
            continue
        moved = join_neighbor_visuals(robot, reach, link, around)
        if a <= SPANNED * b and is_inside(collision_box, moved, axis):
            continue
        doubled = is_doubled(link, collision_box, visual_box)
        yield Problem(
            link,
            f"collision of link '{link.name}' spans {a:.3g} m along {'xyz'[axis]}, but its visual "
            f"only {b:.3g} m{'; is the radius a diameter?' if doubled else ''}",
            at=link.collisions[0].geometry or link.collisions[0],
            data={"collision": a, "visual": b, "axis": "xyz"[axis]},
            pedantic=not doubled and find_longer_axis(collision_box, around, CLEARLY, 0.0) is None,
        )


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pybullet": (
            "use the collision geometry as written: objects penetrate the visual geometry"
        ),
    },
    group="robot",
    formats=ANY_FORMAT,
    infos=True,
)
def collision_much_smaller_than_visual(
    robot: Robot, *, ratio: float = 4.0, speck: float = 0.002
) -> Iterator[Problem]:
    """The collision geometry of a link is far smaller than its visual geometry.

    Usually a unit or a scale is wrong. It is reported if the bounding box of the visuals is more
    than ``ratio`` times as long as that of the collisions along each side. Collisions of links that
    are fixed to this one count too, and the parts of other links of the rigid body inside of the
    visuals' box. A box, cylinder or sphere of at most ``speck`` [m] is intended to avoid contact,
    and not reported.
    """
    reach = get_extents(robot)
    for link in robot.links:
        visual_box, collision_box = measure_boxes(reach, link)
        if (
            visual_box is None
            or collision_box is None
            or not _is_smaller(collision_box, visual_box, ratio)
        ):
            continue
        around = join_attached_boxes(reach, link, "collisions", collision_box, visual_box)
        if around is None or not _is_smaller(
            _add_attached_collisions(reach, link, around, visual_box), visual_box, ratio
        ):
            continue
        sizes = [compute_size(collision.geometry) for collision in link.collisions]
        if all(size is not None and max(size) <= speck for size in sizes):
            continue
        a, b = max(visual_box.size), max(collision_box.size)
        yield Problem(
            link,
            f"visual of link '{link.name}' spans {a:.3g} m, but its collision only {b:.3g} m; "
            "check the scale of the collision",
            at=link.collisions[0].geometry or link.collisions[0],
            data={"collision": b, "visual": a},
        )


def _add_attached_collisions(
    reach: LinkExtents, link: Link, own: Bounds, visual_box: Bounds
) -> Bounds:
    """Join a box with the parts of attached collisions inside the bounding box of the visuals."""
    for member, at in reach.get_attached(link)[1:]:
        box = reach.get_body_box(link, "collisions", [(member, at)]) if member.collisions else None
        if box is not None and box.meets(visual_box):
            low = tuple(map(max, box.low, visual_box.low))
            high = tuple(map(min, box.high, visual_box.high))
            own = own.join(Bounds(low, high))  # type: ignore[arg-type]
    return own


def _is_smaller(collision_box: Bounds, visual_box: Bounds, ratio: float) -> bool:
    """Tell whether one box is far shorter than another along each of its sides."""
    sizes = zip(sorted(visual_box.size), sorted(collision_box.size), strict=True)
    return all(a > ratio * b for a, b in sizes)


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco": "use the collision geometry where it is written",
    },
    formats=ANY_FORMAT,
)
def collision_off_visual(
    robot: Robot, description: Description, *, apart: float = 0.5
) -> Iterator[Problem]:
    """The collision of a link is offset from its visual.

    One of the two has the wrong ``<origin>``. It is reported if the bounding boxes of visuals and
    collisions do not overlap, or if their centers are further apart than ``apart`` of the visual's
    diagonal; a fifth of that if both are a primitive of the same size. If two of visual, collision
    and center of mass agree, the third is wrong; otherwise the one whose origin repeats that of the
    joint. Geometry of different sizes is an info, because simple shapes may be offset on purpose,
    unless the collision is apart from the visual and the center of mass, which agree.
    Collisions that the visual of a joined or attached link covers are not reported. Visuals in glTF
    files that agree with the collision only if the file has Z up are one finding.
    """
    z_up = find_z_up_visuals(robot, description)
    if z_up:
        yield _report_z_up(z_up)
    for link in robot.links:
        found = compare_places(robot, link, apart) if link not in z_up else None
        if found is None or find_displaced(robot, link):
            continue
        gltf = any(map(is_gltf, link.visuals)) or any(map(is_gltf, link.collisions))
        is_rotated = gltf and description.gltf_up == "y"
        if found.odd:
            what = f"{found.odd} of link '{link.name}' is offset from its {found.other} by "
            what += f"{found.distance:.3g} m, and {found.why}; "
            what += found.remedy if link.xml is not None else "check the poses of both"
        else:
            what = f"visual and collision of link '{link.name}' are {found.distance:.3g} m apart; "
            pose = "<origin>" if link.xml is not None else "pose"
            what += f"give both the same {pose}" if found.alike else f"check the {pose} of both"
        shape = link.visuals[0] if found.odd == "visual" else link.collisions[0]
        yield Problem(
            link,
            what + (_AXES if is_rotated else ""),
            at=shape.origin or shape,
            severity=None if found.alike or _is_alone(robot, link, found) else INFO,
            data={
                "distance": found.distance,
                "odd": found.odd,
                "same": found.same,
                "write": found.xyz_text,
                "is_rotated": is_rotated,
            },
        )


def _report_z_up(links: list[Link]) -> Problem:
    """Report links whose glTF visuals agree with their collisions only if the files have Z up."""
    first = links[0]
    names = join_some([f"'{link.name}'" for link in links[1:]], "links")
    also = f", and so do those of {names}" if names else ""
    return Problem(
        first,
        f"visual of link '{first.name}' agrees with its collision only if its glTF file has Z up"
        f"{also}, but glTF has Y up; {_Z_UP}",
        at=first.visuals[0],
        data={"odd": "", "write": "", "same": False, "is_rotated": True},
        alike="Z up",
    )


def _is_alone(robot: Robot, link: Link, found: Misalignment) -> bool:
    """Tell whether a collision is apart from both the visual and the center of mass of its link."""
    visual_box, collision_box = measure_boxes(get_extents(robot), link)
    if found.odd != "collision" or visual_box is None or collision_box is None:
        return False
    return not visual_box.meets(collision_box)


@collision_off_visual.fix(UNSAFE)
def move_odd_shape(problem: Problem, context: FixContext) -> Proposal | None:
    """Move the misplaced geometry to the other, if it is known which one is misplaced."""
    link, odd, xyz = context.get_link(problem), problem.data["odd"], problem.data["write"]
    if not odd or not (xyz or problem.data["same"]) or problem.data["is_rotated"]:
        return None  # the up axis of the glTF file may be the cause
    if len(link.visuals) != 1 or len(link.collisions) != 1:
        return None
    if depends_on_arguments(link.element, "visual", "collision", "inertial"):
        return None
    wrong: Visual | Collision = link.visuals[0]
    right: Visual | Collision = link.collisions[0]
    if odd == "collision":
        wrong, right = right, wrong
    if xyz and wrong.origin is None and not any(map(float, xyz.split())):
        return None  # it is the default
    if xyz:
        return unsafe(f'write xyz="{xyz}" for its {odd}', set_in_origin(wrong, "xyz", xyz))
    what = f"copy the <origin> of the {right.element.tag} to the {odd}"
    return unsafe(what, copy_origin(wrong, right))
