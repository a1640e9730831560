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

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from ..source.document import Element
from .numbers import number, parse_numbers
from .part import Part
from .sdf_schema import (
    KINDS,
    describe_bounds,
    describe_kind,
    find_requirement,
    get_bounds,
    get_value_type,
)

Content = float | bool | tuple[float, ...] | str

UNBOUNDED = (-math.inf, math.inf)


class Setting(NamedTuple):
    """A row of a table.

    Attributes:
        name: Name in the model.
        unit: Unit of the value; empty for none.
        path: Path of the SDF element below the collision, link or joint.
        default: What SDF's specification says where it is not written.
        tags: Tags in ``<gazebo>`` that set it.
        kind: ``number``, ``count`` (a whole number), ``vector`` (three numbers), ``list`` (several
            numbers), ``color`` (red, green, blue, and alpha, 1 by default), ``flag`` or ``text``.
        opposite: Tag in ``<gazebo>`` that sets a flag to its opposite.
        contact: Child of Bullet's ``<contact>`` of a link that sets it.
        bounds: Smallest and largest value that libsdformat accepts.
        range: Smallest and largest value that make sense, if readers take others, too.
        mjcf: What MJCF has instead; empty for nothing.
        usd: What USD has instead; empty for nothing.
        physx: Attributes of PhysX that are the same in USD; ``*`` is the axis.
        also: A second SDF path with the value, which older readers use.
        note: Additional note for the page of the mapping.
    """

    name: str
    unit: str
    path: str
    default: Content
    tags: tuple[str, ...] = ()
    kind: str = ""
    opposite: str = ""
    contact: str = ""
    bounds: tuple[float, float] = UNBOUNDED
    range: tuple[float, float] = UNBOUNDED
    mjcf: str = ""
    usd: str = ""
    physx: tuple[str, ...] = ()
    also: str = ""
    note: str = ""

    @property
    def mjcf_attribute(self) -> str:
        """Return the name of its attribute in MJCF; empty for none."""
        return self.mjcf.partition(" ")[2]


def add_kinds(holder: str, rows: Iterable[Setting]) -> tuple[Setting, ...]:
    """Return rows with the kinds and bounds that SDF's schema gives their paths.

    Args:
        holder: Tag of the element that holds them; a row that has a kind keeps it.
        rows: Rows of a table.
    """
    return tuple(row if row.kind else _add_kind(holder, row) for row in rows)


def _add_kind(holder: str, row: Setting) -> Setting:
    above, _, tag = f"{holder}/{row.path}".rpartition("/")
    parent = above.rpartition("/")[2]
    bounds = get_bounds(parent, tag)
    return row._replace(kind=KINDS[get_value_type(parent, tag)], bounds=bounds)


_ODE = "surface/friction/ode/"
_CONTACT = "surface/contact/ode/"
_LIMIT = "physics/ode/limit/"
_DAMPER = "physics/ode/cfm_damping"
_POSITIVE, _PART = (0.0, math.inf), (0.0, 1.0)

