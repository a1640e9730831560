"""Friction, contact, springs and flags, which URDF itself does not have, as tables.

One row is one setting: how SDF names it, which tags of ``<gazebo>`` and of Bullet's ``<contact>``
set it, and what MJCF and USD have instead. A reader fills ``Collision.surface``, ``Link.settings``
and ``Joint.settings`` with :func:`read_sdf_settings` or values of its own, writers write them, and
the comparison compares them. A new setting is a new row.

Of the tags in ``<gazebo>``, the last one in the file counts, in any block; a tag counts before an
element of SDF in a block, and both count before ``<contact>``. libsdformat 12.3 does so, as
``fixtures/effects/gazebo.yaml`` records; it rejects a file with a negative friction.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from ..source.document import Element
from .numbers import number, parse_numbers
from .part import Part

if TYPE_CHECKING:
    from .elements import Robot

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

OF_WORLD = (
    Setting("integrator", "text", "", "", "Euler", mjcf="option integrator"),
    Setting("cone", "text", "", "", "pyramidal", mjcf="option cone"),
    Setting("gravity", "vector", "m/s²", "", (0.0, 0.0, -9.81), mjcf="option gravity"),
    Setting("wind", "vector", "m/s", "", (0.0, 0.0, 0.0), mjcf="option wind"),
    Setting("magnetic", "vector", "", "", (0.0, -0.5, 0.0), mjcf="option magnetic"),
    Setting("density", "number", "kg/m³", "", 0.0, mjcf="option density"),
    Setting("viscosity", "number", "Pa·s", "", 0.0, mjcf="option viscosity"),
    Setting("timestep", "number", "s", "", 0.002, mjcf="option timestep"),
    Setting("impratio", "number", "", "", 1.0, mjcf="option impratio"),
    Setting("tolerance", "number", "", "", 1e-8, mjcf="option tolerance"),
    Setting("iterations", "count", "", "", 100.0, mjcf="option iterations"),
    Setting("jacobian", "text", "", "", "auto", mjcf="option jacobian"),
    Setting("solver", "text", "", "", "Newton", mjcf="option solver"),
    Setting("disabled", "text", "", "", "", mjcf="option disableflags"),
    Setting("enabled", "text", "", "", "", mjcf="option enableflags"),
)
"""Settings of the world around a robot, of ``<option>`` of MJCF, with MuJoCo's defaults."""

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


@dataclass(slots=True)
class _Reading:
    """Values of one part while they are read.

    Attributes:
        name: Name of the part.
        kind: Kind of the part.
        rejected: Elements whose text is not a value.
        values: What was read.
        weak: Identities of values for another reader, which are replaced without a word.
    """

    name: str = ""
    kind: str = "link"
    rejected: list[Rejected] = field(default_factory=list)
    values: Settings = field(default_factory=dict)
    weak: set[int] = field(default_factory=set)

    def put(self, row: Setting, element: Element, *, negated: bool = False) -> None:
        text = get_text(element)
        content = parse(row.kind, text)
        if content is None or (row.lowest is not None and not _is_within(row, content)):
            if all(one.provenance is not element for one in self.rejected):
                required = describe_required(row)
                self.rejected.append(
                    Rejected(element, self.kind, self.name, element.tag, text, required)
                )
            return
        content = not content if negated else content
        before = self.values.get(row.name)
        earlier: tuple[Value, ...] = ()
        if before is not None and id(before) not in self.weak and before.content != content:
            earlier = (*before.earlier, before)
        self.values[row.name] = Value(element, content, earlier)


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
        "color": "three or four finite numbers",
        "flag": "true or false",
        "text": "a text",
    }[kind]


def describe_required(row: Setting) -> str:
    """Describe the values that a setting accepts."""
    return describe_kind(row.kind) + ("" if row.lowest is None else f" of at least {row.lowest:g}")


def _is_within(row: Setting, content: Content) -> bool:
    return row.lowest is None or isinstance(content, tuple | str) or content >= row.lowest


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


def list_settings(robot: Robot) -> Iterator[tuple[str, str, Sequence[Setting], Settings]]:
    """Yield kind and name of each link and joint with its rows and settings.

    The settings of several collisions of a link are yielded once if they are the same.
    """
    for link in robot.links:
        yield "link", link.name, ALL_OF_LINKS, link.settings
        surfaces = {id(shape.surface): shape.surface for shape in link.collisions}
        for surface in surfaces.values():
            yield "link", link.name, ALL_SURFACE, surface
    for joint in robot.joints:
        yield "joint", joint.name, ALL_OF_JOINTS, joint.settings


def read_sdf_settings(element: Element, rows: Iterable[Setting], *, axis: str = "axis") -> Settings:
    """Return the valid settings in the SDF element of a collision, link or joint.

    Args:
        element: The element.
        rows: What is read.
        axis: Tag of the axis of a joint that is read: ``axis`` or ``axis2``.
    """
    reading = _Reading()
    for row in rows:
        paths = [path.replace("axis/", f"{axis}/") for path in (row.path, row.also) if path]
        found = next((e for path in paths if (e := _find(element, path)) is not None), None)
        if found is not None:
            reading.put(row, found)
    return reading.values


