"""Check the size and the scale of meshes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

from ...diagnostic import FileRewrite
from ...geometry.stl_header import HEADER_BYTES, TRIANGLE_BYTES, read_stl_header
from ...model.attached import is_fixed_to_world
from ...model.bounds import compute_bounds
from ...model.elements import Collision, Mesh, Robot
from ...model.read import parse_numbers
from ...source.description import Description
from ...workspace import Workspace, memoize_by_workspace
from ..file_rewrites import MIRRORED
from ..fix import Change, FixContext, Proposal, remove_attribute, set_attribute, substitute, unsafe
from ..mujoco import keeps_visuals
from ..rule import ANY_FORMAT, ERROR, INFO, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from .changes import find_uses, write_new_file
from .link_extents import compute_mesh_box
from .mesh_uses import MeshUse, get_mesh_uses

APPLIES_TO = ("mesh",)

_SAMPLE = 300
"""Triangles, from the beginning, middle and end of a file. Chosen, no source."""


@memoize_by_workspace
def sample_extent(workspace: Workspace, path: Path) -> tuple[float, float, float] | None:
    """Compute the size of a sample of a binary STL file, a lower bound of its size."""
    try:
        return _sample(workspace.materialize(path))
    except OSError:
        return None


def _sample(path: Path) -> tuple[float, float, float] | None:
    facts = read_stl_header(path)
    if facts.kind != "binary" or not facts.triangles or not facts.size_agrees:
        return None
    from ...geometry.stl import sample_extent

    return sample_extent(path, facts, _SAMPLE)


_LOOKED_AT = 400_000
"""[bytes]. Chosen, no source."""


def estimate_size(use: MeshUse) -> float | None:
    """Estimate the largest length of a scaled mesh [m]; None if that is slow or impossible."""
    if use.path is None or not use.exists:
        return None
    ending = use.path.suffix.lower()
    if ending == ".stl":
        return _compute_largest(use)
    if ending != ".dae":
        return None
    if (use.size or 0) > _LOOKED_AT:
        return None
    return _compute_largest(use)


def _compute_largest(use: MeshUse, whole: bool = False) -> float | None:
    """Compute the largest length of a scaled mesh, or of a sample of it [m]."""
    if use.path is None or not use.exists:
        return None
    if use.path.suffix.lower() != ".stl":
        box = compute_mesh_box(use)
        return None if box is None else max(box.size)
    extent = sample_extent(use.workspace, use.path)
    if extent is not None and whole:
        from ...geometry.stl import compute_stl_bounds

        bounds = compute_stl_bounds(use.workspace.materialize(use.path))
        if bounds is None:
            return None
        (a, b, c), (d, e, f) = bounds
        extent = d - a, e - b, f - c
    if extent is None:
        return None
    return max(abs(s) * length for s, length in zip(use.mesh.scale, extent, strict=True))


@rule(
    WARNING,
    effects={
        "mujoco, pybullet, pinocchio": "take the numbers of the file as meters",
    },
    formats=ANY_FORMAT,
    pedantic="scenery that is fixed to the world: slabs, and with a primitive half as long",
)
def mesh_in_millimeters(
    robot: Robot, description: Description, *, largest: float = 10.0
) -> Iterator[Problem]:
    """A mesh is larger than ``largest`` [m]: its file is probably in millimeters.

    STL files have no unit, and CAD programs often export millimeters, but readers take meters.
    Among thousands of meshes of real robots, none was between 2 m and 100 m long. Add
    ``scale="0.001 0.001 0.001"``. A scene without a moving joint may be as large as a building: of
    such, only STL files above 100 m are reported. What is fixed to the world is off by default, if
    a primitive shape is at least half as long, as a pitch with its boards, or if it is a slab that
    is no STL file.
    """
    seen: set[str] = set()
    for use in get_mesh_uses(robot, description):
        length = _compute_largest(use) if use.uri not in seen else None
        if length is not None and length > largest:
            is_larger = _is_larger_than_scene(use, length)
            if not robot.moving_joints and not is_larger:
                continue
            seen.add(use.uri)
            is_scenery = not is_larger and _is_part_of_scene(robot, use, length)
            yield _report_large_mesh(use, length, largest, is_scenery=is_scenery)


@mesh_in_millimeters.full
def report_every_mesh_in_millimeters(robot: Robot) -> Iterator[Problem]:
    """Report each link with a mesh that is too large; only robots with a description have any."""
    description = robot.source
    largest = mesh_in_millimeters.thresholds["largest"]
    seen: set[tuple[str, str]] = set()
    for use in get_mesh_uses(robot, description) if description is not None else ():
        length = _compute_largest(use) if (use.link.name, use.uri) not in seen else None
        if length is None or length <= largest:
            continue
        if robot.moving_joints or _is_larger_than_scene(use, length):
            seen.add((use.link.name, use.uri))
            yield _report_large_mesh(use, length, largest)


_SLAB = 50
"""Least ratio of the length of a slab to its thickness; chosen: a ground of 20 m had 0.1 m."""

_SCENE = 100.0
"""Largest length [m] of a scene; STL scenes of hpp-environments have up to 27 m."""


def _is_part_of_scene(robot: Robot, use: MeshUse, length: float) -> bool:
    """Tell whether a mesh is fixed to the world, and a slab or next to a primitive half as long."""
    if not is_fixed_to_world(robot, use.link):
        return False
    if use.path is not None and use.path.suffix.lower() != ".stl":
        box = compute_mesh_box(use)
        if box is not None and min(box.size) * _SLAB < length:
            return True
    boxes = [
        compute_bounds(shape)
        for link, shape in robot.shapes
        if not isinstance(shape.geometry, Mesh) and is_fixed_to_world(robot, link)
    ]
    known = [box for box in boxes if box is not None]
    return any(max(box.size) * 2 >= length for box in known)


def _is_larger_than_scene(use: MeshUse, length: float) -> bool:
    if not use.uri.lower().endswith(".stl"):
        return False
    return max(length, _compute_largest(use, whole=True) or 0.0) > _SCENE


def _report_large_mesh(
    use: MeshUse, length: float, largest: float, *, is_scenery: bool = False
) -> Problem:
    length = _compute_largest(use, whole=True) or length  # a sample is a lower bound
    right = ""
    if use.mesh.xml is None and use.mesh.scale == (1.0, 1.0, 1.0):
        right = "; write the scale 0.001 0.001 0.001"
    elif use.mesh.xml is not None and not use.mesh.xml.get("scale"):
        right = '; write scale="0.001 0.001 0.001"'
    return Problem(
        use.link,
        f"mesh '{use.uri}' is {length:.3g} m long, so it is probably in millimeters{right}",
        at=use.mesh.locate_attribute("filename"),
        data={
            "uri": use.uri,
            "length": length,
            "limit": largest,
            "scale": list(use.mesh.scale),
        },
        pedantic=is_scenery,
    )


@mesh_in_millimeters.fix(UNSAFE)
def scale_by_thousandth(problem: Problem, context: FixContext) -> Proposal | None:
    """Scale the file by 0.001 in all its uses, if none of them has a scale."""
    uses = find_uses(problem, context)
    if not uses or any(use.mesh.element.get("scale") for use in uses):
        return None
    scale = "0.001 0.001 0.001"
    changes = [set_attribute(use.mesh.element, "scale", scale) for use in uses]
    return unsafe(f'write scale="{scale}"', *changes)


@rule(
    WARNING,
    effects={
        "mujoco, pybullet": "apply the scale, which makes the mesh a thousand times too small",
    },
    formats=ANY_FORMAT,
)
def mesh_scaled_twice(
    robot: Robot, description: Description, *, smallest: float = 0.001
) -> Iterator[Problem]:
    """A mesh is smaller than ``smallest`` [m]: it was probably scaled twice.

    The file is already in meters, and ``scale`` reduces it by 1000 again. Real links are larger
    than a millimeter. Remove the scale.
    """
    seen: set[str] = set()
    for use in get_mesh_uses(robot, description):
        if use.uri in seen or min(map(abs, use.mesh.scale)) == 0:
            continue
        length = _compute_largest(use)
        if length is None or length >= smallest:
            continue
        length = _compute_largest(use, whole=True)
        if length is not None and 0 < length < smallest:
            seen.add(use.uri)
            scale = (use.mesh.xml and use.mesh.xml.get("scale")) or ""
            right = "; remove the scale" if scale else ""
            yield Problem(
                use.link,
                f"mesh '{use.uri}' is only {length * 1000:.3g} mm long{right}",
                at=use.mesh.locate_attribute("scale"),
                data={"uri": use.uri, "length": length, "limit": smallest, "scale": scale},
            )


@mesh_scaled_twice.fix(UNSAFE)
def remove_scale(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the scale in all uses, if it is 0.001 in each."""
    uses = find_uses(problem, context) if problem.data["scale"] else []
    if not uses or any(not math.isclose(part, 0.001) for use in uses for part in use.mesh.scale):
        return None
    changes = [remove_attribute(use.mesh.element, "scale") for use in uses]
    return unsafe("remove the scale", *changes)


