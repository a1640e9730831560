"""Comparison of the exported robot with the source, check by check."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from ....compare.check import Check
from ....model.elements import Robot
from ....model.load import read_again
from ...common.force_fallbacks import drop_invalid_parts
from ...written import Written
from ..options import Options
from ..write import write
from .dynamics import compute_centroidal, compute_mass_matrix, compute_poses
from .excuses import Excuses, sort_excuses
from .flags import compare_base, compare_flags, compare_joint_physics
from .loader import run_loads
from .mechanism import Array, Hinge, Mechanism, invert_pose
from .others import compare_others
from .plugins import compare_plugins
from .reader import Frames, open_model, read_model
from .sensors import compare_sensors
from .shapes import compare_colors, compare_shapes
from .source import convert_mechanism, get_base, get_pose
from .surfaces import compare_contact, compare_looks, compare_surface
from .world import compare_world

CONFIGURATIONS = 20
FRAMES, MASSES, WEIGHTS, LIMITS, TOTALS = 1e-9, 1e-8, 1e-8, 1e-9, 1e-8
FLOOR = 1e-6
"""Lower bound of a joint's inertia for relative differences, as a fraction of the largest;
for a massless robot, differences are absolute: kg·m², kg, N·m or N.
"""
RAISED = 4e-12
"""Relative increase of moments that the exporter may apply for readers to accept a tensor."""


@dataclass
class Pair:
    """The source, the exported robot, and the mapping of names."""

    robot: Robot
    source: Mechanism
    made: Mechanism
    renamed: dict[tuple[str, str], str]
    excuses: Excuses
    options: Options
    where: Frames

    def link(self, name: str) -> str:
        """Return the exported name of a link, or of its frame."""
        return self.renamed.get(("link", name), name)

    def get_joint(self, name: str) -> str:
        """Return the exported name of a joint."""
        return self.renamed.get(("joint", name), name)

    def place(self, name: str) -> tuple[str, Array] | None:
        """Return the body that holds a link, and the link's pose in it; None for no such link.

        In a file without frames, this is the nearest body above over fixed joints.
        """
        inside = np.eye(4)
        while name in self.robot.link:
            found = self.made.frames.get(self.link(name))
            if found is not None:
                return found[0], found[1] @ inside
            joint = self.robot.tree.get_parent_joint(name)
            if joint is None or not joint.is_fixed:
                return None
            inside, name = get_pose(joint.origin) @ inside, joint.parent
        return None


def verify(robot: Robot, written: Written, options: Options, output: str | Path) -> list[Check]:
    """Read an export back and compare it with its source.

    Args:
        robot: The source.
        written: The export.
        options: Options of the export.
        output: Path of the exported file or folder.
    """
    place = Path(output) if options.file else Path(output) / written.main
    anew = read_again(robot)
    try:
        pair = pair_of(drop_invalid_parts(anew) if options.force else anew, written, place, options)
    except (ElementTree.ParseError, OSError, LookupError, StopIteration, ValueError) as error:
        return [Check("file", "can be read back", 0.0, differing=[f"{place}: {error!r}"])]
    checks = compare(pair)
    if options.world:
        checks.append(compare_world(pair, place))
    checks.append(_check_same_again(robot, written, options))
    loaded = run_loads(robot, options, place)
    return checks if loaded is None else [*checks, loaded]


def pair_of(robot: Robot, written: Written, place: Path, options: Options | None = None) -> Pair:
    """Convert both robots to mechanisms."""

    def find(uri: str) -> Path:
        return robot.source.resolve(uri) if robot.source is not None else Path(uri)

    where = open_model(place)
    made = read_model(where, place, find)
    excuses = sort_excuses(written.losses, robot)
    options = options or Options()
    source = convert_mechanism(robot, options.actuator_config)
    return Pair(robot, source, made, written.renamed, excuses, options, where)


def compare(pair: Pair) -> list[Check]:
    """Run all checks that need no external program."""
    checks = [_check_tree(pair), *_collect_motion(pair), _check_limits(pair)]
    configurations = list(_get_configurations(pair.source, 1))
    checks.append(compare_shapes(pair, "collisions", configurations))
    checks.append(compare_shapes(pair, "visuals", configurations))
    checks.append(compare_colors(pair))
    checks += [compare_base(pair), compare_contact(pair), compare_surface(pair)]
    checks += [compare_flags(pair), compare_joint_physics(pair), compare_looks(pair)]
    checks += [compare_sensors(pair), compare_plugins(pair), compare_others(pair)]
    return checks


def _get_configurations(source: Mechanism, count: int) -> list[dict[str, float]]:
    """Return joint positions: all zero, then random within limits, or within π rad or 1 m."""
    random = np.random.default_rng(0)
    result: list[dict[str, float]] = [{}]
    for _ in range(count):
        q = {}
        for joint in source.joints:
            if joint.moves:
                reach = np.pi if joint.kind == "revolute" else 1.0
                low, high = joint.limits["lower"], joint.limits["upper"]
                low = low if np.isfinite(low) else -reach
                high = high if np.isfinite(high) else reach
                q[joint.name] = float(random.uniform(min(low, high), max(low, high)))
        result.append(q)
    return result


def _check_tree(pair: Pair) -> Check:
    check = Check("tree", f"{len(pair.source.joints)} joints, types, links, leaders", 0.0)
    made = {joint.name: joint for joint in pair.made.joints}
    expected = [joint for joint in pair.source.joints if joint.kind not in ("fixed", "free")]
    for joint in expected:
        other = made.pop(pair.get_joint(joint.name), None)
        aspect, text = _get_tree_difference(pair, joint, other)
        if text:
            excused = joint.name in pair.excuses.motion or (
                aspect == "mimic" and joint.name in pair.excuses.mimic
            )
            (check.announced if excused else check.differing).append(f"{joint.name}: {text}")
    planar = {f"{name}{end}" for name in pair.excuses.motion for end in ("_x", "_y")}
    closing = {e.get("name") for b in pair.robot.gazebo for e in b.element.list_children("joint")}
    for name, other in made.items():
        if other.moves and name not in planar:
            said = name in closing or re.sub(r"_\d+$", "", name) in closing
            (check.announced if said else check.differing).append(f"{name}: not in the source")
    return check


def _get_tree_difference(pair: Pair, joint: Hinge, other: Hinge | None) -> tuple[str, str]:
    """Return the aspect in which a joint differs, and a description; empty texts if equal."""
    if other is None:
        return "joint", "is missing"
    if joint.kind != other.kind:
        return "kind", f"is {other.kind}, not {joint.kind}"
    for end in ("parent", "child"):
        name = getattr(joint, end)
        body = _get_body(pair, name)
        if body != getattr(other, end):
            return end, f"its {end} is '{getattr(other, end)}', not '{name}'"
    expected = joint.mimic and (pair.get_joint(joint.mimic[0]), *joint.mimic[1:])
    if expected != other.mimic:
        return "mimic", f"leader, multiplier and offset are {other.mimic}, not {expected}"
    return "", ""


def _get_body(pair: Pair, link: str) -> str:
    """Return the body that holds a link; without frames, the nearest above over fixed joints."""
    while pair.link(link) not in pair.made.frames:
        joint = pair.robot.tree.get_parent_joint(link)
        if joint is None or not joint.is_fixed:
            return "nothing"
        link = joint.parent
    return pair.made.frames[pair.link(link)][0]


def _collect_motion(pair: Pair) -> list[Check]:
    poses_seen = f"{CONFIGURATIONS + 1} configurations"
    frames = Check("frames", f"{len(pair.source.frames)} links, {poses_seen}", FRAMES)
    masses = Check("mass matrix", poses_seen, MASSES)
    weights = Check("gravity", f"{poses_seen}, required effort", WEIGHTS)
    totals = Check("whole", f"{poses_seen}, mass, center, inertia", TOTALS)
    orders = pair.source.sort_joints(), pair.made.sort_joints()
    present = {joint.name for joint in orders[1] if joint.moves}
    names = [j.name for j in orders[0] if j.moves and pair.get_joint(j.name) in present]
    for q in _get_configurations(pair.source, CONFIGURATIONS):
        renamed = {pair.get_joint(name): value for name, value in q.items()}
        here = compute_poses(pair.source, q, orders[0])
        there = compute_poses(pair.made, renamed, orders[1])
        base = _get_base(pair, there)
        there = {name: base @ pose for name, pose in there.items()}
        _compare_frames(pair, frames, here, there)
        one = compute_mass_matrix(pair.source, here, orders[0], names)
        two = compute_mass_matrix(
            pair.made, there, orders[1], [pair.get_joint(name) for name in names]
        )
        _compare_masses(pair, masses, weights, names, one, two)
        _compare_totals(pair, totals, here, there)
    return [frames, masses, weights, totals]


def _get_base(pair: Pair, there: dict[str, Array]) -> Array:
    """Return the transform of the exported robot's root to the identity, as in the source."""
    base = get_base(pair.robot)
    if base is None:
        return np.eye(4)
    body, inside = pair.made.frames.get(pair.link(base), ("world", np.eye(4)))
    return invert_pose(there[body] @ inside)


