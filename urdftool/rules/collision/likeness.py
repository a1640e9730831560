"""Collisions beside visuals."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.bounds import Bounds, size_of
from ...model.elements import Collision, Cylinder, Link, Robot, Sphere, Visual
from ...model.gltf_axes import is_gltf
from ...source.description import Description
from ..fix import FixContext, Proposal, depends_on_arguments, unsafe
from ..mesh.outlines import Reaches, reaches
from ..mesh.uses import MeshUse, is_concave, mesh_uses
from ..rule import ERROR, INFO, UNSAFE, WARNING, Problem, rule
from ..shape_changes import copy_origin, set_in_origin
from .apart import compare_places, measured, with_attached
from .displaced import displaced

APPLIES_TO = ("collision",)

_SIMPLER = "'urdftool collision' makes simpler shapes, and measures how far off they are"

_FOR_CONTACT = re.compile(r"collision|convex|hull|simpl|low[-_]?poly", re.IGNORECASE)
"""Names of meshes that were made for contacts, and are shown for want of another."""

_AXES = (
    "; or a glTF was written with Z up, and RViz turns it: export it with Y up, or say --gltf-up z"
)


def faces_of(use: MeshUse) -> int:
    """Triangles of a binary STL file; 0 where that cannot be told cheaply."""
    if use.path is None or use.path.suffix.lower() != ".stl":
        return 0
    try:
        from ..mesh.formats import stl_facts_of

        facts = stl_facts_of(use.workspace, use.path)
    except OSError:
        return 0
    return (facts.triangles or 0) if facts.size_agrees else 0


def _is_small(use: MeshUse, least: float) -> bool:
    """Whether an OBJ, or an STL of text, is known to have few triangles."""
    word = {".obj": b"f", ".stl": b"facet"}.get(use.path.suffix.lower()) if use.path else None
    if use.path is None or word is None or use.size is None or use.size > 400 * least:
        return False
    try:
        lines = [line.split() for line in use.workspace.read_bytes(use.path).splitlines()]
    except OSError:
        return False
    corners = [len(line) - 1 if word == b"f" else 3 for line in lines if line[:1] == [word]]
    return 0 < sum(count - 2 for count in corners) < least


@rule(
    INFO,
    effects={
        "moveit": "builds the collision shape from all triangles of the mesh",
        "mujoco": "takes the convex hull",
        "pybullet": "takes the convex hull; of an OBJ of several objects, a hull of each",
        "pybullet (concave)": "collides with its triangles, because the collision is concave",
    },
)
def visual_mesh_as_collision(
    robot: Robot, description: Description, *, dense: float = 5000, least: float = 200
) -> Iterator[Problem]:
    """A link collides with the mesh it is seen as.

    What is drawn has every screw; what touches needs the outline. Planning scenes have become sixty
    times faster with simpler shapes. Where the mesh is known to have more than ``dense`` triangles
    it is a warning; one of an STL or OBJ of fewer than ``least`` is as simple as a shape made for
    contact, and is not reported. One finding for the robot names the links with such meshes, and
    one counts the other links; a ``<collision>`` with the attribute ``concave``, of which PyBullet
    keeps the triangles, is reported apart.
    """
    seen: dict[str, set[str]] = {}
    plain, heavy = [], []
    for use in mesh_uses(robot, description):
        if not use.collides:
            seen.setdefault(use.link.name, set()).add(use.uri)
            continue
        if use.uri not in seen.get(use.link.name, ()) or _FOR_CONTACT.search(use.uri):
            continue
        faces = faces_of(use) if use.exists else 0
        if faces > dense:
            heavy.append((use, faces))
        elif faces > dense / 10 or (faces == 0 and not _is_small(use, least)):
            plain.append(use)
    named = {use.link.name for use, _ in heavy}
    plain = [use for use in plain if use.link.name not in named]
    for concave in (False, True):
        yield from _as_collision(
            [one for one in heavy if is_concave(one[0]) is concave],
            [one for one in plain if is_concave(one) is concave],
            ("moveit", "mujoco", "pybullet (concave)" if concave else "pybullet"),
        )


def _as_collision(
    heavy: list[tuple[MeshUse, int]], plain: list[MeshUse], effects: tuple[str, ...]
) -> Iterator[Problem]:
    """Report visual meshes that are collision meshes: those of many triangles, and the others."""
    if heavy:
        names = list(dict.fromkeys(use.link.name for use, _ in heavy))
        most = max(faces for _, faces in heavy)
        others = ", ".join(f"'{name}'" for name in names[1:])
        yield Problem(
            heavy[0][0].link,
            f"link '{names[0]}' collides with its visual mesh of {heavy[0][1]} triangles"
            + (f"; so do {others} with theirs, of up to {most}" if others else "")
            + "; use primitives or simpler meshes",
            at=heavy[0][0].mesh.element.attribute_place("filename"),
            hint=_SIMPLER,
            severity=WARNING,
            effects=effects,
        )
    if plain:
        more = f" (and {len(plain) - 1} more links theirs)" if len(plain) > 1 else ""
        yield Problem(
            plain[0].link,
            f"link '{plain[0].link.name}' collides with its visual mesh{more}; "
            "primitives or simpler meshes are faster",
            at=plain[0].mesh.element.attribute_place("filename"),
            effects=effects,
        )


@rule(
    WARNING,
    effects={
        "mujoco": "rejects an STL file of more than 200 000 triangles",
    },
)
def collision_mesh_too_dense(
    robot: Robot, description: Description, *, most: float = 20000, mujoco: float = 200000
) -> Iterator[Problem]:
    """A collision mesh has very many triangles.

    Nineteen of twenty collision meshes have fewer than ``most``. Each triangle is a candidate for a
    contact in every step; a tenth of them gives the same contacts. MuJoCo refuses more than
    ``mujoco``.
    """
    told: set[str] = set()
    for use in mesh_uses(robot, description):
        if not use.collides or not use.exists or use.uri in told:
            continue
        told.add(use.uri)
        faces = faces_of(use)
        shared = any(
            other.uri == use.uri and not other.collides and other.link is use.link
            for other in mesh_uses(robot, description)
        )
        is_too_many = faces > mujoco and use.uri.lower().endswith(".stl")
        if is_too_many or (faces > most and (not shared or faces > mujoco)):
            yield Problem(
                use.link,
                f"collision mesh '{use.uri}' has {faces} triangles; simplify it to some thousand",
                at=use.mesh.element.attribute_place("filename"),
                data={"uri": use.uri, "triangles": faces, "limit": mujoco if is_too_many else most},
                hint=_SIMPLER,
                severity=ERROR if is_too_many else None,
                effects=None if is_too_many else (),
            )


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco, pybullet": "collide with the shape as written",
    },
)
def collision_much_larger_than_visual(
    robot: Robot, *, ratio: float = 2.0, least: float = 0.1
) -> Iterator[Problem]:
    """A link collides far outside of its visual.

    Often a unit is wrong, or the diameter was written for the radius. The robot touches things that
    look far away. It is reported where the box around the collisions is more than ``ratio`` times
    as long as that around the visuals, and by more than ``least`` [m]; visuals of links that are
    fixed to this one count as well. The disc that the blades of a rotor sweep is not reported, nor
    a sphere of the same radius as a wheel, which touches the ground in one point on purpose.
    """
    reach = reaches(robot)
    for link in robot.links:
        seen, touches = measured(reach, link)
        if seen is None or touches is None or _larger(touches, seen, ratio, least) is None:
            continue
        if displaced(robot, link):
            continue
        around = with_attached(reach, link, "visuals", seen, touches)
        if around is None or (axis := _larger(touches, around, ratio, least)) is None:
            continue
        a, b = touches.size[axis], around.size[axis]
        if _is_swept(robot, link, touches, around) or _is_ball_of_wheel(link, around):
            continue
        yield Problem(
            link,
            f"link '{link.name}' collides over {a:.3g} m along {'xyz'[axis]} and its visual spans "
            f"{b:.3g} m"
            + ("; is a diameter written for a radius?" if _is_doubled(link, touches, seen) else ""),
            at=link.collisions[0].geometry or link.collisions[0],
            data={"collision": a, "visual": b, "axis": "xyz"[axis]},
        )


def _larger(touches: Bounds, seen: Bounds, ratio: float, least: float) -> int | None:
    """Return the first axis along which one box is far longer than another; None without one."""
    for axis, (a, b) in enumerate(zip(touches.size, seen.size, strict=True)):
        if a > ratio * b and a - b > least:
            return axis
    return None


def _is_swept(robot: Robot, link: Link, touches: Bounds, around: Bounds) -> bool:
    """Whether a flat disc on a turning joint is as wide as the visual is long."""
    joint = robot.tree.parent_joint(link.name)
    shapes = [collision.geometry for collision in link.collisions]
    if joint is None or joint.type not in ("continuous", "revolute") or len(shapes) != 1:
        return False
    disc = shapes[0]
    if not isinstance(disc, Cylinder) or disc.length > disc.radius:
        return False
    return max(touches.size) <= 1.1 * max(around.size)


def _is_ball_of_wheel(link: Link, around: Bounds) -> bool:
    """Whether the one collision is a sphere as wide as the visual along two axes."""
    shapes = [collision.geometry for collision in link.collisions]
    if len(shapes) != 1 or not isinstance(shapes[0], Sphere):
        return False
    width = 2 * shapes[0].radius
    return sum(abs(size - width) <= 0.1 * width for size in around.size) >= 2


def _is_doubled(link: Link, touches: Bounds, seen: Bounds) -> bool:
    """Whether a round collision is twice as wide as the visual, as with a diameter for a radius."""
    shapes = [collision.geometry for collision in link.collisions]
    if len(shapes) != 1 or not isinstance(shapes[0], Cylinder | Sphere):
        return False
    ratios = [a / b for a, b in zip(touches.size, seen.size, strict=True) if b > 0]
    return sum(1.9 <= ratio <= 2.1 for ratio in ratios) >= 2


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pybullet": (
            "collide with the shape as written: things pass through what is shown"
        ),
    },
    group="robot",
)
def collision_much_smaller_than_visual(
    robot: Robot, *, ratio: float = 4.0, speck: float = 0.002
) -> Iterator[Problem]:
    """A link's collision is far smaller than its visual.

    Usually a unit is wrong, or a scale. It is reported where the box around the visuals is more
    than ``ratio`` times as long as that around the collisions along each of its sides; collisions
    at that place of links that are fixed to this one count as well, and what reaches into the box
    from others of the same rigid body. A box, cylinder or sphere of at most ``speck`` [m] is one on
    purpose, to touch nothing, and is not reported.
    """
    reach = reaches(robot)
    for link in robot.links:
        seen, touches = measured(reach, link)
        if seen is None or touches is None or not _smaller(touches, seen, ratio):
            continue
        around = with_attached(reach, link, "collisions", touches, seen)
        if around is None or not _smaller(_with_held(reach, link, around, seen), seen, ratio):
            continue
        sizes = [size_of(collision.geometry) for collision in link.collisions]
        if all(size is not None and max(size) <= speck for size in sizes):
            continue
        a, b = max(seen.size), max(touches.size)
        yield Problem(
            link,
            f"the visual of link '{link.name}' spans {a:.3g} m and its collision {b:.3g} m; is its "
            "scale right?",
            at=link.collisions[0].geometry or link.collisions[0],
            data={"collision": b, "visual": a},
        )


def _with_held(reach: Reaches, link: Link, own: Bounds, seen: Bounds) -> Bounds:
    """Join a box with the parts of attached collisions that lie in the box around the visuals."""
    for member, at in reach.attached(link)[1:]:
        box = reach.body(link, "collisions", [(member, at)]) if member.collisions else None
        if box is not None and box.meets(seen):
            low = tuple(map(max, box.low, seen.low))
            high = tuple(map(min, box.high, seen.high))
            own = own.joined(Bounds(low, high))  # type: ignore[arg-type]
    return own


def _smaller(touches: Bounds, seen: Bounds, ratio: float) -> bool:
    """Whether one box is far shorter than another along each of its sides."""
    sizes = zip(sorted(seen.size), sorted(touches.size), strict=True)
    return all(a > ratio * b for a, b in sizes)


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco": "collide with the shape where it is written",
    },
)
def collision_off_visual(
    robot: Robot, description: Description, *, apart: float = 0.5
) -> Iterator[Problem]:
    """The collision of a link is at another place than its visual.

    One of the two has the wrong ``<origin>``. It is reported where the boxes around visuals and
    collisions do not meet, or their middles are further apart than ``apart`` of the visual's
    diagonal; a fifth of it where both are a primitive of the same size. Two of three decide which
    one is wrong: visual, collision and center of mass. Where these do not, it is the one whose
    origin repeats that of the joint. Shapes of different sizes are a remark, as a simple shape may
    be at another place on purpose; one that the visual of a joined or attached link covers is not
    reported.
    """
    for link in robot.links:
        found = compare_places(robot, link, apart)
        if found is None or displaced(robot, link):
            continue
        gltf = any(map(is_gltf, link.visuals)) or any(map(is_gltf, link.collisions))
        lying = gltf and description.gltf_up == "y"
        if found.odd:
            what = f"the {found.odd} of link '{link.name}' is {found.distance:.3g} m off its "
            what += f"{found.other}, and {found.why}; {found.remedy}"
        else:
            what = f"visual and collision of link '{link.name}' are {found.distance:.3g} m apart; "
            what += "give both the same <origin>" if found.alike else "check the <origin> of both"
        shape = link.visuals[0] if found.odd == "visual" else link.collisions[0]
        yield Problem(
            link,
            what + (_AXES if lying else ""),
            at=shape.origin or shape,
            severity=None if found.alike else INFO,
            data={
                "distance": found.distance,
                "odd": found.odd,
                "same": found.same,
                "write": found.xyz_text,
            },
        )


@collision_off_visual.fix(UNSAFE)
def move_odd_shape(problem: Problem, context: FixContext) -> Proposal | None:
    """Move the one at the wrong place to where the other is, if it is known which one that is."""
    link, odd, xyz = context.link(problem), problem.data["odd"], problem.data["write"]
    if not odd or not (xyz or problem.data["same"]):
        return None
    if len(link.visuals) != 1 or len(link.collisions) != 1:
        return None
    if depends_on_arguments(link.element, "visual", "collision", "inertial"):
        return None
    wrong: Visual | Collision = link.visuals[0]
    right: Visual | Collision = link.collisions[0]
    if odd == "collision":
        wrong, right = right, wrong
    if xyz:
        return unsafe(f'write xyz="{xyz}" for its {odd}', set_in_origin(wrong, "xyz", xyz))
    what = f"give the {odd} the <origin> of the {right.element.tag}"
    return unsafe(what, copy_origin(wrong, right))
