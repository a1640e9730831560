"""Names of mesh files that some readers take for something else."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Robot
from ...source.description import Description
from ..fix import FixContext, Proposal
from ..mujoco import keeps_visuals
from ..rule import ERROR, INFO, UNSAFE, WARNING, Problem, rule
from .changes import propose_compiler
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
            )


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
        )