def _compare_frames(
    pair: Pair, check: Check, here: dict[str, Array], there: dict[str, Array]
) -> None:
    for name, (body, _) in pair.source.frames.items():
        found = pair.made.frames.get(pair.link(name))
        excused = name in pair.excuses.frames
        if found is None:
            check.compare(np.inf, f"{name} is missing", known=excused)
            continue
        off = float(np.abs(here[body] - there[found[0]] @ found[1]).max())
        check.compare(off, f"{name} is at another pose", known=excused)


def _compare_masses(
    pair: Pair,
    masses: Check,
    weights: Check,
    names: list[str],
    one: tuple[Array, Array],
    two: tuple[Array, Array],
) -> None:
    if not names:
        return
    hardest = float(np.diag(one[0]).max())
    diagonal = np.maximum(np.diag(one[0]), FLOOR * hardest if hardest > 0 else 1.0)
    scale = np.sqrt(np.outer(diagonal, diagonal))
    largest = max(float(np.abs(body.inertia).max()) for body in pair.source.bodies.values())
    off = np.maximum(np.abs(one[0] - two[0]) - RAISED * largest, 0.0) / scale
    total = sum(body.mass for body in pair.source.bodies.values())
    heaviest = max(float(np.abs(one[1]).max()), 1e-6 * total * 9.81, 0.0) or 1.0
    heavy = np.abs(one[1] - two[1]) / heaviest
    for row, name in enumerate(names):
        excused = name in pair.excuses.heavy
        masses.compare(float(off[row].max()), f"{name}: different inertia", known=excused)
        weights.compare(float(heavy[row]), f"{name}: different gravity force", known=excused)


