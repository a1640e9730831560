"""Check formats of mesh files against the formats that readers support."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

from ...diagnostic import FileRewrite
from ...geometry.stl_header import StlHeader, read_stl_header
from ...model.elements import Robot
from ...model.mesh_formats import READ_BY, find_rejecting_readers, get_suffix, is_odd
from ...source.description import Description
from ...workspace import Workspace, memoize_by_workspace
from ..file_rewrites import BINARY, HEADED
from ..fix import Change, FixContext, Proposal, safe, substitute, unsafe
from ..mujoco import keeps_visuals
from ..rule import ANY_FORMAT, BOTH, ERROR, INFO, SAFE, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from .changes import find_existing_uses, rewrite_in_place, write_new_file
from .mesh_uses import MeshUse, get_mesh_uses

APPLIES_TO = ("mesh",)

_OF_TEXT = ("pybullet", "rviz", "gz", "pinocchio")


def _get_first_uses(robot: Robot, description: Description) -> Iterator[MeshUse]:
    """Get the first use of each mesh file, collisions before visuals."""
    uses = get_mesh_uses(robot, description)
    seen: set[str] = set()
    for use in (*(u for u in uses if u.collides), *(u for u in uses if not u.collides)):
        if use.uri and use.uri not in seen:
            seen.add(use.uri)
            yield use


_OF_FORMAT = {
    "mujoco (collision)": "rejects the file: no decoder found",
    "pybullet (not read)": "rejects the file: invalid mesh filename extension",
    "drake (collision)": "rejects the file: it computes convex hulls of OBJ, VTK and glTF only",
    "pinocchio (collision in PLY)": "reads all formats of assimp, including PLY",
    "isaac (not read)": "drops the shape with a warning",
}


@rule(
    ERROR,
    effects=_OF_FORMAT,
    formats=URDF_AND_SDF,
)
def unsupported_mesh_format(
    robot: Robot, description: Description, targets: frozenset[str]
) -> Iterator[Problem]:
    """A mesh is in a format that a target does not read.

    MuJoCo reads STL, OBJ and its own MSH, and by default only for collisions; PyBullet OBJ, STL
    and part of COLLADA; Gazebo COLLADA, STL and OBJ, and new Gazebo also glTF and FBX; the importer
    of Isaac Sim OBJ, STL and COLLADA. The targets that are configured decide what is reported.
    Convert the file.
    """
    seen: set[tuple[str, str]] = set()
    for use in _get_first_uses(robot, description):
        ending = get_suffix(use.uri)
        if not ending or is_odd(ending) or (use.path is not None and not use.exists):
            continue
        who = [
            target
            for target, known in READ_BY.items()
            if target in targets and ending not in known and (target != "mujoco" or use.collides)
        ]
        key = ending, " and ".join(who)
        if who and key not in seen:
            seen.add(key)
            same = [u for u in _get_first_uses(robot, description) if get_suffix(u.uri) == ending]
            more = f" (and {len(same) - 1} more)" if len(same) > 1 else ""
            yield Problem(
                use.link,
                f"{', '.join(who)} cannot read the format of mesh '{use.uri}'{more}; "
                + (
                    "its suffix means binary STL: rename it to .stl"
                    if ending == "stlb"
                    else f"convert it, for example to {READ_BY[who[0]][0]}"
                ),
                at=use.mesh.locate_attribute("filename"),
                effects=_select_effects(ending, any(u.collides for u in same)),
                data={"uri": use.uri, "format": ending, "readers": who},
            )


def _select_effects(ending: str, collides: bool) -> list[str]:
    """Select the effects on meshes of a suffix, of which one may be a collision."""
    rejecting = find_rejecting_readers(ending, collides)
    keys = [key for key in _OF_FORMAT if key.partition(" (")[0] in rejecting]
    if ending == "ply" and collides:
        keys.append("pinocchio (collision in PLY)")
    if ending not in READ_BY["isaac"]:
        keys.append("isaac (not read)")
    return keys


@unsupported_mesh_format.fix(UNSAFE, writes_meshes=True)
def convert_ply_to_stl(problem: Problem, context: FixContext) -> Proposal | None:
    """Convert PLY files of collisions to new STL files, which have no colors to lose."""
    uses = [
        use
        for use in get_mesh_uses(context.robot, context.description)
        if use.uri.lower().endswith(f".{problem.data['format']}")
    ]
    if problem.data["format"] != "ply" or any(not (u.collides and u.exists) for u in uses):
        return None
    return _convert_to_stl(uses)


def _read_header(use: MeshUse) -> StlHeader | None:
    if use.path is None or not use.exists or get_suffix(use.uri) != "stl":
        return None
    try:
        return read_stl_facts(use.workspace, use.path)
    except OSError:
        return None


@memoize_by_workspace
def read_stl_facts(workspace: Workspace, path: Path) -> StlHeader:
    """Read the beginning of an STL file.

    Raises:
        OSError: The file cannot be read.
    """
    return read_stl_header(workspace.materialize(path))


@rule(
    INFO,
    raised={"mujoco": ERROR},
    effects={
        "mujoco": "rejects the file",
        "pybullet": "loads the link without the shape",
        "rviz": "does not load it: RViz reads binary STL only",
        "gz": "reads it",
        "pinocchio": "reads it",
    },
)
def ascii_stl(robot: Robot, description: Description) -> Iterator[Problem]:
    """An STL file is in the ASCII format.

    MuJoCo rejects ASCII STL; PyBullet and RViz show nothing. It is also about five times as large
    as binary STL and slow to read. Convert the file to binary STL.
    """
    keeps = keeps_visuals(robot)
    for use in _get_first_uses(robot, description):
        facts = _read_header(use)
        if facts is not None and facts.kind == "ascii":
            yield Problem(
                use.link,
                f"mesh '{use.uri}' is ASCII STL, which many readers reject; convert it",
                at=use.mesh.locate_attribute("filename"),
                effects=[*["mujoco"] * (keeps or use.collides), *_OF_TEXT],
                data={"uri": use.uri},
            )


@ascii_stl.fix(BOTH, writes_meshes=True)
def write_binary_stl(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the same triangles as binary STL.

    PyBullet cannot read ASCII STL, so the fix adds collision geometry there.
    """
    uses = find_existing_uses(problem, context)
    make = unsafe if any(use.collides for use in uses) else safe
    rewrites = rewrite_in_place(uses[:1], BINARY)
    return make("convert it to binary STL", *rewrites) if rewrites else None


