"""Mass properties of one link from its geometry: the Python API of ``urdftool inertia robot``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from ..arguments import check_arguments
from ..errors import UrdftoolError
from ..mechanics.spatial_inertia import SpatialInertia
from ..model.elements import Link
from ..source.description import Description
from ..source.document import STDIN, Document
from ..source.packages import Packages
from .bodies import scale_to_mass
from .inertia_error import InertiaError
from .mesh_files import read_meshes
from .pieces import SOURCES, LinkBody, get_shapes, link_body, list_mesh_names
from .requirements import require_consistent


@check_arguments
def compute_inertia(
    link: Link,
    *,
    density: float | None = None,
    mass: float | None = None,
    source: str | None = None,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
) -> SpatialInertia:
    """Compute the mass properties that the geometry of a link implies, in the link frame.

    All shapes are solid and of the same density. A closed mesh is integrated exactly; any other is
    repaired or estimated. The inertia [kg·m²] is about the center of mass.

    Args:
        link: A link of a robot that was loaded.
        density: Density [kg/m³]; give this or ``mass``. By default, the written mass is used.
        mass: Mass of the link [kg].
        source: ``"collision"`` or ``"visual"``; None for the collisions, or the visuals if there
            are no collisions or their volume is unknown.
        packages: Folders of ROS packages by name; others are found as on the command line.
        package_paths: Folders that contain ROS packages.

    Raises:
        InertiaError: The link has no geometry, mass or density is not above zero, or both or
            neither are known.
        MeshError: A mesh cannot be read or encloses no volume.
        PackageNotFound: The package of a mesh is not found.
    """
    if density is None and mass is None:
        mass = link.mass or None
        if mass is None:
            raise InertiaError(
                f"link '{link.name}' has no mass of its own; give a mass [kg] or a density [kg/m³]"
            )
    if source is not None and source not in SOURCES:
        raise InertiaError(f"'{source}' is not a geometry of a link; use collision or visual")
    root = link.element
    while root.parent is not None:
        root = root.parent
    path = root.file.path
    finder = Packages(None if path == STDIN else path, named=packages, paths=package_paths)
    description = Description(path, Document(root.file, root, []), [root.file], finder)
    body = _make_body(link, description, source)
    properties = scale_to_mass(body.unit, f"link '{link.name}'", mass=mass, density=density)
    return require_consistent(properties, f"link '{link.name}'")


def _make_body(link: Link, description: Description, source: str | None) -> LinkBody:
    reason: UrdftoolError | None = None
    for name in (source,) if source else SOURCES:
        shapes = get_shapes(link, name)
        meshes = read_meshes(description, list_mesh_names(shapes), jobs=1)
        body = link_body(link, name, meshes)
        if body is not None and body.complete:
            return body
        if body is not None:
            lack = body.lacks[0]
            failed = next((m for m in meshes.values() if isinstance(m, UrdftoolError)), None)
            reason = reason or failed or InertiaError(lack.reason, at=lack.shape.place)
    raise reason or InertiaError(
        f"link '{link.name}' has no {source or 'geometry'} to compute from", at=link.place
    )
