"""Friction, contact, springs and flags, which URDF itself does not have, as tables.

One row is one setting: how SDF names it, which tags of ``<gazebo>`` and of Bullet's ``<contact>``
set it, and what MJCF and USD have instead. A reader fills ``Collision.surface``, ``Link.settings``
and ``Joint.settings`` with ``read_settings.py`` or values of its own, writers write them, and
the comparison compares them. A new setting is a new row.

Of the tags in ``<gazebo>``, the last one in the file counts, in any block; a tag counts before an
element of SDF in a block, and both count before ``<contact>``. libsdformat 12.3 does so, as
``fixtures/effects/gazebo.yaml`` records; it rejects a file with a negative friction.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from ..source.document import Element
from .numbers import number, parse_numbers
from .part import Part

Content = float | bool | tuple[float, ...] | str


class Setting(NamedTuple):
    """A row of a table.

    Attributes:
        name: Name in the model.
        kind: ``number``, ``count`` (a whole number), ``vector`` (three numbers), ``list`` (several
            numbers), ``color`` (red, green, blue, and alpha, 1 by default), ``flag`` or ``text``.
        unit: Unit of the value; empty for none.
        path: Path of the SDF element below the collision, link or joint.
        default: What SDF's specification says where it is not written.
        tags: Tags in ``<gazebo>`` that set it.
        opposite: Tag in ``<gazebo>`` that sets a flag to its opposite.
        contact: Child of Bullet's ``<contact>`` of a link that sets it.
        lowest: Smallest value that readers accept; None for no bound.
        range: Smallest and largest value that make sense, if readers take others, too.
        mjcf: What MJCF has instead; empty for nothing.
        usd: What USD has instead; empty for nothing.
        also: A second SDF path with the value, which older readers use.
        note: Additional note for the page of the mapping.
    """

    name: str
    kind: str
    unit: str
    path: str
    default: Content
    tags: tuple[str, ...] = ()
    opposite: str = ""
    contact: str = ""
    lowest: float | None = None
    range: tuple[float, float] = (-float("inf"), float("inf"))
    mjcf: str = ""
    usd: str = ""
    also: str = ""
    note: str = ""


_ODE = "surface/friction/ode/"
_CONTACT = "surface/contact/ode/"
_LIMIT = "physics/ode/limit/"
_DAMPER = "physics/ode/cfm_damping"
_POSITIVE, _PART = (0.0, float("inf")), (0.0, 1.0)

SURFACE = (
    Setting("friction", "number", "", _ODE + "mu", 1.0, ("mu1",), contact="lateral_friction",
            lowest=0.0, mjcf="geom friction", usd="physics:dynamicFriction"),
    Setting("second_friction", "number", "", _ODE + "mu2", 1.0, ("mu2",), lowest=0.0,
            contact="lateral_friction", mjcf="geom friction", usd="physics:dynamicFriction"),
    Setting("friction_direction", "vector", "", _ODE + "fdir1", (0.0, 0.0, 0.0), ("fdir1",),
            note="in the frame of the collision"),
    Setting("slip", "number", "", _ODE + "slip1", 0.0, range=_POSITIVE),
    Setting("second_slip", "number", "", _ODE + "slip2", 0.0, range=_POSITIVE),
    Setting("torsional_friction", "number", "", "surface/friction/torsional/coefficient", 1.0),
    Setting("restitution", "number", "", "surface/bounce/restitution_coefficient", 0.0,
            range=_PART, contact="restitution", usd="physics:restitution"),
    Setting("bounce_velocity", "number", "m/s", "surface/bounce/threshold", 100000.0),
    Setting("contact_stiffness", "number", "N/m", _CONTACT + "kp", 1e12, ("kp",),
            range=_POSITIVE, contact="stiffness"),
    Setting("contact_damping", "number", "N·s/m", _CONTACT + "kd", 1.0, ("kd",),
            range=_POSITIVE, contact="damping"),
    Setting("correction_velocity", "number", "m/s", _CONTACT + "max_vel", 0.01, ("maxVel",)),
    Setting("contact_depth", "number", "m", _CONTACT + "min_depth", 0.0, ("minDepth",)),
    Setting("contact_cfm", "number", "", _CONTACT + "soft_cfm", 0.0, range=_POSITIVE),
    Setting("contact_erp", "number", "", _CONTACT + "soft_erp", 0.2, range=_PART),
    Setting("collide_bitmask", "count", "", "surface/contact/collide_bitmask", 65535.0),
    Setting("category_bitmask", "count", "", "surface/contact/category_bitmask", 65535.0),
    Setting("without_contact", "flag", "", "surface/contact/collide_without_contact", False),
    Setting("bitmask_without_contact", "count", "",
            "surface/contact/collide_without_contact_bitmask", 1.0),
    Setting("max_contacts", "count", "", "max_contacts", 10.0, ("maxContacts",)),
    Setting("laser_retro", "number", "", "laser_retro", 0.0, ("laserRetro",),
            note="for gz in each visual too, where its lidar looks"),
)  # fmt: skip
"""Settings of a collision. A tag of its link in ``<gazebo>`` applies to each of its collisions."""

OF_LINKS = (
    Setting("gravity", "flag", "", "gravity", True, opposite="turnGravityOff",
            mjcf="body gravcomp"),
    Setting("self_collide", "flag", "", "self_collide", False, ("selfCollide",)),
    Setting("linear_decay", "number", "", "velocity_decay/linear", 0.0, ("dampingFactor",),
            range=_POSITIVE),
    Setting("angular_decay", "number", "", "velocity_decay/angular", 0.0, ("dampingFactor",),
            range=_POSITIVE),
    Setting("wind", "flag", "", "enable_wind", False),
    Setting("kinematic", "flag", "", "kinematic", False),
    Setting("must_be_base_link", "flag", "", "must_be_base_link", False),
)  # fmt: skip
"""Settings of a link."""

OF_JOINTS = (
    Setting("spring_stiffness", "number", "N·m/rad or N/m", "axis/dynamics/spring_stiffness", 0.0,
            ("springStiffness",), range=_POSITIVE, mjcf="joint stiffness"),
    Setting("spring_reference", "number", "rad or m", "axis/dynamics/spring_reference", 0.0,
            ("springReference",), mjcf="joint springref"),
    Setting("limit_stiffness", "number", "N·m/rad or N/m", "axis/limit/stiffness", 1e8),
    Setting("limit_dissipation", "number", "N·m·s/rad or N·s/m", "axis/limit/dissipation", 1.0),
    Setting("stop_cfm", "number", "", _LIMIT + "cfm", 0.0, ("stopCfm",), range=_POSITIVE),
    Setting("stop_erp", "number", "", _LIMIT + "erp", 0.2, ("stopErp",), range=_PART),
    Setting("fudge_factor", "number", "", "physics/ode/fudge_factor", 0.0, ("fudgeFactor",)),
    Setting("implicit_spring_damper", "flag", "", "physics/ode/implicit_spring_damper", False,
            ("implicitSpringDamper", "cfmDamping"), also=_DAMPER),
    Setting("provide_feedback", "flag", "", "physics/provide_feedback", False,
            ("provideFeedback",)),
    Setting("preserved", "flag", "", "", False, ("preserveFixedJoint",)),
    Setting("not_lumped", "flag", "", "", False, ("disableFixedJointLumping",)),
)  # fmt: skip
"""Settings of a joint; the last two keep a fixed joint, and SDF does not have them."""

OF_ROBOT = (
    Setting("static", "flag", "", "static", False, ("static",)),
    Setting("self_collide", "flag", "", "self_collide", False),
    Setting("wind", "flag", "", "enable_wind", False),
    Setting("may_sleep", "flag", "", "allow_auto_disable", True),
)
"""Settings of the whole robot, in blocks without a reference."""

SURFACE_OF_MUJOCO = (
    Setting("contype", "count", "", "", 1.0, mjcf="geom contype"),
    Setting("conaffinity", "count", "", "", 1.0, mjcf="geom conaffinity"),
    Setting("spinning_friction", "number", "m", "", 0.005, mjcf="geom friction"),
    Setting("rolling_friction", "number", "m", "", 0.0001, mjcf="geom friction"),
    Setting("condim", "count", "", "", 3.0, mjcf="geom condim"),
    Setting("priority", "count", "", "", 0.0, mjcf="geom priority"),
    Setting("margin", "number", "m", "", 0.0, mjcf="geom margin"),
    Setting("gap", "number", "m", "", 0.0, mjcf="geom gap"),
    Setting("solmix", "number", "", "", 1.0, mjcf="geom solmix"),
    Setting("solref", "list", "", "", (0.02, 1.0), mjcf="geom solref"),
    Setting("solimp", "list", "", "", (0.9, 0.95, 0.001, 0.5, 2.0), mjcf="geom solimp"),
)
"""Settings of a collision that only MuJoCo has, with its defaults."""

LINKS_OF_MUJOCO = (Setting("gravity_compensation", "number", "", "", 0.0, mjcf="body gravcomp"),)
"""Settings of a link that only MuJoCo has: the part of its weight that is carried."""

JOINTS_OF_MUJOCO = (
    Setting("limit_solref", "list", "", "", (0.02, 1.0), mjcf="joint solreflimit"),
    Setting("limit_solimp", "list", "", "", (0.9, 0.95, 0.001, 0.5, 2.0),
            mjcf="joint solimplimit"),
    Setting("limit_margin", "number", "rad or m", "", 0.0, mjcf="joint margin"),
    Setting("friction_solref", "list", "", "", (0.02, 1.0), mjcf="joint solreffriction"),
    Setting("friction_solimp", "list", "", "", (0.9, 0.95, 0.001, 0.5, 2.0),
            mjcf="joint solimpfriction"),
    Setting("actuator_gravity_compensation", "flag", "", "", False, mjcf="joint actuatorgravcomp"),
)  # fmt: skip
"""Settings of a joint that only MuJoCo has, with its defaults."""

TABLES = (SURFACE, OF_LINKS, OF_JOINTS)
ALL_SURFACE, ALL_OF_LINKS, ALL_OF_JOINTS = (
    SURFACE + SURFACE_OF_MUJOCO, OF_LINKS + LINKS_OF_MUJOCO, OF_JOINTS + JOINTS_OF_MUJOCO
)  # fmt: skip

SURFACE_TAGS = frozenset(tag for row in SURFACE for tag in row.tags)
"""Tags in ``<gazebo>`` that apply to each collision of a link."""

LINK_TAGS = SURFACE_TAGS | {
    tag for row in OF_LINKS for tag in (*row.tags, row.opposite, row.path.partition("/")[0]) if tag
}
"""Tags in ``<gazebo>`` that set a link or its collisions."""

JOINT_TAGS = frozenset(tag for row in OF_JOINTS if row.path for tag in row.tags)
"""Tags in ``<gazebo>`` that set a joint of SDF."""

LUMPING_TAGS = frozenset(tag for row in OF_JOINTS if not row.path for tag in row.tags)
"""Tags of a fixed joint that prevent its lumping; the joint stays fixed, also with the second."""

_OPPOSITES = {row.opposite for row in OF_LINKS} - {""}
_HEXADECIMAL = re.compile("0[xX][0-9a-fA-F]{1,8}")
"""Whole numbers of SDF, such as bit masks, which libsdformat 12.3 also reads as hexadecimal."""

_TRUE = frozenset(("true", "yes", "1"))
_FALSE = frozenset(("false", "no", "0"))


@dataclass(slots=True)
class Value(Part):
    """Value of a setting.

    Attributes:
        content: The value, in the unit of its row.
        earlier: Other values that the same setting had before in the file.
    """

    content: Content = 0.0
    earlier: tuple[Value, ...] = ()

    @property
    def written(self) -> Content:
        """Return what the element says: the opposite of the content of ``turnGravityOff``."""
        return self.content if self.tag not in _OPPOSITES else not self.content


Settings = dict[str, Value]
"""Values by the names of their rows."""


@dataclass(slots=True)
class Rejected(Part):
    """Element of a setting whose text is not a value.

    Attributes:
        kind: ``link``, ``joint``, ``robot``, ``sensor`` or ``closed loop``.
        name: Name of that part.
        tag: Tag of the element, or what of it is wrong.
        text: Its text.
        required: What it has to be.
    """

    kind: str = ""
    name: str = ""
    tag: str = ""
    text: str = ""
    required: str = ""

    @property
    def message(self) -> str:
        """Return what is wrong and what would be right, in one sentence."""
        known = f"{self.kind} '{self.name}': {self.tag}"
        return f"{known} is '{self.text}', not {self.required}; it is ignored"


def get_text(element: Element) -> str:
    """Return the value of an element as text: its attribute ``value``, or its content."""
    return (element.get("value") or element.text).strip()


def is_true(text: str | None) -> bool:
    """Tell whether sdformat reads a flag as true."""
    return text is not None and text.strip().lower() in _TRUE


def is_false(text: str | None) -> bool:
    """Tell whether sdformat reads a flag as false."""
    return text is not None and text.strip().lower() in _FALSE


def parse(kind: str, text: str) -> Content | None:
    """Return the value of a text; None if it has not the kind that a row requires."""
    if kind == "flag":
        return is_true(text) if is_true(text) or is_false(text) else None
    if kind == "text":
        return text
    if kind == "vector":
        return parse_numbers(text, 3)
    if kind == "color":
        return parse_numbers(text, 4) or parse_numbers(f"{text} 1", 4)
    if kind == "list":
        return parse_numbers(text, len(text.split()))
    if kind == "count" and _HEXADECIMAL.fullmatch(text):
        return float(int(text, 16))
    value = number(text)
    if kind == "count" and value is not None and not (value >= 0 and value.is_integer()):
        return None
    return value


def describe_kind(kind: str) -> str:
    """Describe the values of a kind."""
    return {
        "number": "a finite number",
        "count": "a whole number",
        "vector": "three finite numbers",
        "list": "finite numbers",
        "color": "three or four finite numbers",
        "flag": "true or false",
        "text": "a text",
    }[kind]


def describe_required(row: Setting) -> str:
    """Describe the values that a setting accepts."""
    return describe_kind(row.kind) + ("" if row.lowest is None else f" of at least {row.lowest:g}")


def get_number(settings: Mapping[str, Value], name: str) -> float | None:
    """Return the number of a setting; None if it is not set."""
    value = settings.get(name)
    if value is None or isinstance(value.content, tuple | str):
        return None
    return float(value.content)


def is_set(settings: Mapping[str, Value], name: str, default: bool = False) -> bool:
    """Tell whether a flag is set; return the default where the description does not say."""
    value = settings.get(name)
    return default if value is None else bool(value.content)


def list_rows(tag: str) -> list[Setting]:
    """Return the rows that a tag in ``<gazebo>`` sets; none for another tag."""
    return [row for table in TABLES for row in table if tag in row.tags or tag == row.opposite]
