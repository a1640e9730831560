"""Check surfaces of collision meshes: holes, orientation, degenerate triangles, convexity."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from ...errors import MeshError
from ...model.attached import find_attached_links, is_fixed_to_world
from ...model.elements import Link, Robot
from ...source.description import Description
from ...workspace import Workspace, memoize_by_workspace
from ..cross_file_references import check_alone
from ..file_rewrites import TURNED, WITHOUT_COLLAPSED, count_collapsed
from ..fix import FixContext, Proposal, unsafe
from ..rule import ERROR, INFO, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from .changes import find_existing_uses, rewrite_in_place
from .mesh_uses import MeshUse, get_mesh_uses, is_concave

APPLIES_TO = ("mesh",)

if TYPE_CHECKING:
    from ...geometry.surface import Surface


MOST_SLIVERS = 0.2
"""Part of a mesh's triangles that may have no area. Chosen, no source."""


@memoize_by_workspace
def _read_surface(workspace: Workspace, path: Path) -> Surface | None:
    from ...geometry.surface import read_surface

    return read_surface(workspace.materialize(path))


@memoize_by_workspace
def _compute_change_by_closing(workspace: Workspace, path: Path) -> float | None:
    from ...geometry.surface import change_by_closing

    return change_by_closing(str(workspace.materialize(path)))


@memoize_by_workspace
def _compute_hull_volume(workspace: Workspace, path: Path) -> float | None:
    from ...geometry.surface import compute_hull_volume

    return compute_hull_volume(str(workspace.materialize(path)))


def _read_surfaces(
    robot: Robot,
    description: Description,
    concerns: Callable[[Robot, Link], bool] = lambda _robot, _link: True,
) -> Iterator[tuple[MeshUse, Path, Surface]]:
    """List the collision meshes that are STL or OBJ files and can be read, each once."""
    seen: set[str] = set()
    for use in get_mesh_uses(robot, description):
        if not use.collides or not use.exists or use.path is None or use.uri in seen:
            continue
        if use.path.suffix.lower() not in (".stl", ".obj"):
            continue  # slow to read, and meant for display
        if not concerns(robot, use.link):
            continue
        seen.add(use.uri)
        try:
            found = _read_surface(use.workspace, use.path)
        except OSError:
            continue
        if found is not None:
            yield use, use.path, found


def _has_computed_mass(robot: Robot, link: Link) -> bool:
    """Tell whether MuJoCo computes a link's mass from its collisions: moving, no inertial."""
    if link.inertial is not None or is_fixed_to_world(robot, link):
        return False
    return all(robot.tree.get_parent_joint(one.name) for one, _ in find_attached_links(robot, link))


def _combine_findings(
    found: list[tuple[MeshUse, str]], message: Callable[[MeshUse], str]
) -> list[Problem]:
    """Combine findings: the first mesh with its details, and the links of the others."""
    if not found:
        return []
    (use, what), rest = found[0], found[1:]
    others = ", ".join(f"'{other.link.name}'" for other, _ in rest)
    text = message(use).format(what) + (f"; so are those of {others}" if rest else "")
    uris = [use.uri for use, _ in found]
    place = use.mesh.locate_attribute("filename")
    return [Problem(use.link, text, at=place, data={"uris": uris})]


@rule(
    INFO,
    effects={
        "mujoco": "computes mass, center and inertia of the link from it, changed by the hole",
    },
    default=False,
)
def not_watertight(
    robot: Robot, description: Description, *, change: float = 0.05
) -> Iterator[Problem]:
    """The surface of a collision mesh has a hole, and its link has no ``<inertial>``.

    An open surface has no defined inside, so mass, center of mass and inertia that are computed
    from it are wrong. Simulators compute them for a link without an inertial; contacts are not
    affected, because they use the convex hull or the triangles. It is reported if closing the
    holes changes volume, center or inertia by more than ``change`` (relative), as MuJoCo computes
    them from a URDF: without the signs of volumes. One finding names all such links.
    """
    found: list[tuple[MeshUse, str]] = []
    for use, path, surface in _read_surfaces(robot, description, _has_computed_mass):
        if not surface.open_edges:
            continue
        changed = _compute_change_by_closing(use.workspace, path)
        if changed is not None and changed > change:
            much = f"by {changed * 100:.0f} %" if changed < 1 else "completely"
            found.append(
                (
                    use,
                    f"{surface.open_edges} edges have an odd number of triangles (closing the "
                    f"holes changes volume, center or inertia in MuJoCo {much})",
                )
            )
    yield from _combine_findings(
        found,
        lambda use: (
            f"collision mesh '{use.uri}' of link '{use.link.name}', which has no <inertial>, is "
            "not watertight: {}"
        ),
    )


_FLAT = 1e-12
"""Thickness of a mesh, relative to its size, below which MuJoCo 3.3 and 4.0 reject it.

At 1e-8 both load it, at 0 neither does (run).
"""


@rule(
    WARNING,
    raised={"mujoco": ERROR},
    effects={
        "mujoco": "rejects the robot: it computes a convex hull of each collision mesh",
        "pybullet": "loads it",
    },
    group="robot",
    formats=URDF_AND_SDF,
)
def flat_collision_mesh(robot: Robot, description: Description) -> Iterator[Problem]:
    """All points of a collision mesh lie in a plane.

    MuJoCo computes a convex hull of each collision mesh and rejects a robot whose mesh has none: a
    sheet or a single triangle. A visual may be flat. Use a thin box, or a mesh with a thickness.
    """
    for use, _, surface in _read_surfaces(robot, description):
        if surface.thickness > _FLAT:
            continue
        yield Problem(
            use.link,
            f"collision mesh '{use.uri}' of link '{use.link.name}' lies in a plane; use a thin box",
            at=use.mesh.locate_attribute("filename"),
            data={"uri": use.uri},
        )


