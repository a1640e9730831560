"""Collisions beside visuals."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ...meshes.facts import stl_facts
from ...model.elements import Robot
from ...model.gltf_axes import is_gltf
from ...model.pose import norm
from ...source.description import Description
from ..mesh.outlines import reaches
from ..mesh.uses import Stamp, mesh_uses, stamp
from ..rule import ERROR, INFO, WARNING, Problem, rule
from .displaced import displaced

_SIMPLER = "'urdftool collision' makes simpler shapes, and measures how far off they are"

_faces: dict[Stamp, int] = {}

_AXES = (
    "; or a glTF was written with Z up, and RViz turns it: export it with Y up, or say --gltf-up z"
)


def faces_of(path: Path | None) -> int:
    """Triangles of a binary STL file; 0 where that cannot be told cheaply."""
    if path is None or path.suffix.lower() != ".stl":
        return 0
    try:
        key = stamp(path)
        if key not in _faces:
            facts = stl_facts(key[0])
            _faces[key] = (facts.triangles or 0) if facts.size_agrees else 0
    except OSError:
        return 0
    return _faces[key]


@rule(
    INFO,
    effects={
        "moveit": "builds the collision shape from all triangles of the mesh",
        "mujoco, pybullet": "take the convex hull",
    },
)
def visual_mesh_as_collision(
    robot: Robot, description: Description, *, dense: float = 5000
) -> Iterator[Problem]:
    """A link collides with the mesh it is seen as.

    What is drawn has every screw; what touches needs the outline. Planning scenes have become sixty
    times faster with simpler shapes. Where the mesh is known to have more than ``dense`` triangles
    it is a warning. One finding for the robot names the links with such meshes, and one counts the
    others.
    """
    seen: dict[str, set[str]] = {}
    plain, heavy = [], []
    for use in mesh_uses(robot, description):
        if not use.collides:
            seen.setdefault(use.link.name, set()).add(use.uri)
            continue
        if use.uri not in seen.get(use.link.name, ()):
            continue
        faces = faces_of(use.path) if use.exists else 0
        if faces > dense:
            heavy.append((use, faces))
        elif faces == 0 or faces > dense / 10:
            plain.append(use)
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
        )
    if plain:
        more = f" (and {len(plain) - 1} more links theirs)" if len(plain) > 1 else ""
        yield Problem(
            plain[0].link,
            f"link '{plain[0].link.name}' collides with its visual mesh{more}; "
            "primitives or simpler meshes are faster",
            at=plain[0].mesh.element.attribute_place("filename"),
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
        faces = faces_of(use.path)
        shared = any(
            other.uri == use.uri and not other.collides and other.link is use.link
            for other in mesh_uses(robot, description)
        )
        if faces > mujoco or (faces > most and not shared):
            yield Problem(
                use.link,
                f"collision mesh '{use.uri}' has {faces} triangles; simplify it to some thousand",
                at=use.mesh.element.attribute_place("filename"),
                hint=_SIMPLER,
                severity=ERROR if faces > mujoco else None,
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
    """A link collides far outside of what is seen of it.

    Usually the diameter was written for the radius, or a unit is wrong. The robot touches things
    that look far away. It is told where the box around the collisions is more than ``ratio`` times
    as long as that around the visuals, and by more than ``least`` [m].
    """
    reach = reaches(robot)
    for link in robot.links:
        seen, touches = reach.shapes(link.visuals), reach.shapes(link.collisions)
        if seen is None or touches is None:
            continue
        for axis, a, b in zip("xyz", touches.size, seen.size, strict=True):
            if a > ratio * b and a - b > least and not displaced(robot, link):
                yield Problem(
                    link,
                    f"link '{link.name}' collides over {a:.3g} m along {axis} and is seen over "
                    f"{b:.3g} m; is a diameter written for a radius?",
                    at=link.collisions[0].geometry or link.collisions[0],
                )
                break


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pybullet": (
            "collide with the shape as written: things pass through what is shown"
        ),
    },
    group="robot",
)
def collision_much_smaller_than_visual(robot: Robot, *, ratio: float = 4.0) -> Iterator[Problem]:
    """A link collides with far less than what is seen of it.

    Usually a unit is wrong, or a scale. It is told where the box around the visuals is more than
    ``ratio`` times as long as that around the collisions along each of its sides.
    """
    reach = reaches(robot)
    for link in robot.links:
        seen, touches = reach.shapes(link.visuals), reach.shapes(link.collisions)
        if seen is None or touches is None:
            continue
        sizes = list(zip(sorted(seen.size), sorted(touches.size), strict=True))
        if all(a > ratio * b for a, b in sizes) and sizes[2][1] > 0:
            (a, b), what = sizes[2], link.collisions[0].geometry
            yield Problem(
                link,
                f"link '{link.name}' is seen over {a:.3g} m and collides over {b:.3g} m; is its "
                "scale right?",
                at=what or link.collisions[0],
            )


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic, mujoco": "collide with the shape where it is written",
    },
)
def collision_off_visual(
    robot: Robot, description: Description, *, apart: float = 0.5
) -> Iterator[Problem]:
    """A link collides elsewhere than it is seen.

    One of the two lacks the ``<origin>`` that the other has. It is told where the boxes around
    visuals and collisions do not meet, or their middles are further apart than ``apart`` of the
    visual's diagonal.
    """
    reach = reaches(robot)
    for link in robot.links:
        seen, touches = reach.shapes(link.visuals), reach.shapes(link.collisions)
        if seen is None or touches is None:
            continue
        x, y, z = (a - b for a, b in zip(seen.centre, touches.centre, strict=True))
        distance, diagonal = norm((x, y, z)), norm(seen.size)
        larger = all(a > 2 * b for a, b in zip(touches.size, seen.size, strict=True))
        gltf = any(map(is_gltf, link.visuals)) or any(map(is_gltf, link.collisions))
        lying = gltf and description.gltf_up == "y"
        if (
            diagonal > 0.05
            and not larger
            and (not seen.meets(touches) or distance > apart * diagonal)
            and not displaced(robot, link)
        ):
            yield Problem(
                link,
                f"the collision of link '{link.name}' is {distance:.3g} m off its visual; "
                "give both the same <origin>" + (_AXES if lying else ""),
                at=link.collisions[0].origin or link.collisions[0],
            )
