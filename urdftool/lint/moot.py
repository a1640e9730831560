"""Removal of effects on readers that do not get the robot, or the part, for another defect."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from .. import rules
from ..finding import Finding
from ..model.elements import Collision, Mesh, Robot, UnknownShape, Visual
from ..model.mesh_formats import find_rejecting_readers, get_suffix
from ..rules.gazebo.lumped_model import find_kept_links, find_omitted_links, is_named_as_link
from ..rules.inertia.bodies import find_massless_pairs
from ..rules.inertia.massless import has_bare_moved_body
from ..rules.inertia.tensors import has_inertia_that_mujoco_rejects
from ..rules.mesh.mesh_uses import MeshUse, get_mesh_uses
from ..rules.mujoco import find_rejected_by_mujoco, get_assumed_package, keeps_visuals
from ..rules.package.resolution import is_in_own_package
from ..rules.rule import GAZEBO
from ..source.description import Description
from ..source.document import Element
from .effect_kinds import REJECTS

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

_OF_OMISSION = (
    "missing-inertial",
    "incomplete-inertial",
    "zero-mass",
    "massless-moving-body",
    "massless-root-body",
)
"""Rules that report links which Gazebo omits."""

_OF_GEOMETRY = ("collision", "mesh", "visual")
"""Families of rules about shapes."""

_IRREGULAR = {"have": "has", "do": "does", "are": "is", "go": "goes"}


class Rejections:
    """What readers do not get of one robot: all of it, with the rules that report it, or parts.

    Args:
        robot: The robot; None if it could not be read.
    """

    def __init__(self, robot: Robot | None) -> None:
        """Find the readers that reject the robot for what may be reported by no rule that is on."""
        self._by_reader: dict[str, set[str]] = {}
        self._omitted: frozenset[str] = frozenset()  # links that Gazebo omits
        self._omitted_joints: frozenset[str] = frozenset()
        self._without_shapes: set[str] = set()
        if robot is not None:
            self._add_massless(robot)
            if robot.xml is not None and has_undeclared_prefix(robot.xml):
                self._by_reader["newton"] = set()  # run with 1.8: its parser is ElementTree
            self._add_meshes(robot)
            self._add_missing_files(robot)

    def _add_massless(self, robot: Robot) -> None:
        """Add rejections that are reported by rules which are off for some targets."""
        kept = find_kept_links(robot)
        if kept is not None:
            rejecting = set() if kept else {"massless-root-body"}
            if any(is_named_as_link(robot, joint, kept) for joint in robot.joints):
                rejecting.add("link-joint-name-clash")
            if any(find_massless_pairs(robot)):
                rejecting.add("zero-mass")
            if kept:
                self._omitted = omitted = frozenset(find_omitted_links(robot, kept))
                self._omitted_joints = frozenset(j.name for j in robot.joints if j.child in omitted)
            if rejecting:
                self._by_reader.update((reader, set(rejecting)) for reader in GAZEBO)
        for reader in _find_rejecting_shapes_of_drake(robot):
            self._by_reader.setdefault(reader, set())
        if has_bare_moved_body(robot):
            self._by_reader["mujoco"] = {"massless-moving-body"}
        if has_inertia_that_mujoco_rejects(robot):
            self._by_reader.setdefault("mujoco", set()).add("singular-inertia")

    def _add_missing_files(self, robot: Robot) -> None:
        """Add readers that reject the robot, or its shapes, for a file that they do not find."""
        source = robot.source
        if source is None:
            return
        for use in get_mesh_uses(robot, source):
            lost = bool(use.missing_package) and not is_in_own_package(use, source)
            if lost or get_assumed_package(use, source) or _is_without_manifest(use, source):
                self._by_reader.setdefault("drake", set()).update(_OF_FILES)
                self._without_shapes.add("pinocchio")
            if lost:
                self._by_reader.setdefault("pybullet", set()).update(_OF_FILES)
            if use.path is not None and not use.exists:
                self._without_shapes.add("pinocchio")

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

    def add(self, rule: str, kinds: Mapping[str, str]) -> None:
        """Add the readers that reject the robot by the kinds of the effects of a finding."""
        for reader, kind in kinds.items():
            if kind == REJECTS:
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
            left = [reader for reader in readers if self._is_read_by(reader, finding)]
            if left:
                one = len(left) == 1 < len(readers)
                effects[", ".join(left)] = convert_to_singular(effect) if one else effect
        if effects == finding.effects:
            return finding
        return replace(finding, effects=effects, moot=not effects and not selected)

    def _is_read_by(self, reader: str, finding: Finding) -> bool:
        """Tell whether a reader gets what a finding is about, or the finding is about that.

        Shapes of a robot are not in pinocchio's model if one of their files is missing.
        """
        rule = finding.code
        if rule not in self._by_reader.get(reader, {rule}):
            return False
        if reader in GAZEBO and rule not in _OF_OMISSION:
            named = self._omitted_joints if finding.kind == "joint" else self._omitted
            if finding.name in named or (finding.owner or finding.name) in named:
                return False
        if reader in self._without_shapes and rule not in _OF_FILES:
            return rules.FAMILY_OF.get(rule) not in _OF_GEOMETRY
        return True


def _find_rejecting_shapes_of_drake(robot: Robot) -> set[str]:
    """Return the readers that reject shapes such as <drake:ellipsoid>, which no rule reports."""
    of_drake = [
        shape
        for _, shape in robot.shapes
        if isinstance(shape.geometry, UnknownShape) and shape.geometry.element.tag[:6] == "drake:"
    ]
    if not of_drake:
        return set()
    read = keeps_visuals(robot) or any(isinstance(shape, Collision) for shape in of_drake)
    return {"pybullet", "mujoco"} if read else {"pybullet"}


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


def _is_without_manifest(use: MeshUse, source: Description) -> bool:
    """Tell whether the package of a mesh is a folder that is known by its name alone."""
    scheme, _, rest = use.uri.partition("://")
    name = rest.partition("/")[0]
    if scheme != "package" or not use.exists or name in source.packages.named:
        return False
    known: dict[str, bool] = source.memo.get(_is_without_manifest, dict)
    if name not in known:
        known[name] = source.packages.find_by_manifest(name) is None
    return known[name]


def _has_flat_first_object(robot: Robot) -> bool:
    """Tell whether MuJoCo rejects a robot for a collision, an OBJ file of several objects.

    It reads the first object alone, and rejects one without a volume (run with MuJoCo 4.0).
    """
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
    return f"{verb}{colon}{space}{rest.replace(' and take ', ' and takes ')}"