@rule(
    WARNING,
    default=False,
    effects={
        "mujoco": "3.3 and 4.0 load it",
        "rviz": "lights it by the normals of the file",
    },
    group="robot",
    formats=URDF_AND_SDF,
)
def inverted_mesh(robot: Robot, description: Description) -> Iterator[Problem]:
    """The triangles of a collision mesh face inward.

    The surface is closed and its volume is negative: every normal points into the body, and the
    mass properties that are computed from it are negative. Reverse the triangles.
    """
    for use, _, surface in _read_surfaces(robot, description):
        if surface.inside_out:
            yield Problem(
                use.link,
                f"collision mesh '{use.uri}' of link '{use.link.name}' is inside out; reverse its "
                "triangles",
                at=use.mesh.locate_attribute("filename"),
                data={"uri": use.uri},
            )


@inverted_mesh.fix(UNSAFE, writes_meshes=True)
def turn_triangles(problem: Problem, context: FixContext) -> Proposal | None:
    """Reverse the triangles of the file, if no other description uses it."""
    uses = [use for use in find_existing_uses(problem, context) if use.uri.lower().endswith(".stl")]
    if not uses:
        return None
    check_alone(context, str(uses[0].path and uses[0].path.name), robots=True)
    return unsafe("reverse its triangles", *rewrite_in_place(uses[:1], TURNED))


@rule(
    INFO,
    effects={
        "mujoco, pybullet, pinocchio": "load it",
        "rviz": "normalizes a normal of length 0",
    },
    default=False,
    formats=URDF_AND_SDF,
)
def degenerate_triangles(
    robot: Robot, description: Description, *, most: float = MOST_SLIVERS
) -> Iterator[Problem]:
    """Many triangles of a collision mesh have no area.

    Two of their corners coincide, or all three lie on a line, so they have no normal. Most
    exporters leave a few; this many are the sign of a broken export. ``most`` is the tolerated
    part. One finding names all such links.
    """
    found = [
        (use, f"{surface.flat} of its {surface.faces} triangles")
        for use, surface in _find_degenerate(robot, description, most)
    ]
    yield from _combine_findings(
        found,
        lambda use: (
            f"collision mesh '{use.uri}' of link '{use.link.name}' is degenerate: {{}} have no area"
        ),
    )


def _find_degenerate(
    robot: Robot, description: Description, most: float = MOST_SLIVERS
) -> list[tuple[MeshUse, Surface]]:
    """List the collision meshes with more than a part of triangles without area."""
    return [
        (use, surface)
        for use, _, surface in _read_surfaces(robot, description)
        if surface.flat > most * surface.faces
    ]


@degenerate_triangles.fix(UNSAFE, writes_meshes=True)
def remove_collapsed_triangles(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove triangles with two coinciding corners, which leaves no hole.

    Triangles with three different corners on a line stay, because removing them leaves gaps.
    """
    found = _find_degenerate(context.robot, context.description)
    uses = [use for use, _ in found]
    if not uses or any(not use.uri.lower().endswith(".stl") for use in uses):
        return None
    for use, surface in found:
        try:
            removed = count_collapsed(use.workspace, Path(str(use.path)))
        except (MeshError, OSError):
            return None
        if surface.flat - removed > 0.01 * (surface.faces - removed):
            return None
        check_alone(context, str(use.path and use.path.name), robots=True)
    return unsafe("remove triangles without area", *rewrite_in_place(uses, WITHOUT_COLLAPSED))


@rule(
    INFO,
    on=("mujoco", "pybullet"),
    effects={
        "mujoco": "uses its convex hull for contact: a ball between two prongs touches it",
        "pybullet": (
            "uses its convex hull for contact; for an OBJ with several objects, the hull of each"
        ),
        "pybullet (concave)": "uses its triangles for contact, because the collision is concave",
    },
    group="robot",
    default=False,
)
def nonconvex_collision_mesh(
    robot: Robot, description: Description, targets: frozenset[str], *, ratio: float = 1.5
) -> Iterator[Problem]:
    """A collision mesh is far from convex.

    MuJoCo and PyBullet use the convex hull of a mesh for contact: a bowl is filled, and a gripper
    touches objects before it closes. It is reported if the hull has more than ``ratio`` times the
    volume of the mesh. ``urdftool collision`` decomposes it into convex parts. PyBullet keeps the
    triangles of a ``<collision>`` with the attribute ``concave``; these are reported for MuJoCo
    only.
    """
    for use, path, surface in _read_surfaces(robot, description):
        if surface.open_edges or not surface.consistent or surface.volume == 0:
            continue
        concave = is_concave(use)
        if concave and "mujoco" not in targets:
            continue
        hull = _compute_hull_volume(use.workspace, path)
        if hull is None or hull <= ratio * abs(surface.volume):
            continue
        yield Problem(
            use.link,
            f"collision mesh '{use.uri}' of link '{use.link.name}' is not convex: the volume of "
            f"its convex hull is {hull / abs(surface.volume):.2g} times as large",
            at=use.mesh.locate_attribute("filename"),
            data={"uri": use.uri, "ratio": hull / abs(surface.volume), "limit": ratio},
            hint="'urdftool collision' decomposes it into convex parts",
            group=""
            if concave
            else "{count} collision meshes are far from convex, and physics engines use their "
            "convex hulls, in the links {names}",
            effects=("mujoco", "pybullet (concave)" if concave else "pybullet"),
            alike=concave,
        )