SURFACE = add_kinds("collision", (
    Setting("friction", "", _ODE + "mu", 1.0, ("mu1",), contact="lateral_friction",
            mjcf="geom friction", usd="physics:dynamicFriction"),
    Setting("second_friction", "", _ODE + "mu2", 1.0, ("mu2",),
            contact="lateral_friction", mjcf="geom friction", usd="physics:dynamicFriction"),
    Setting("friction_direction", "", _ODE + "fdir1", (0.0, 0.0, 0.0), ("fdir1",),
            note="in the frame of the collision"),
    Setting("slip", "", _ODE + "slip1", 0.0, range=_POSITIVE),
    Setting("second_slip", "", _ODE + "slip2", 0.0, range=_POSITIVE),
    Setting("torsional_friction", "", "surface/friction/torsional/coefficient", 1.0),
    Setting("restitution", "", "surface/bounce/restitution_coefficient", 0.0,
            contact="restitution", usd="physics:restitution"),
    Setting("bounce_velocity", "m/s", "surface/bounce/threshold", 100000.0),
    Setting("contact_stiffness", "N/m", _CONTACT + "kp", 1e12, ("kp",),
            range=_POSITIVE, contact="stiffness"),
    Setting("contact_damping", "N·s/m", _CONTACT + "kd", 1.0, ("kd",),
            range=_POSITIVE, contact="damping"),
    Setting("correction_velocity", "m/s", _CONTACT + "max_vel", 0.01, ("maxVel",)),
    Setting("contact_depth", "m", _CONTACT + "min_depth", 0.0, ("minDepth",)),
    Setting("contact_cfm", "", _CONTACT + "soft_cfm", 0.0, range=_POSITIVE),
    Setting("contact_erp", "", _CONTACT + "soft_erp", 0.2, range=_PART),
    Setting("collide_bitmask", "", "surface/contact/collide_bitmask", 65535.0),
    Setting("category_bitmask", "", "surface/contact/category_bitmask", 65535.0),
    Setting("without_contact", "", "surface/contact/collide_without_contact", False),
    Setting("bitmask_without_contact", "",
            "surface/contact/collide_without_contact_bitmask", 1.0),
    Setting("max_contacts", "", "max_contacts", 10.0, ("maxContacts",)),
    Setting("laser_retro", "", "laser_retro", 0.0, ("laserRetro",),
            note="for gz in each visual too, where its lidar looks"),
))  # fmt: skip
"""Settings of a collision. A tag of its link in ``<gazebo>`` applies to each of its collisions."""

OF_LINKS = add_kinds("link", (
    Setting("gravity", "", "gravity", True, opposite="turnGravityOff",
            mjcf="body gravcomp"),
    Setting("self_collide", "", "self_collide", False, ("selfCollide",)),
    Setting("linear_decay", "", "velocity_decay/linear", 0.0, ("dampingFactor",),
            range=_POSITIVE),
    Setting("angular_decay", "", "velocity_decay/angular", 0.0, ("dampingFactor",),
            range=_POSITIVE),
    Setting("wind", "", "enable_wind", False),
    Setting("kinematic", "", "kinematic", False),
    Setting("must_be_base_link", "", "must_be_base_link", False),
))  # fmt: skip
"""Settings of a link."""

OF_JOINTS = add_kinds("joint", (
    Setting("spring_stiffness", "N·m/rad or N/m", "axis/dynamics/spring_stiffness", 0.0,
            ("springStiffness",), range=_POSITIVE, mjcf="joint stiffness"),
    Setting("spring_reference", "rad or m", "axis/dynamics/spring_reference", 0.0,
            ("springReference",), mjcf="joint springref"),
    Setting("limit_stiffness", "N·m/rad or N/m", "axis/limit/stiffness", 1e8),
    Setting("limit_dissipation", "N·m·s/rad or N·s/m", "axis/limit/dissipation", 1.0),
    Setting("stop_cfm", "", _LIMIT + "cfm", 0.0, ("stopCfm",), range=_POSITIVE),
    Setting("stop_erp", "", _LIMIT + "erp", 0.2, ("stopErp",), range=_PART),
    Setting("fudge_factor", "", "physics/ode/fudge_factor", 0.0, ("fudgeFactor",)),
    Setting("implicit_spring_damper", "", "physics/ode/implicit_spring_damper", False,
            ("implicitSpringDamper", "cfmDamping"), also=_DAMPER),
    Setting("provide_feedback", "", "physics/provide_feedback", False,
            ("provideFeedback",)),
    Setting("preserved", "", "", False, ("preserveFixedJoint",), kind="flag"),
    Setting("not_lumped", "", "", False, ("disableFixedJointLumping",), kind="flag"),
))  # fmt: skip
"""Settings of a joint; the last two keep a fixed joint, and SDF does not have them."""

SPRING = ("spring_stiffness", "spring_reference")
"""Settings of the spring of a joint."""

RESISTANCE = add_kinds("joint", (
    Setting("damping", "N·m·s/rad or N·s/m", "axis/dynamics/damping", 0.0, mjcf="joint damping",
            usd="newton:damping", physx=("physxJointAxis:*:viscousFrictionCoefficient",)),
    Setting("friction", "N·m or N", "axis/dynamics/friction", 0.0, mjcf="joint frictionloss",
            usd="newton:friction", physx=("physxJointAxis:*:staticFrictionEffort",
                                          "physxJointAxis:*:dynamicFrictionEffort")),
    Setting("armature", "kg·m² or kg", "", 0.0, kind="number", mjcf="joint armature",
            usd="newton:armature", physx=("physxJointAxis:*:armature", "physxJoint:armature")),
))  # fmt: skip
"""Values of ``Dynamics`` of a joint."""