@rule(
    INFO,
    effects={
        "rviz": (
            "reads it as binary; releases before Foxy 8.2.8, Humble 11.2.5 and Rolling 12.2.0 "
            "warn or reject it"
        ),
        "mujoco, pybullet, pinocchio": "read it as binary",
    },
    default=False,
)
def binary_stl_starts_with_solid(robot: Robot, description: Description) -> Iterator[Problem]:
    """A binary STL file begins with the word ``solid``.

    ASCII STL begins with that word. The 80 bytes of the binary header may hold any text, and about
    one exporter in fifteen writes ``solid``; readers that check only this word read the file as
    text and fail. Current readers of robots check more, so the rule is off by default.
    """
    found = [use for use in _get_first_uses(robot, description) if _begins_with_solid(use)]
    if found:
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        yield Problem(
            found[0].link,
            f"binary STL mesh '{found[0].uri}'{more} begins with 'solid', as ASCII STL does; "
            "overwrite the 80 bytes of its header",
            at=found[0].mesh.locate_attribute("filename"),
            data={"uris": [use.uri for use in found]},
        )


def _begins_with_solid(use: MeshUse) -> bool:
    """Tell whether a mesh is binary STL that begins with ``solid``."""
    facts = _read_header(use)
    return facts is not None and facts.kind == "binary" and facts.begins_with_solid


@binary_stl_starts_with_solid.fix(SAFE, writes_meshes=True)
def overwrite_first_word(problem: Problem, context: FixContext) -> Proposal | None:
    """Overwrite the first word of each file."""
    uses = get_mesh_uses(context.robot, context.description)
    rewrites = rewrite_in_place(filter(_begins_with_solid, uses), HEADED)
    return safe("overwrite the first word of the header", *rewrites) if rewrites else None


_UNIT = re.compile(rb"<unit\b[^<>]*?\bmeter\s*=\s*[\"']([^\"']+)[\"']")
_UP = re.compile(rb"<up_axis\s*>\s*(\w+)\s*<")


