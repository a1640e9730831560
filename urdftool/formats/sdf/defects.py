"""Defects that only the SDF writer can know; the others are rules, see ``lint.validate``.

A mesh is a defect if it cannot be converted. Whether an inertia is physically consistent is decided
for each rigid body that is written. A rule about a link cannot know them: the plan of the export
makes them of links and fixed joints.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...finding import Finding
from ...mechanics.spatial_inertia import link_inertia
from ...model.elements import Link, Mesh, Robot
from ..common.missing_files import create_missing_mesh
from ..defects import make_defect
from .mesh_files import MeshFiles
from .plan import ROUNDING, Plan, get_excess


def report_mesh_defects(robot: Robot, meshes: MeshFiles) -> Iterator[Finding]:
    """Report meshes that are missing or cannot be read, each once."""
    seen = set()
    for link, shape in robot.shapes:
        mesh = shape.geometry
        if isinstance(mesh, Mesh) and not meshes.is_known(mesh) and mesh.filename not in seen:
            seen.add(mesh.filename)
            refused = meshes.refused.get(mesh.filename)
            if not refused:
                yield create_missing_mesh(robot, link, mesh)
                continue
            text = f"mesh '{mesh.filename}' of link '{link.name}' cannot be used: {refused}"
            place = mesh.element.locate_attribute("filename")
            yield make_defect("corrupt-mesh", text, place, "link", link.name)


def report_inertia_defects(robot: Robot, plan: Plan) -> Iterator[Finding]:
    """Report bodies whose inertia is physically inconsistent, with all that is lumped into them."""
    for owner, mass in plan.mass.items():
        short = get_excess(mass)
        if mass.mass <= 0 or short <= ROUNDING:
            continue
        members = [robot.link[name] for name in plan.members[owner]]
        worst = max(members, key=_compute_own_shortfall)
        inertia = worst.inertial and (worst.inertial.inertia or worst.inertial)
        yield make_defect(
            "inertia-triangle-inequality",
            f"inertia of link '{worst.name}' is physically inconsistent: its largest principal "
            f"moment exceeds the sum of the others by {short:.0%}",
            (inertia or worst).place,
            "link",
            worst.name,
            "--fix-inertia lift, balance or box changes it",
        )


def _compute_own_shortfall(link: Link) -> float:
    return get_excess(link_inertia(link))
