"""Removal of effects on readers that reject the robot for another defect."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable
from dataclasses import replace
from functools import cache
from pathlib import Path

from .. import rules
from ..finding import Finding
from ..model.elements import Collision, Mesh, Robot, Visual
from ..model.mesh_formats import find_rejecting_readers, get_suffix
from ..rules.gazebo.lumped_model import find_kept_links, is_named_as_link
from ..rules.inertia.massless import has_bare_moved_body
from ..rules.inertia.tensors import has_inertia_that_mujoco_rejects
from ..rules.mujoco import find_rejected_by_mujoco
from ..rules.rule import GAZEBO
from ..source.document import Element

_THROUGH_URDFDOM = ("pinocchio", "KDL", "robot_state_publisher", "rviz", "moveit", "check_urdf")
"""Readers based on urdfdom, which fail where it rejects a robot."""

_OF_FORMAT = ("unsupported-mesh-format", "dae-as-collision")
"""Rules that report what a format of meshes does."""

_OF_FILES = (
    "mesh-not-found",
    "mesh-case-mismatch",
    "malformed-uri",
    "package-not-found",
    "absolute-path",
    "package-uri-unresolvable",
    "wrong-package-in-uri",
    "unsupported-uri-scheme",
    "mesh-without-filename",
)
"""Rules that report files which a reader does not find."""

_IRREGULAR = {"have": "has", "do": "does", "are": "is", "go": "goes"}


@cache
def _read_table() -> dict[str, dict[str, list[str]]]:
    """Return the readers that reject a file, by rule and key of the effect."""
    path = Path(rules.__file__).with_name("effect_rejections.json")
    found: dict[str, dict[str, list[str]]] = json.loads(path.read_text("utf-8"))
    return found


class Rejections:
    """Readers that reject one robot, with the rules that report it.

    Args:
        robot: The robot; None if it could not be read.
    """

    def __init__(self, robot: Robot | None) -> None:
        """Read which effects are rejections, as recorded by ``python -m tests.effects``."""
        self._table = _read_table()
        self._by_reader: dict[str, set[str]] = {}
        if robot is not None:
            self._add_massless(robot)
            if robot.xml is not None and has_undeclared_prefix(robot.xml):
                self._by_reader["newton"] = set()  # run with 1.8: its parser is ElementTree
            self._add_meshes(robot)

    def _add_massless(self, robot: Robot) -> None:
        """Add rejections that are reported by rules which are off for some targets."""
        kept = find_kept_links(robot)
        if kept is not None:
            rejecting = set() if kept else {"massless-root-body"}
            if any(is_named_as_link(robot, joint, kept) for joint in robot.joints):
                rejecting.add("link-joint-name-clash")
            if rejecting:
                self._by_reader.update((reader, set(rejecting)) for reader in GAZEBO)
        if has_bare_moved_body(robot):
            self._by_reader["mujoco"] = {"massless-moving-body"}
        if has_inertia_that_mujoco_rejects(robot):
            self._by_reader.setdefault("mujoco", set()).add("singular-inertia")

    def _add_meshes(self, robot: Robot) -> None:
        """Add rejections for the format of a mesh, for any targets."""
        formats: set[tuple[str, bool]] = set()
        for link in robot.links:
            shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
            for shape in shapes:
                if isinstance(shape.geometry, Mesh):
                    ending = get_suffix(shape.geometry.filename)
                    formats.add((ending, isinstance(shape, Collision)))
        if ("obj", True) in formats and _has_flat_first_object(robot):
            self._by_reader.setdefault("mujoco", set())
        source = robot.source
        if formats and source is not None and find_rejected_by_mujoco(robot, source):
            self._by_reader.setdefault("mujoco", set()).update(_OF_FILES)
        for ending, collides in formats:
            for reader in find_rejecting_readers(ending, collides):
                self._by_reader.setdefault(reader, set()).update(_OF_FORMAT)

    def add(self, rule: str, keys: Iterable[str]) -> None:
        """Add the rejections among the effects of a finding."""
        known = self._table.get(rule)
        if not known:
            return
        for key in keys:
            for reader in known.get(key, ()):
                others = _THROUGH_URDFDOM if reader == "urdfdom" else ()
                for one in (reader, *others):
                    self._by_reader.setdefault(one, set()).add(rule)

    def list_rejecting(self, found: Collection[str]) -> dict[str, tuple[str, ...]]:
        """List the rules that reject the robot, by reader, without readers based on urdfdom."""
        return {
            reader: tuple(sorted(rules & set(found)))
            for reader, rules in sorted(self._by_reader.items())
            if reader not in _THROUGH_URDFDOM and rules & set(found)
        }

    def remove_moot_effects(self, finding: Finding, *, selected: bool = False) -> Finding:
        """Remove the readers from a finding that reject the robot only for other defects.

        Args:
            finding: The finding.
            selected: Whether the user selected rules, and so is shown all that they find.

        Returns:
            The finding; moot if it had effects and has none left.
        """
        effects = {}
        for key, effect in finding.effects.items():
            readers = key.split(", ")
            left = [r for r in readers if finding.code in self._by_reader.get(r, {finding.code})]
            if left:
                one = len(left) == 1 < len(readers)
                effects[", ".join(left)] = convert_to_singular(effect) if one else effect
        if effects == finding.effects:
            return finding
        return replace(finding, effects=effects, moot=not effects and not selected)


def has_undeclared_prefix(element: Element, declared: frozenset[str] = frozenset()) -> bool:
    """Tell whether an element or one below it has a name with a prefix that nothing declares.

    Args:
        element: An element.
        declared: Prefixes that elements above it declare.
    """
    todo = [(element, declared | {"xml", "xmlns"})]
    for one, known in todo:  # the loop appends to this list
        prefixes = [name[6:] for name in one.attributes if name.startswith("xmlns:")]
        inside = known.union(prefixes) if prefixes else known
        for name in (one.tag, *one.attributes):
            if ":" in name and name.partition(":")[0] not in inside:
                return True
        todo += ((child, inside) for child in one.children)
    return False


def _has_flat_first_object(robot: Robot) -> bool:
    """Tell whether MuJoCo rejects a robot for a collision, an OBJ file of several objects.

    It reads the first object alone, and rejects one without a volume (run with MuJoCo 4.0).
    """
    from ..rules.mesh.mesh_uses import get_mesh_uses
    from ..rules.mesh.obj_objects import is_first_object_flat

    if robot.source is None:
        return False
    return any(
        use.path is not None and use.exists and is_first_object_flat(use.workspace, use.path)
        for use in get_mesh_uses(robot, robot.source)
        if use.collides and get_suffix(use.uri) == "obj"
    )


def convert_to_singular(effect: str) -> str:
    """Return an effect for one reader instead of several: ``take it`` becomes ``takes it``."""
    verb, space, rest = effect.partition(" ")
    verb, colon = (verb[:-1], ":") if verb.endswith(":") else (verb, "")
    if verb in _IRREGULAR:
        verb = _IRREGULAR[verb]
    elif verb.endswith(("s", "sh", "ch", "x")):
        verb += "es"
    elif verb.endswith("y") and not verb.endswith(("ay", "ey", "oy")):
        verb = verb[:-1] + "ies"
    else:
        verb += "s"
    return f"{verb}{colon}{space}{rest}"