RESISTANCE_OF_URDF = tuple(row.name for row in RESISTANCE if row.path)
"""Attributes of ``<dynamics>`` in URDF, which are elements of ``<dynamics>`` in SDF."""

OF_LIMITS = add_kinds("joint", (
    Setting("effort", "N·m or N", "axis/limit/effort", math.inf,
            mjcf="joint actuatorfrcrange", usd="physics:maxForce"),
    Setting("velocity", "rad/s or m/s", "axis/limit/velocity", math.inf,
            usd="newton:velocityLimit", physx=("physxJointAxis:*:maxJointVelocity",
                                               "physxJoint:maxJointVelocity")),
))  # fmt: skip
"""Magnitudes in ``Limit`` of a joint, which are attributes of ``<limit>`` in URDF, too."""

MAGNITUDES = tuple(row.name for row in OF_LIMITS)
"""Names of the magnitudes in ``Limit``."""

LIMIT_NAMES = ("lower", "upper", *MAGNITUDES)
"""Attributes of ``<limit>`` of URDF and elements of ``<limit>`` of SDF."""

OF_ROBOT = add_kinds(
    "model",
    (
        Setting("static", "", "static", False, ("static",)),
        Setting("self_collide", "", "self_collide", False),
        Setting("wind", "", "enable_wind", False),
        Setting("may_sleep", "", "allow_auto_disable", True),
    ),
)
"""Settings of the whole robot, in blocks without a reference."""

SURFACE_OF_MUJOCO = (
    Setting("contype", "", "", 1.0, mjcf="geom contype", kind="count"),
    Setting("conaffinity", "", "", 1.0, mjcf="geom conaffinity", kind="count"),
    Setting("spinning_friction", "m", "", 0.005, mjcf="geom friction", kind="number"),
    Setting("rolling_friction", "m", "", 0.0001, mjcf="geom friction", kind="number"),
    Setting("condim", "", "", 3.0, mjcf="geom condim", kind="count"),
    Setting("priority", "", "", 0.0, mjcf="geom priority", kind="count"),
    Setting("margin", "m", "", 0.0, mjcf="geom margin", kind="number"),
    Setting("gap", "m", "", 0.0, mjcf="geom gap", kind="number"),
    Setting("solmix", "", "", 1.0, mjcf="geom solmix", kind="number"),
    Setting("solref", "", "", (0.02, 1.0), mjcf="geom solref", kind="list"),
    Setting("solimp", "", "", (0.9, 0.95, 0.001, 0.5, 2.0), mjcf="geom solimp", kind="list"),
)
"""Settings of a collision that only MuJoCo has, with its defaults."""

LINKS_OF_MUJOCO = (
    Setting("gravity_compensation", "", "", 0.0, mjcf="body gravcomp", kind="number"),
)
"""Settings of a link that only MuJoCo has: the part of its weight that is carried."""

JOINTS_OF_MUJOCO = (
    Setting("limit_solref", "", "", (0.02, 1.0), mjcf="joint solreflimit", kind="list"),
    Setting("limit_solimp", "", "", (0.9, 0.95, 0.001, 0.5, 2.0),
            mjcf="joint solimplimit", kind="list"),
    Setting("limit_margin", "rad or m", "", 0.0, mjcf="joint margin", kind="number"),
    Setting("friction_solref", "", "", (0.02, 1.0), mjcf="joint solreffriction", kind="list"),
    Setting("friction_solimp", "", "", (0.9, 0.95, 0.001, 0.5, 2.0),
            mjcf="joint solimpfriction", kind="list"),
    Setting("actuator_gravity_compensation", "", "", False,
            mjcf="joint actuatorgravcomp", kind="flag"),
)  # fmt: skip
"""Settings of a joint that only MuJoCo has, with its defaults."""

TABLES = (SURFACE, OF_LINKS, OF_JOINTS)
ALL_SURFACE, ALL_OF_LINKS, ALL_OF_JOINTS = (
    SURFACE + SURFACE_OF_MUJOCO, OF_LINKS + LINKS_OF_MUJOCO, OF_JOINTS + JOINTS_OF_MUJOCO
)  # fmt: skip

