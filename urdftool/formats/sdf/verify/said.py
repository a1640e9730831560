"""Contents of ``<gazebo>`` blocks for links, joints and the robot, read from the description."""

from __future__ import annotations

from collections.abc import Iterator

from ....model.elements import Joint, Link, Robot
from ....source.document import Element
from .facts import Facts, get_facts, get_value

OF_COLLISIONS = {
    "mu1": "surface/friction/ode/mu",
    "mu2": "surface/friction/ode/mu2",
    "fdir1": "surface/friction/ode/fdir1",
    "kp": "surface/contact/ode/kp",
    "kd": "surface/contact/ode/kd",
    "maxVel": "surface/contact/ode/max_vel",
    "minDepth": "surface/contact/ode/min_depth",
    "maxContacts": "max_contacts",
    "laserRetro": "laser_retro",
}
"""SDF paths of a link's tags that apply to each of its collisions."""

OF_LINKS = {
    "selfCollide": ("self_collide",),
    "turnGravityOff": ("gravity",),
    "dampingFactor": ("velocity_decay/linear", "velocity_decay/angular"),
    "gravity": ("gravity",),
    "self_collide": ("self_collide",),
    "enable_wind": ("enable_wind",),
    "kinematic": ("kinematic",),
    "must_be_base_link": ("must_be_base_link",),
}
"""SDF paths of a link's tags that apply to the link."""

OF_JOINTS = {
    "stopCfm": ("physics/ode/limit/cfm",),
    "stopErp": ("physics/ode/limit/erp",),
    "fudgeFactor": ("physics/ode/fudge_factor",),
    "implicitSpringDamper": ("physics/ode/implicit_spring_damper", "physics/ode/cfm_damping"),
    "cfmDamping": ("physics/ode/implicit_spring_damper", "physics/ode/cfm_damping"),
    "provideFeedback": ("physics/provide_feedback",),
    "springStiffness": ("axis/dynamics/spring_stiffness",),
    "springReference": ("axis/dynamics/spring_reference",),
}
"""SDF paths of a joint's tags."""

LUMPING = frozenset(("preserveFixedJoint", "disableFixedJointLumping"))
NOWHERE = frozenset(("canonicalBody",))


def list_elements(robot: Robot, part: Link | Joint) -> Iterator[Element]:
    """Yield the elements in the blocks of a link or joint.

    If a link and a joint share a name, each gets the elements of its kind.
    """
    shared = part.name in robot.link and part.name in robot.joint
    for block in robot.gazebo:
        if block.element.get("reference") != part.name:
            continue
        for element in block.element.children:
            of_joint = element.tag in OF_JOINTS.keys() | LUMPING or (
                element.tag == "sensor" and (element.get("type") or "").strip() == "force_torque"
            )
            if not shared or of_joint == isinstance(part, Joint):
                yield element


def list_elements_of_whole(robot: Robot) -> Iterator[Element]:
    """Yield the elements in blocks without reference."""
    for block in robot.gazebo:
        if not block.element.get("reference"):
            yield from block.element.children


def get_text(element: Element) -> str:
    """Return the value of an element, from its attribute ``value`` or its text."""
    return (element.get("value") or element.text).strip()


def get_expected_surface(robot: Robot, link: Link) -> Facts:
    """Return the properties of each collision of a link, other than its shape."""
    facts: Facts = {}
    for element in list_elements(robot, link):
        if element.tag in OF_COLLISIONS:
            facts[OF_COLLISIONS[element.tag]] = get_value(get_text(element))
    for element in list_elements(robot, link):
        if element.tag == "collision":
            facts.update(get_facts(element))
    return facts


def get_expected_flags(robot: Robot, link: Link) -> Facts:
    """Return the flags of a link."""
    facts: Facts = {}
    plain: Facts = {}
    for element in list_elements(robot, link):
        if element.tag == "turnGravityOff":
            facts["gravity"] = (0.0,) if get_value(get_text(element)) == (1.0,) else (1.0,)
        elif element.tag in ("selfCollide", "dampingFactor"):
            for path in OF_LINKS[element.tag]:
                facts[path] = get_value(get_text(element))
        elif element.tag in OF_LINKS:
            plain[element.tag] = get_value(get_text(element))
        elif element.tag == "velocity_decay":
            plain.update({f"velocity_decay/{p}": v for p, v in get_facts(element).items()})
    return {**facts, **plain}


def get_expected_joint_physics(robot: Robot, joint: Joint) -> Facts:
    """Return the properties of a joint, other than its own axis and limits."""
    facts: Facts = {}
    for element in list_elements(robot, joint):
        for path in OF_JOINTS.get(element.tag, ()):
            facts[path] = get_value(get_text(element))
        if element.tag in ("physics", "axis", "axis2"):
            facts.update({f"{element.tag}/{p}": v for p, v in get_facts(element).items()})
    return facts