@rule(
    WARNING,
    on=("gz",),
    effects={
        "gz": "takes the scale as written; Ogre 2 shows the back sides of the triangles",
    },
    formats=URDF_AND_SDF,
)
def mirrored_scale(robot: Robot, description: Description) -> Iterator[Problem]:
    """The mesh of a visual is mirrored by a negative scale.

    A negative factor turns the triangles inside out, which new Gazebo does not correct: only the
    back sides are drawn. Use a mirrored copy of the file; other links may use the original. One
    finding names all such meshes. Collisions are not reported, and the rule only runs for new
    Gazebo, for which the defect was reported.
    """
    found = []
    for use in get_mesh_uses(robot, description):
        x, y, z = use.mesh.scale
        if x * y * z < 0 and not use.collides:
            found.append(use)
    if found:
        count = len({use.uri for use in found})
        more = f" (and {count - 1} more)" if count > 1 else ""
        yield Problem(
            found[0].link,
            f"mesh '{found[0].uri}'{more} has a negative scale, which turns its triangles inside "
            "out; use a mirrored copy of the file",
            at=found[0].mesh.locate_attribute("scale"),
            data={"uris": list(dict.fromkeys(use.uri for use in found))},
        )


@mirrored_scale.fix(UNSAFE, writes_meshes=True)
def write_mirrored_mesh(problem: Problem, context: FixContext) -> Proposal | None:
    """Write mirrored files, for STL files only because they have no colors to lose."""
    changes: list[Change | FileRewrite] = []
    for use in get_mesh_uses(context.robot, context.description):
        x, y, z = use.mesh.scale
        if x * y * z >= 0:
            continue
        if use.path is None or not use.exists or not use.uri.lower().endswith(".stl"):
            return None
        axes = "".join(axis for axis, factor in zip("xyz", (x, y, z), strict=True) if factor < 0)
        name = f"{use.path.stem}_mirrored_{axes}{use.path.suffix}"
        new = write_new_file(use, name, MIRRORED + axes)
        if not new:
            return None
        element = use.mesh.element
        scale = " ".join(f"{abs(factor):.12g}" for factor in (x, y, z))
        changes.append(substitute(element, "filename", r"\.(?=\w+\s*$)", f"_mirrored_{axes}."))
        changes += [set_attribute(element, "scale", scale), *new]
    return unsafe("use a mirrored copy of the file", *dict.fromkeys(changes)) if changes else None