TUNING = frozenset(
    row.name
    for rows, names in (
        (SURFACE, "bounce_velocity contact_stiffness contact_damping correction_velocity "
                  "contact_depth contact_cfm contact_erp max_contacts laser_retro"),
        (SURFACE_OF_MUJOCO, "rolling_friction priority margin gap solmix solref solimp"),
        (OF_LINKS, "must_be_base_link"),
        (ALL_OF_JOINTS, "limit_stiffness limit_dissipation stop_cfm stop_erp fudge_factor "
                        "implicit_spring_damper provide_feedback limit_solref limit_solimp "
                        "limit_margin friction_solref friction_solimp"),
        (OF_ROBOT, "may_sleep"),
    )
    for row in rows if row.name in names.split()
)  # fmt: skip
"""Settings of how a solver holds a contact or a limit; by the others a robot moves otherwise."""

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
        return self.content if not is_opposite(self.tag) else not self.content


Settings = dict[str, Value]
"""Values by the names of their rows."""


LOST_SETTINGS = "settings"
"""Entry of the data of a loss with the names of the settings that are lost."""

BAD_KEYWORD, OUT_OF_RANGE = "bad-extension-number", "setting-out-of-range"
BAD_ELEMENT = "invalid-sdf-value"
"""Rules of ``lint``: a tag that is not valid, a value outside of its bounds, an element of SDF."""


@dataclass(slots=True)
class Rejected(Part):
    """Element of a setting whose text is not a value.

    Attributes:
        code: Rule of ``lint`` that reports it: the code of its finding in each command.
        kind: ``link``, ``joint``, ``robot``, ``sensor`` or ``closed loop``.
        name: Name of that part.
        tag: Tag of the element, or what of it is wrong.
        text: Its text.
        required: What it has to be.
    """

    code: str = BAD_ELEMENT
    kind: str = ""
    name: str = ""
    tag: str = ""
    text: str = ""
    required: str = ""

    @property
    def fact(self) -> str:
        """Return what is wrong and what would be right."""
        return describe_rejected((self.kind, self.name), self.tag, self.text, self.required)


def describe_rejected(part: tuple[str, str], tag: str, text: str, required: str) -> str:
    """Describe a text that is not a value: the first words of each message about it."""
    shown = f"'{text}'" if text else "empty"
    return f"{part[0]} '{part[1]}': {tag} is {shown}, not {required}"


def split_unit(unit: str) -> tuple[str, str]:
    """Return the unit for a joint that turns, and for one that slides."""
    turning, _, sliding = unit.partition(" or ")
    return turning, sliding or turning


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


def find_required(row: Setting, text: str, element: Element | None = None, above: str = "") -> str:
    """Describe what a text has to be as the value of a setting; empty if it is valid.

    Args:
        row: The setting.
        text: The text.
        element: The element of SDF that has it, of which libsdformat requires what its schema says;
            None for a tag in ``<gazebo>``, in which it also takes ``yes`` for ``true``.
        above: Tag of the element of SDF that holds the element.
    """
    needed = None if element is None else find_requirement(above, element)
    content = parse(row.kind, text)
    if content is None or needed is not None:
        return describe_kind(row.kind) if needed is None else needed.text
    least, most = row.bounds
    if isinstance(content, tuple | str) or least <= content <= most:
        return ""
    return describe_kind(row.kind) + describe_bounds(least, most)


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


def is_opposite(tag: str) -> bool:
    """Tell whether a tag in ``<gazebo>`` sets a flag to its opposite."""
    return tag in _OPPOSITES


def is_setting(tag: str) -> bool:
    """Tell whether an element in ``<gazebo>`` sets something, by its tag or as one of SDF."""
    rows = (*SURFACE, *OF_LINKS, *OF_JOINTS, *OF_ROBOT)
    return any(tag in (*row.tags, row.opposite, row.path.partition("/")[0]) for row in rows if tag)


def list_rows(tag: str) -> list[Setting]:
    """Return the rows that a tag in ``<gazebo>`` sets; none for another tag."""
    return [row for table in TABLES for row in table if tag in row.tags or tag == row.opposite]