def _compare_totals(
    pair: Pair, check: Check, here: dict[str, Array], there: dict[str, Array]
) -> None:
    one, two = compute_centroidal(pair.source, here), compute_centroidal(pair.made, there)
    if one[0] == 0.0:
        return
    size = max(float(np.abs(one[2]).max()), 1e-30)
    # tolerances: mass 1e-12, center of mass 1e-9 m; scaled to that of the row
    parts = {
        "mass": abs(one[0] - two[0]) / one[0] * 1e4,
        "center": float(np.abs(one[1] - two[1]).max()) * 10,
        "inertia": float(np.abs(one[2] - two[2]).max()) / size,
    }
    for what, off in parts.items():
        check.compare(off, f"{what} of the whole", known=pair.excuses.massy)


def _check_limits(pair: Pair) -> Check:
    check = Check("limits", "position, effort, velocity, damping, friction", LIMITS)
    made = {joint.name: joint for joint in pair.made.joints}
    for joint in pair.source.joints:
        other = made.get(pair.get_joint(joint.name))
        if not joint.moves or other is None or not other.moves:
            continue
        for name, value in joint.limits.items():
            found = other.limits[name]
            one, two = (np.sign(x) * np.inf if abs(x) >= 1e15 else x for x in (value, found))
            apart = np.inf if np.isinf(one) or np.isinf(two) else abs(one - two)
            off = 0.0 if one == two else apart / max(min(abs(one), 1e300), 1e-30)
            text = f"{joint.name}: {name} is {found:g}, not {value:g}"
            check.compare(float(off), text, known=joint.name in pair.excuses.limits)
    return check


def _check_same_again(robot: Robot, written: Written, options: Options) -> Check:
    check = Check("again", f"{len(written.files)} files, the same bytes", 0.0)
    again = write(robot, options)
    for name, content in written.files.items():
        if again.files.get(name) != content:
            check.differing.append(f"{name}: different bytes")
    return check
