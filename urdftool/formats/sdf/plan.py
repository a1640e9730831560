"""Decision which links stay links, and which become frames of another link.

Links that fixed joints connect form one rigid body. A fixed joint is *dissolved* if its two links
become one SDF link: every fixed joint when lumping, otherwise only if a link cannot stand alone,
because it has no mass or an inconsistent inertia. The link that stays is the *owner* of the others;
their shapes and sensors move to it, and their names become frames.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from ...mechanics.spatial_inertia import SpatialInertia, combine, link_inertia
from ...model.block_elements import list_part_elements
from ...model.elements import Joint, Link, Robot
from ...model.kinematics import link_poses
from ...model.pose import IDENTITY, Pose
from ..common.inertia_surplus import is_consistent
from ..common.lumping import LumpingPlan, plan_lumping

WORLD = "world"


@dataclass
class Plan:
    """The bodies of a robot.

    Attributes:
        owner: Owner of each link; the link itself if it stays.
        members: Links of each owner, in the order of the tree.
        dissolved: Names of fixed joints that become frames.
        kept: Names of fixed joints that stay because a sensor or setting requires it.
        in_owner: Pose of each link in its owner's frame.
        in_model: Pose of each link in the model's frame, with all joints at zero.
        mass: Combined mass properties of each owner and its members, in the owner's frame.
        alone: Owners whose mass properties are only their own.
        anchored: Whether the root is ``world``, which SDF does not represent as a link.
    """

    owner: dict[str, str] = field(default_factory=dict)
    members: dict[str, list[str]] = field(default_factory=dict)
    dissolved: set[str] = field(default_factory=set)
    kept: set[str] = field(default_factory=set)
    in_owner: dict[str, Pose] = field(default_factory=dict)
    in_model: dict[str, Pose] = field(default_factory=dict)
    mass: dict[str, SpatialInertia] = field(default_factory=dict)
    alone: set[str] = field(default_factory=set)
    anchored: bool = False

    def stays(self, link: str) -> bool:
        """Tell whether a link stays a link of the model."""
        return self.owner.get(link) == link


def make_plan(robot: Robot, *, lump: bool) -> Plan:
    """Decide for each link and fixed joint.

    Args:
        robot: A robot that is a tree, or several.
        lump: Dissolve every fixed joint that no sensor or setting keeps.
    """
    plan = Plan(anchored=any(root.name == WORLD for root in robot.tree.roots))
    links = [name for name in robot.tree.order if not (plan.anchored and name == WORLD)]
    known = set(links)
    plan.in_model = {name: pose for name, pose in link_poses(robot).items() if name in known}
    loose = _get_loose_joints(robot, plan)
    masses = {name: link_inertia(robot.link[name]) for name in links}
    for name in links:
        joint = loose.get(name)
        if joint is not None and (lump or not is_consistent(masses[name])):
            plan.dissolved.add(joint.name)
    if not lump:
        _dissolve_groups(robot, plan, loose, masses)
    _place(robot, plan, lump)
    _add_weigh(plan, masses)
    return plan


def _group(robot: Robot, plan: Plan) -> LumpingPlan:
    return plan_lumping(robot, plan.in_model, lambda joint: joint.name in plan.dissolved)


def _get_loose_joints(robot: Robot, plan: Plan) -> dict[str, Joint]:
    """Return the fixed joints that may be dissolved, by their child."""
    loose = {}
    for joint in robot.joints:
        if not joint.is_fixed or (plan.anchored and joint.parent == WORLD):
            continue
        if _senses_force(robot, joint) or joint.is_preserved:
            plan.kept.add(joint.name)
        else:
            loose[joint.child] = joint
    return loose


def _senses_force(robot: Robot, joint: Joint) -> bool:
    return any(
        element.tag == "sensor" and (element.get("type") or "").strip() == "force_torque"
        for element in list_part_elements(robot, joint)
    )


def _dissolve_groups(
    robot: Robot, plan: Plan, loose: dict[str, Joint], masses: dict[str, SpatialInertia]
) -> None:
    """Dissolve more fixed joints around each invalid group until its mass properties are valid."""
    links, poses = list(plan.in_model), plan.in_model
    groups = _group(robot, plan)
    group = groups.top

    def total(tops: set[str]) -> SpatialInertia:
        members = (n for top in tops for n in groups.members[top])
        if len(tops) > 1:  # in the order of the links
            members = (n for n in links if group[n] in tops)
        return combine(masses[n].transform(poses[n]) for n in members)

    for top in links:
        if group[top] != top or is_consistent(total({top})):
            continue
        tops, chosen = {top}, []
        while not is_consistent(total(tops)):
            joint = next(
                (j for c, j in loose.items() if (group[c] in tops) != (group[j.parent] in tops)),
                None,
            )
            if joint is None:
                break
            chosen.append(joint)
            tops |= {group[joint.child], group[joint.parent]}
        if is_consistent(total(tops)):
            plan.dissolved |= {joint.name for joint in chosen}
            groups = _group(robot, plan)
            group = groups.top


def _place(robot: Robot, plan: Plan, lump: bool) -> None:
    """Choose the owner of each group, and compute the pose of each link in its owner."""
    groups = _group(robot, plan)
    for top, members in groups.members.items():
        owner = next((n for n in members if robot.link[n].mass > 0), top) if not lump else top
        back = IDENTITY if owner == top else groups.pose[owner].invert()
        for name in members:
            plan.owner[name] = owner
            plan.in_owner[name] = IDENTITY if name == owner else back @ groups.pose[name]
        plan.members[owner] = members


def _add_weigh(plan: Plan, masses: dict[str, SpatialInertia]) -> None:
    for owner, members in plan.members.items():
        heavy = [n for n in members if masses[n].mass or any(masses[n].tensor)]
        if heavy in ([owner], []):
            plan.alone.add(owner)
            plan.mass[owner] = masses[owner]
        else:
            plan.mass[owner] = combine(masses[n].transform(plan.in_owner[n]) for n in heavy)


def get_links(plan: Plan, robot: Robot) -> list[Link]:
    """Return the links that stay, parents first."""
    return [robot.link[name] for name in plan.in_model if plan.stays(name)]
