"""Names of mesh files that some readers take for something else."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator

from ...model.elements import Robot
from ...source.description import Description
from ..file_rewrites import COPIED
from ..fix import FixContext, Proposal, substitute, unsafe
from ..mujoco import keeps_visuals
from ..rule import ERROR, INFO, UNSAFE, WARNING, Problem, rule
from .changes import files_at, propose_compiler, write_beside
from .uris import malformation
from .uses import MeshUse, mesh_uses

APPLIES_TO = ("mesh",)


@rule(
    WARNING,
    effects={
        "mujoco, pybullet, pinocchio": "open a file with a blank in its name",
    },
)
def unsafe_file_name(robot: Robot, description: Description) -> Iterator[Problem]:
    """The name of a mesh file has a character that is special somewhere.

    ``#``, ``?`` and ``%`` mean something in a URI, letters beyond ASCII are encoded in several
    ways, and a blank ends a word.
    """
    told: set[str] = set()
    for use in mesh_uses(robot, description):
        if use.uri in told or malformation(use) or "${" in use.uri or "$(" in use.uri:
            continue
        told.add(use.uri)
        odd = sorted({c for c in use.uri if c in '#?%<>|*"' or c == " " or not c.isascii()})
        if odd:
            what = "a blank" if odd == [" "] else " ".join(f"'{c}'" for c in odd)
            yield Problem(
                use.link,
                f"mesh '{use.uri}' has {what} in its name; use letters, digits, _ and -",
                at=use.mesh.element.attribute_place("filename"),
                data={"uri": use.uri, "characters": odd},
            )


@unsafe_file_name.fix(UNSAFE, writes_meshes=True)
def copy_under_plain_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Copy the file to a plain name, and use the copy."""
    uses = files_at(problem, context)
    if not uses or uses[0].path is None:
        return None
    plain = unicodedata.normalize("NFKD", uses[0].path.name).encode("ascii", "ignore").decode()
    return _copy(uses, re.sub(r"[^\w.-]+", "_", plain, flags=re.ASCII))


def _copy(uses: list[MeshUse], name: str) -> Proposal | None:
    """Copy the file of a mesh to another name, and use the copy wherever the mesh is."""
    path = uses[0].path
    if path is None or not name or name == path.name or not uses[0].uri.endswith(path.name):
        return None
    new = write_beside(uses[0], name, COPIED)
    if not new:
        return None
    pattern = re.escape(path.name) + "$"
    changes = [substitute(use.mesh.element, "filename", pattern, name) for use in uses]
    return unsafe(f"copy it to '{name}' and name that", *changes, *new)


@rule(
    INFO,
    on=("mujoco",),
    effects={"mujoco": "cannot open package:// paths"},
)
def package_uri_unresolvable(robot: Robot, description: Description) -> Iterator[Problem]:
    """A robot for MuJoCo names meshes by package.

    MuJoCo does not know ROS packages. Its ``<mujoco><compiler meshdir="…" strippath="true"/>`` in
    the URDF drops the folders and looks for the files in one place; before 3.7 it drops them
    anyway.
    """
    for mujoco in robot.element.all("mujoco"):
        compiler = mujoco.child("compiler")
        if compiler is not None and {"meshdir", "strippath"} & compiler.attributes.keys():
            return
    for use in mesh_uses(robot, description):
        if use.uri.startswith("package://") and use.collides:
            yield Problem(
                use.link,
                f"MuJoCo cannot open '{use.uri}'; "
                'write <mujoco><compiler meshdir="…" strippath="true"/> into the robot',
                at=use.mesh.element.attribute_place("filename"),
                data={"uri": use.uri},
            )
            return


@package_uri_unresolvable.fix(UNSAFE)
def write_mesh_folder(problem: Problem, context: FixContext) -> Proposal | None:
    """Write MuJoCo's settings with the folder of the meshes."""
    return propose_compiler(context)


@rule(
    WARNING,
    raised={"mujoco": ERROR},
    on=("mujoco",),
    effects={
        "mujoco": "3.3 takes one file for both; 4.0 loads the two",
    },
)
def mesh_stem_collision(robot: Robot, description: Description) -> Iterator[Problem]:
    """Two mesh files have one name, but for their folders or endings.

    MuJoCo before 4.0 calls a mesh by the name of its file alone: ``visual/arm.stl`` and
    ``collision/arm.stl`` are both ``arm``. Visuals count where the robot's ``<compiler>`` keeps
    them.
    """
    all_of_them = keeps_visuals(robot)
    first: dict[str, str] = {}
    found: dict[str, MeshUse] = {}
    for use in mesh_uses(robot, description):
        if not (use.collides or all_of_them):
            continue  # MuJoCo drops visuals
        stem = use.uri.replace("\\", "/").rpartition("/")[2].rpartition(".")[0]
        other = first.setdefault(stem, use.uri)
        if stem and other != use.uri:
            found.setdefault(stem, use)
    if found:
        stem, use = next(iter(found.items()))
        more = f" (and {len(found) - 1} more pairs)" if len(found) > 1 else ""
        yield Problem(
            use.link,
            f"meshes '{first[stem]}' and '{use.uri}' are both '{stem}' to MuJoCo{more}; rename one",
            at=use.mesh.element.attribute_place("filename"),
            data={"uris": [first[stem], use.uri], "name": stem},
        )


@mesh_stem_collision.fix(UNSAFE, writes_meshes=True)
def copy_under_own_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Copy the second file to a name with that of its folder, and use the copy."""
    uses = files_at(problem, context)
    if not uses or uses[0].path is None:
        return None
    path = uses[0].path
    return _copy(uses, f"{path.stem}_{path.parent.name or 'mesh'}{path.suffix}")
