"""Review of a robot's inertia: written, implied and physically inconsistent values per link."""

from __future__ import annotations

from collections.abc import Sequence

from ..finding import Finding
from ..lint.validate import validate
from ..model.elements import Link, Robot
from .bodies import scale_to_mass
from .judgement import Context, judge, read_written
from .link_review import LinkReview
from .masses import Masses, assign_masses, check_masses
from .mesh_files import Meshes, ReadMeshes
from .pieces import SOURCES, get_shapes, link_body, list_mesh_names


def review(
    robot: Robot,
    read_meshes: ReadMeshes,
    *,
    masses: Masses | None = None,
    source: str | None = None,
    only: Sequence[str] = (),
) -> list[LinkReview]:
    """Review the inertia of a robot's links.

    Without a source, collisions count, or visuals where these lack or their volume is unknown.

    Raises:
        InertiaError: The masses are invalid: see :func:`check_masses`, :func:`assign_masses`.
    """
    masses = masses or Masses()
    check_masses(masses, [link.name for link in robot.links])
    found = [LinkReview(link) for link in robot.links]
    meshes = Meshes(read_meshes)
    find_bodies(found, meshes, source)
    for item in found:
        read_written(item)
    plan = assign_masses(
        masses,
        {item.link.name: _get_written_mass(item.link) for item in found},
        {item.link.name: item.volume for item in found},
        [item.link.name for item in found if item.body is not None and not item.body.complete],
    )
    by_link: dict[str, list[Finding]] = {}
    for finding in validate(robot, "inertia"):
        by_link.setdefault(finding.name, []).append(finding)
    for item in found:
        item.mass = plan[item.link.name]
        if item.mass and item.body is not None and item.body.complete:
            item.implied = scale_to_mass(item.body.unit, "link", mass=item.mass)
        judge(item, by_link.get(item.link.name, ()), Context(robot, meshes))
    return [item for item in found if not only or item.link.name in only]


def find_bodies(found: list[LinkReview], meshes: Meshes, source: str | None = None) -> None:
    """Set the body of each link from one source; all missing meshes are read together."""
    for name in (source,) if source else SOURCES:
        todo = [
            item
            for item in found
            if (item.body is None or not item.body.complete) and get_shapes(item.link, name)
        ]
        meshes.load(
            [mesh for item in todo for mesh in list_mesh_names(get_shapes(item.link, name))]
        )
        for item in todo:
            body = link_body(item.link, name, meshes.known)
            if item.body is None or (body is not None and body.complete):
                item.body = body


def _get_written_mass(link: Link) -> float | None:
    mass = link.inertial.mass if link.inertial else None
    return mass if mass and mass > 0 else None