@rule(
    WARNING,
    effects={
        "urdfdom, gz, gazebo-classic, pybullet": "take each scale as written",
    },
    formats=URDF_AND_SDF,
)
def mesh_scale_differs(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh file is used with two different scales.

    The visual and the collision of a link, or its left and right parts, share a file, but a scale
    was forgotten or lost a power of ten on one of them. Signs are ignored, because mirrored parts
    have negative ones. A mesh that is stretched to several shapes, such as a cube for the top and
    the legs of a table, is not reported: unless the visual and the collision of one link differ,
    two scales are compared only if both are uniform or differ by a power of ten.
    """
    uses: dict[str, list[MeshUse]] = {}
    for use in get_mesh_uses(robot, description):
        uses.setdefault(use.uri, []).append(use)
    for uri, same in uses.items():
        scales = [tuple(map(abs, use.mesh.scale)) for use in same]
        usual = max(scales, key=scales.count)
        for use, scale in zip(same, scales, strict=True):
            if all(math.isclose(a, b, rel_tol=0.02) for a, b in zip(scale, usual, strict=True)):
                continue
            stretched = not (_is_uniform(scale) and _is_uniform(usual))
            if stretched and not _is_power_of_ten(scale, usual) and not _is_pair(use, same):
                continue
            yield Problem(
                use.link,
                f"mesh '{uri}' of link '{use.link.name}' has scale {_format_scale(scale)}, but "
                f"{_format_scale(usual)} in other places; use one scale",
                at=use.mesh.locate_attribute("scale")
                if use.mesh.has_attribute("scale")
                else use.mesh,
            )


def _is_uniform(scale: tuple[float, ...]) -> bool:
    return math.isclose(min(scale), max(scale), rel_tol=0.02)


def _is_power_of_ten(scale: tuple[float, ...], usual: tuple[float, ...]) -> bool:
    """Tell whether one scale is a power of ten times the other, along each axis."""
    if not (min(scale) > 0 and min(usual) > 0):
        return False
    powers = [math.log10(a / b) for a, b in zip(scale, usual, strict=True)]
    return max(powers) - min(powers) < 0.01 and abs(powers[0] - round(powers[0])) < 0.01


def _is_pair(use: MeshUse, same: list[MeshUse]) -> bool:
    """Tell whether one visual and one collision of a link use the mesh."""
    kinds = [other.collides for other in same if other.link is use.link]
    return sorted(kinds) == [False, True]


def _format_scale(scale: tuple[float, ...]) -> str:
    return " ".join(f"{factor:g}" for factor in scale)


@rule(
    INFO,
    default=False,
    effects={
        "urdfdom, gz, gazebo-classic, pybullet": "take the scale as written",
    },
    formats=ANY_FORMAT,
)
def mesh_scale_outlier(
    robot: Robot, description: Description, *, several: float = 4
) -> Iterator[Problem]:
    """The scale of one mesh differs by a power of ten from all others of the robot.

    The meshes of a robot usually come from one program in one unit. If ``several`` or more files
    of a format have one scale and a single one differs by a power of ten, a zero was lost. A factor
    of 1000 is not reported, because such a file is in another unit (meters or millimeters);
    ``mesh-in-millimeters`` and ``mesh-scaled-twice`` report files whose size shows a wrong one.
    """
    formats: dict[str, dict[str, MeshUse]] = {}
    for use in get_mesh_uses(robot, description):
        ending = use.uri.rpartition(".")[2].lower()
        formats.setdefault(ending, {}).setdefault(f"{use.uri} {use.mesh.scale}", use)
    for uses in formats.values():
        scales = [abs(use.mesh.scale[0]) for use in uses.values()]
        usual = max(scales, key=scales.count)
        others = [use for use in uses.values() if abs(use.mesh.scale[0]) != usual]
        if len(others) != 1 or scales.count(usual) < several or not usual:
            continue
        use, factor = others[0], abs(others[0].mesh.scale[0]) / usual
        power = math.log10(factor) if factor > 0 else 0.5
        if abs(abs(power) - 3) < 0.01:
            continue
        if abs(power - round(power)) < 0.01 and use.mesh.has_attribute("scale"):
            yield Problem(
                use.link,
                f"mesh '{use.uri}' of link '{use.link.name}' is scaled {factor:g} times as much as "
                f"the other {scales.count(usual)} meshes; check its scale",
                at=use.mesh.locate_attribute("scale"),
                data={"uri": use.uri, "factor": factor},
            )


@rule(
    ERROR,
    effects={
        "drake": "rejects it",
        "mujoco": "rejects it",
        "urdfdom, gz, gazebo-classic, pybullet": "accept it: the shape is flat",
    },
    formats=URDF_AND_SDF,
)
def bad_scale(robot: Robot) -> Iterator[Problem]:
    """A mesh has a scale of zero.

    The mesh is then flat, or a point. Write nonzero factors.
    """
    for link, shape in robot.shapes:
        mesh = shape.geometry
        if not isinstance(mesh, Mesh):
            continue
        text = f"{mesh.scale[0]:g} {mesh.scale[1]:g} {mesh.scale[2]:g}"
        if mesh.xml is not None:
            text = mesh.xml.get("scale") or ""
        values = parse_numbers(text, 3)
        if values is not None and 0 in values:
            yield Problem(
                link,
                f"scale '{text}' of a mesh of link '{link.name}' has a factor 0, which makes it "
                "flat; write nonzero factors",
                at=mesh.locate_attribute("scale"),
                data={"scale": list(values)},
                effects=[
                    *("drake", "urdfdom, gz, gazebo-classic, pybullet"),
                    *["mujoco"] * (isinstance(shape, Collision) or keeps_visuals(robot)),
                ],
            )


@rule(
    INFO,
    default=False,
    effects={
        "urdfdom, gz, gazebo-classic, pybullet": "take the factors as written",
    },
)
def non_uniform_scale(robot: Robot, description: Description) -> Iterator[Problem]:
    """A mesh is scaled by different factors along its axes.

    Lighting and inertia that are computed from the file then do not fit the scaled shape. Scale
    the mesh file itself.
    """
    for use in get_mesh_uses(robot, description):
        factors = [abs(factor) for factor in use.mesh.scale]
        if max(factors) - min(factors) > 0.01 * max(factors):
            yield Problem(
                use.link,
                f"mesh '{use.uri}' has the non-uniform scale {use.mesh.element.get('scale')}; "
                "scale the file itself",
                at=use.mesh.locate_attribute("scale"),
                data={"uri": use.uri, "scale": list(use.mesh.scale)},
            )


@rule(
    INFO,
    default=False,
    effects={
        "rviz": "loads and draws every triangle",
    },
)
def heavy_visual(
    robot: Robot, description: Description, *, most: float = 100000, megabytes: float = 10
) -> Iterator[Problem]:
    """A visual mesh is very large.

    More than ``most`` triangles, or ``megabytes`` [MB], make RViz slow and the repository large.
    Simplify the mesh.
    """
    seen: set[str] = set()
    for use in get_mesh_uses(robot, description):
        if use.collides or use.uri in seen or use.size is None:
            continue
        seen.add(use.uri)
        size = use.size
        if size > megabytes * 1e6 or size > HEADER_BYTES + TRIANGLE_BYTES * most:
            yield Problem(
                use.link,
                f"visual mesh '{use.uri}' is {size / 1e6:.0f} MB large; simplify it",
                at=use.mesh.locate_attribute("filename"),
                data={"uri": use.uri, "bytes": size},
            )
