"""Values in the ``<mujoco>`` element of a URDF, as MuJoCo's XML reader requires them."""

from __future__ import annotations

from collections.abc import Iterator

from ..source.document import Element
from .elements import Robot
from .numbers import parse_numbers
from .provenance import Written
from .settings import Rejected, Setting
from .world_settings import OF_MUJOCO

BAD_VALUE = "bad-mujoco-value"
"""Rule of ``lint`` that reports a value that MuJoCo does not read."""

READER_SETTINGS = frozenset(
    ("angle", "meshdir", "texturedir", "assetdir", "strippath", "discardvisual", "fusestatic",
     "balanceinertia", "inertiafromgeom", "inertiagrouprange", "eulerseq", "coordinate",
     "autolimits", "boundmass", "boundinertia", "settotalmass", "convexhull")
)  # fmt: skip
"""Attributes of ``<compiler>`` that control how MuJoCo reads URDF, or that change the robot."""

SECTIONS = ("option", "size", "visual", "statistic")
"""Elements in ``<mujoco>`` with settings of the model, in addition to ``<compiler>``."""

BOOLEAN = ("true", "false")

WHOLE = 0
"""Marks a single integer. Chosen, no source."""


def _count_numbers(row: Setting) -> int:
    """Return the count of numbers of an attribute, as in ``VALUES``."""
    count = len(row.default) if isinstance(row.default, tuple) else 1
    return {"count": WHOLE, "list": -count}.get(row.kind, count)


# tag -> attribute -> count of numbers (-n for at most n), or allowed words; other attributes
# are copied unchecked
VALUES: dict[str, dict[str, int | tuple[str, ...]]] = {
    "compiler": {
        **dict.fromkeys(("alignfree", "fitaabb", "usethread", "saveinertial"), BOOLEAN),
    },
    "option": {
        **{row.mjcf.removeprefix("option "): _count_numbers(row) for row in OF_MUJOCO
           if row.kind != "text"},
        "integrator": ("Euler", "RK4", "implicit", "implicitfast"),
        "cone": ("pyramidal", "elliptic"),
        "jacobian": ("dense", "sparse", "auto"),
        "solver": ("PGS", "CG", "Newton"),
    },
    "flag": dict.fromkeys(
        ("constraint", "equality", "frictionloss", "limit", "contact", "passive", "spring",
         "damper", "gravity", "clampctrl", "warmstart", "filterparent", "actuation", "refsafe",
         "sensor", "midphase", "eulerdamp", "autoreset", "nativeccd", "island", "override",
         "energy", "fwdinv", "invdiscrete", "multiccd", "sleep"),
        ("enable", "disable"),
    ),
    "size": dict.fromkeys(
        ("njmax", "nconmax", "nstack", "nuserdata", "nkey", "nuser_body", "nuser_jnt",
         "nuser_geom", "nuser_site", "nuser_cam", "nuser_tendon", "nuser_actuator",
         "nuser_sensor"),
        WHOLE,
    ),
    "statistic": {
        **dict.fromkeys(("meaninertia", "meanmass", "meansize", "extent"), 1),
        "center": 3,
    },
    "global": dict.fromkeys(
        ("fovy", "ipd", "azimuth", "elevation", "linewidth", "glow", "offwidth", "offheight",
         "realtime"),
        1,
    ),
    "quality": dict.fromkeys(
        ("shadowsize", "offsamples", "numslices", "numstacks", "numquads"), 1
    ),
    "headlight": {**dict.fromkeys(("ambient", "diffuse", "specular"), 3), "active": 1},
    "map": dict.fromkeys(
        ("stiffness", "stiffnessrot", "force", "torque", "alpha", "fogstart", "fogend", "znear",
         "zfar", "haze", "shadowclip", "shadowscale", "actuatortendon"),
        1,
    ),
    "rgba": dict.fromkeys(("fog", "haze"), 4),
}  # fmt: skip


def list_rejected(robot: Robot) -> Iterator[Rejected]:
    """Yield the attributes in ``<mujoco>`` of a URDF that are not what MuJoCo requires there."""
    for extension in robot.element.list_children("mujoco"):
        for part in extension.children:
            for element in part.walk() if part.tag in ("compiler", *SECTIONS) else ():
                for name, value in element.attributes.items():
                    if required := describe_required_setting(element, name):
                        place = Written(element.locate_attribute(name), element)
                        what = f"{name} of <{element.tag}> in <mujoco>"
                        owner = "robot", robot.name
                        yield Rejected(place, BAD_VALUE, *owner, what, value, required)


def list_parents(one: Rejected) -> list[str]:
    """Return the tags of the elements that hold an attribute, up to ``<mujoco>``."""
    found, element = [], one.xml
    while element is not None and element.tag != "mujoco":
        found.append(element.tag)
        element = element.parent
    return found


def describe_required_setting(element: Element, name: str) -> str:
    """Describe the value that an attribute requires.

    Returns:
        "" if the value is valid, or the attribute is not in ``VALUES``; also for no number, which
        MuJoCo reads as the default.
    """
    required = VALUES.get(element.tag, {}).get(name)
    value = element.get(name) or ""
    if required is None or (element.tag == "compiler" and name in READER_SETTINGS):
        return ""
    if isinstance(required, tuple):
        return "" if value in required else "one of " + ", ".join(required)
    if not value.strip():
        return ""
    if required == WHOLE:
        digits = value.strip().removeprefix("-").removeprefix("+")
        return "" if digits.isascii() and digits.isdigit() else "a whole number"
    count = len(value.split()) if required < 0 else required
    if 0 < count <= abs(required) and parse_numbers(value, count) is not None:
        return ""
    if required == 1:
        return "a finite number"
    return f"{'at most ' if required < 0 else ''}{abs(required)} finite numbers"