def _find(element: Element, path: str) -> Element | None:
    found: Element | None = element
    for tag in path.split("/"):
        found = None if found is None else found.find_child(tag)
    return found


_WORDS: dict[str, tuple[Content, ...]] = {
    "integrator": ("Euler", "RK4", "implicit", "implicitfast"),
    "cone": ("pyramidal", "elliptic"),
    "jacobian": ("dense", "sparse", "auto"),
    "solver": ("PGS", "CG", "Newton"),
}
"""Words that MuJoCo's reader accepts, by the name of the row."""

_ENABLED = ("override", "energy", "fwdinv", "invdiscrete", "sleep")
"""Flags of ``<option>`` that are off by default in every version of MuJoCo."""


def read_options(extensions: Iterable[Element]) -> Settings:
    """Return the settings of the world in the ``<option>`` elements of ``<mujoco>`` elements."""
    reading, flags = _Reading("world"), dict[str, tuple[Element, str]]()
    for option in (one for each in extensions for one in each.list_children("option")):
        for row in OF_WORLD:
            text = option.get(row.mjcf.partition(" ")[2])
            content = None if text is None else parse(row.kind, text.strip())
            if content is not None and content in _WORDS.get(row.name, (content,)):
                reading.values[row.name] = Value(option, content)
        for flag in option.list_children("flag"):
            flags |= {name: (flag, state) for name, state in flag.attributes.items()}
    for name, state, is_extra in (("disabled", "disable", False), ("enabled", "enable", True)):
        chosen = [flag for flag, (_, text) in flags.items() if text == state]
        words = [flag for flag in chosen if (flag in _ENABLED) is is_extra]
        if words:
            reading.values[name] = Value(flags[words[0]][0], " ".join(sorted(words)))
    return reading.values


def add_settings(robot: Robot) -> None:
    """Read the settings of a URDF: from ``<gazebo>`` blocks and Bullet's ``<contact>``."""
    robot.world = read_options(() if robot.xml is None else robot.xml.list_children("mujoco"))
    blocks, own = robot.block_elements, _Reading(robot.name, "robot")
    robot.settings = _read_elements(robot, own, blocks.get("", []), OF_ROBOT)
    for link in robot.links:
        contact, elements = link.find_child_xml("contact"), blocks.get(link.name, [])
        if not elements and contact is None:
            continue
        link.settings = _read_elements(robot, _Reading(link.name), elements, OF_LINKS)
        shapes = [e for element in elements if element.tag == "collision" for e in element.children]
        reading = _Reading(link.name)
        _put_contact(reading, contact)
        _put_raw(reading, shapes, SURFACE)
        link.surface = _read_elements(robot, reading, elements, SURFACE)
        for collision in link.collisions:
            collision.surface = link.surface
        named = [get_text(e) for e in elements if e.tag == "material" and not e.children]
        link.gazebo_material = named[-1] if named else ""
    for joint in robot.joints:
        if elements := blocks.get(joint.name, []):
            reading = _Reading(joint.name, "joint")
            joint.settings = _read_elements(robot, reading, elements, OF_JOINTS)


def _read_elements(
    robot: Robot, reading: _Reading, elements: Sequence[Element], rows: Sequence[Setting]
) -> Settings:
    """Read the elements in the blocks of a part: a tag counts before an element of SDF."""
    if rows is not SURFACE:
        _put_raw(reading, elements[::-1], rows)  # sdformat reads the first of several
    tags = {tag: row for row in rows for tag in (*row.tags, row.opposite) if tag}
    for element in elements:
        if element.tag in tags:
            for row in rows:
                if element.tag in row.tags or element.tag == row.opposite:
                    reading.put(row, element, negated=element.tag == row.opposite)
    robot.rejected_settings += reading.rejected
    return reading.values


def _put_raw(reading: _Reading, elements: Iterable[Element], rows: Iterable[Setting]) -> None:
    """Take the values of elements of SDF."""
    for element in elements:
        for row in rows:
            first, _, rest = row.path.partition("/")
            if element.tag == first:
                found = _find(element, rest) if rest else element
                if found is not None:
                    reading.put(row, found)


def _put_contact(reading: _Reading, contact: Element | None) -> None:
    """Take the values of Bullet's ``<contact>``; its stiffness of 0 means the default."""
    for row in SURFACE if contact is not None else ():
        element = contact.find_child(row.contact) if contact is not None and row.contact else None
        if element is not None and (row.contact != "stiffness" or number(get_text(element)) != 0):
            reading.put(row, element)  # 0 as a stiffness means the default
    for value in reading.values.values():
        reading.weak.add(id(value))
