"""Check names of mesh files that some readers misinterpret."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator

from ...model.elements import Robot
from ...source.description import Description
from ..file_rewrites import COPIED
from ..fix import FixContext, Proposal, substitute, unsafe
from ..mujoco import keeps_visuals
from ..rule import UNSAFE, WARNING, Problem, rule
from .changes import find_existing_uses, propose_compiler, write_new_file
from .mesh_uses import MeshUse, get_mesh_uses
from .uris import find_malformation

APPLIES_TO = ("mesh",)


@rule(
    WARNING,
    effects={
        "mujoco, pybullet, pinocchio": "open a file with a space in its name",
    },
)
def unsafe_file_name(robot: Robot, description: Description) -> Iterator[Problem]:
    """The name of a mesh file has a special or non-ASCII character.

    ``#``, ``?`` and ``%`` have a meaning in URIs, non-ASCII letters are encoded in several ways,
    and a space separates words. Some tools then do not find the file.
    """
    seen: set[str] = set()
    for use in get_mesh_uses(robot, description):
        if use.uri in seen or find_malformation(use) or "${" in use.uri or "$(" in use.uri:
            continue
        seen.add(use.uri)
        odd = sorted({c for c in use.uri if c in '#?%<>|*"' or c == " " or not c.isascii()})
        if odd:
            what = "a space" if odd == [" "] else " ".join(f"'{c}'" for c in odd)
            yield Problem(
                use.link,
                f"mesh '{use.uri}' has {what} in its name; use letters, digits, _ and -",
                at=use.mesh.locate_attribute("filename"),
                data={"uri": use.uri, "characters": odd},
            )


@unsafe_file_name.fix(UNSAFE, writes_meshes=True)
def copy_under_plain_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Copy the file to a name of plain ASCII characters, and use the copy."""
    uses = find_existing_uses(problem, context)
    if not uses or uses[0].path is None:
        return None
    plain = unicodedata.normalize("NFKD", uses[0].path.name).encode("ascii", "ignore").decode()
    return _copy(uses, re.sub(r"[^\w.-]+", "_", plain, flags=re.ASCII))


def _copy(uses: list[MeshUse], name: str) -> Proposal | None:
    """Copy the file of a mesh to another name, and use the copy in all places."""
    path = uses[0].path
    if path is None or not name or name == path.name or not uses[0].uri.endswith(path.name):
        return None
    new = write_new_file(uses[0], name, COPIED)
    if not new:
        return None
    pattern = re.escape(path.name) + "$"
    changes = [substitute(use.mesh.element, "filename", pattern, name) for use in uses]
    return unsafe(f"copy the file to '{name}' and use the copy", *changes, *new)


@rule(
    WARNING,
    on=("mujoco",),
    effects={"mujoco": "cannot open package:// paths"},
)
def package_uri_unresolvable(robot: Robot, description: Description) -> Iterator[Problem]:
    """A robot for MuJoCo has package:// URIs of meshes.

    MuJoCo does not resolve ROS packages. Add ``<mujoco><compiler meshdir="…" strippath="true"/>``
    to the URDF: MuJoCo then removes the folders of the URIs and searches the files in ``meshdir``.
    Before 3.7, MuJoCo always removes the folders.
    """
    for mujoco in robot.element.list_children("mujoco"):
        compiler = mujoco.find_child("compiler")
        if compiler is not None and {"meshdir", "strippath"} & compiler.attributes.keys():
            return
    for use in get_mesh_uses(robot, description):
        if use.uri.startswith("package://") and use.collides:
            yield Problem(
                use.link,
                f"MuJoCo cannot open '{use.uri}'; "
                'add <mujoco><compiler meshdir="…" strippath="true"/> to the robot',
                at=use.mesh.locate_attribute("filename"),
                data={"uri": use.uri},
            )
            return


@package_uri_unresolvable.fix(UNSAFE)
def write_mesh_folder(problem: Problem, context: FixContext) -> Proposal | None:
    """Write MuJoCo's settings with the folder of the meshes."""
    return propose_compiler(context)


@rule(
    WARNING,
    on=("mujoco",),
    effects={
        "mujoco": "3.3 uses one file for both; 4.0 loads both files",
    },
)
def mesh_stem_collision(robot: Robot, description: Description) -> Iterator[Problem]:
    """Two mesh files have the same name in different folders or formats.

    MuJoCo before 4.0 identifies a mesh by its file name without folder and suffix:
    ``visual/arm.stl`` and ``collision/arm.stl`` are both ``arm``, and one file replaces the other.
    Visuals count only if the robot's ``<compiler>`` keeps them.
    """
    with_visuals = keeps_visuals(robot)
    first: dict[str, str] = {}
    found: dict[str, MeshUse] = {}
    for use in get_mesh_uses(robot, description):
        if not (use.collides or with_visuals):
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
            f"MuJoCo names both meshes '{first[stem]}' and '{use.uri}' '{stem}'{more}; rename one",
            at=use.mesh.locate_attribute("filename"),
            data={"uris": [first[stem], use.uri], "name": stem},
        )


@mesh_stem_collision.fix(UNSAFE, writes_meshes=True)
def copy_under_own_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Copy the second file to a name that includes its folder, and use the copy."""
    uses = find_existing_uses(problem, context)
    if not uses or uses[0].path is None:
        return None
    path = uses[0].path
    return _copy(uses, f"{path.stem}_{path.parent.name or 'mesh'}{path.suffix}")