@rule(
    WARNING,
    effects={
        "rviz, pybullet (unit)": "apply the unit",
        "rviz, pybullet (both)": "apply the unit, but not the axis",
        "moveit (collision)": "applies neither",
    },
    formats=ANY_FORMAT,
    pedantic="robots in SDF, because Gazebo applies both",
)
def dae_unit_or_axis(
    robot: Robot, description: Description, *, together: float = 3
) -> Iterator[Problem]:
    """A COLLADA file is not in meters.

    A COLLADA file may declare its unit and its up axis. Readers treat both differently: the same
    mesh is a hundred or a thousand times larger in one reader than in another. Export the file in
    meters. An up axis other than z alone is not reported, because RViz, MoveIt, Gazebo, PyBullet
    and Pinocchio do not rotate the mesh. More than ``together`` meshes with the same unit and axis
    are one finding.
    """
    found: dict[tuple[tuple[str, str], ...], list[MeshUse]] = {}
    for use in _get_first_uses(robot, description):
        declared = describe_unit_and_axis(use)
        if "unit" in declared:
            found.setdefault(tuple(declared.items()), []).append(use)
    colliding = {use.uri for use in get_mesh_uses(robot, description) if use.collides}
    for facts, uses in found.items():
        several = len(uses) > together
        more = f" (and of {len(uses) - 1} more)" if several else ""
        what = " and ".join(text for _, text in facts)
        case = facts[0][0] if len(facts) == 1 else "both"
        for use in uses[:1] if several else uses:
            yield Problem(
                use.link,
                f"mesh '{use.uri}'{more}: {what}, which readers apply differently; "
                "export it in meters",
                at=use.mesh.locate_attribute("filename"),
                pedantic=robot.format == "sdf",
                effects=(
                    f"rviz, pybullet ({case})",
                    *(("moveit (collision)",) if use.uri in colliding else ()),
                ),
            )


def describe_unit_and_axis(use: MeshUse) -> dict[str, str]:
    """Describe the ``unit`` and ``axis`` of a COLLADA file that differ from meters and z up."""
    found: dict[str, str] = {}
    if use.path is None or not use.exists or get_suffix(use.uri) != "dae":
        return found
    try:
        with use.workspace.open(use.path) as file:
            head = file.read(16384)
    except OSError:
        return found
    unit, up = _UNIT.search(head), _UP.search(head)
    if unit and not _is_one(unit[1]):
        found["unit"] = f"the unit is {unit[1].decode('ascii', 'replace')} m"
    if up and up[1].upper() != b"Z_UP":
        found["axis"] = f"the up axis is {up[1].decode('ascii', 'replace')}"
    return found


def _is_one(text: bytes) -> bool:
    try:
        return abs(float(text) - 1) < 1e-6
    except ValueError:
        return True


@rule(
    INFO,
    raised={"mujoco": ERROR},
    effects={
        "mujoco, drake": "reject it",
        "pybullet, pinocchio": "read it",
    },
)
def dae_as_collision(robot: Robot, description: Description) -> Iterator[Problem]:
    """A collision mesh is a COLLADA file.

    Collision geometry does not need materials, lights and a scene tree, and readers treat units
    and axes of COLLADA differently. MuJoCo and Drake reject COLLADA. Convert the file to OBJ, which
    MuJoCo, Drake and PyBullet read.
    """
    uses = [
        u for u in get_mesh_uses(robot, description) if u.collides and get_suffix(u.uri) == "dae"
    ]
    if uses:
        count = len({use.uri for use in uses})
        more = f" (and {count - 1} more)" if count > 1 else ""
        yield Problem(
            uses[0].link,
            f"collision mesh '{uses[0].uri}'{more} is COLLADA, which MuJoCo and Drake reject; "
            "convert it to OBJ",
            at=uses[0].mesh.locate_attribute("filename"),
            data={"uris": list(dict.fromkeys(use.uri for use in uses))},
        )


@dae_as_collision.fix(UNSAFE, writes_meshes=True)
def convert_collada_to_stl(problem: Problem, context: FixContext) -> Proposal | None:
    """Convert COLLADA files to new STL files, if readers agree on their unit and axes."""
    uses = get_mesh_uses(context.robot, context.description)
    found = [use for use in uses if use.collides and use.uri.lower().endswith(".dae")]
    if any(not use.exists or describe_unit_and_axis(use) for use in found):
        return None
    return _convert_to_stl(found)


def _convert_to_stl(uses: list[MeshUse]) -> Proposal | None:
    """Write meshes as STL under unused names in their folders, and use these files."""
    changes: list[Change | FileRewrite] = []
    for use in uses:
        if use.path is None:
            return None
        for ending in (".stl", "_collision.stl"):
            new = write_new_file(use, use.path.stem + ending, BINARY)
            if new:
                break
        else:
            return None
        old = re.escape(os.path.splitext(use.uri)[1]) + r"(?=\s*$)"
        changes += [substitute(use.mesh.element, "filename", old, ending), *new]
    return unsafe("convert it to a new STL file", *dict.fromkeys(changes)) if changes else None
