"""The ``<mujoco>`` element of a URDF: its model options are copied to the export."""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from ...finding import Finding, Severity
from ...model.elements import Robot
from ...model.read import numbers
from ...source.document import Element
from ..defects import defect
from ..written import Written

OURS = frozenset(
    ("angle", "meshdir", "texturedir", "assetdir", "strippath", "discardvisual", "fusestatic",
     "balanceinertia", "inertiafromgeom", "inertiagrouprange", "eulerseq", "coordinate",
     "autolimits", "boundmass", "boundinertia", "settotalmass", "convexhull")
)  # fmt: skip
"""Attributes of ``<compiler>`` that control the reading of URDF, or that changes the robot."""

SECTIONS = ("option", "size", "visual", "statistic")


BOOLEAN = ("true", "false")

WHOLE = 0
"""Marks a single integer."""

# tag -> attribute -> count of numbers (-n for at most n), or allowed words; other attributes
# are copied unchecked
VALUES: dict[str, dict[str, int | tuple[str, ...]]] = {
    "compiler": {
        **dict.fromkeys(("alignfree", "fitaabb", "usethread", "saveinertial"), BOOLEAN),
    },
    "option": {
        **dict.fromkeys(
            ("timestep", "impratio", "tolerance", "ls_tolerance", "noslip_tolerance",
             "ccd_tolerance", "sleep_tolerance", "density", "viscosity", "o_margin"),
            1,
        ),
        **dict.fromkeys(
            ("iterations", "ls_iterations", "noslip_iterations", "ccd_iterations",
             "sdf_iterations", "sdf_initpoints"),
            WHOLE,
        ),
        **dict.fromkeys(("gravity", "wind", "magnetic"), 3),
        "o_solref": -2,
        **dict.fromkeys(("o_solimp", "o_friction"), -5),
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


def extension_defects(robot: Robot) -> Iterator[Finding]:
    """Yield values that MuJoCo rejects: not a number, too few numbers, or an unknown word."""
    for extension in robot.element.all("mujoco"):
        for part in extension.children:
            if part.tag != "compiler" and part.tag not in SECTIONS:
                continue
            for element in part.walk():
                for name, value in element.attributes.items():
                    wanted = _refused(element, name)
                    if wanted:
                        yield defect(
                            "bad-extension-number",
                            f'{name}="{value}" of <{element.tag}> in <mujoco> is not {wanted}',
                            element.attribute_place(name),
                            "mujoco",
                            name,
                        )


def _refused(element: Element, name: str) -> str:
    """Describe the required value of an attribute; return "" if the value is valid."""
    wanted = VALUES.get(element.tag, {}).get(name)
    value = element.get(name) or ""
    if wanted is None or (element.tag == "compiler" and name in OURS):
        return ""
    if isinstance(wanted, tuple):
        return "" if value in wanted else "one of " + ", ".join(wanted)
    if wanted == WHOLE:
        digits = value.strip().removeprefix("-").removeprefix("+")
        return "" if digits.isascii() and digits.isdigit() else "a whole number"
    count = len(value.split()) if wanted < 0 else wanted
    if 0 < count <= abs(wanted) and numbers(value, count) is not None:
        return ""
    if wanted == 1:
        return "a finite number"
    return f"{'at most ' if wanted < 0 else ''}{abs(wanted)} finite numbers"


def apply_extension(robot: Robot, sections: dict[str, etree._Element], written: Written) -> None:
    """Copy ``<compiler>``, ``<option>`` and other known elements to the sections, by name."""
    for extension in robot.element.all("mujoco"):
        for child in extension.children:
            if child.tag == "compiler":
                _compiler(child, sections, written)
            elif child.tag in SECTIONS:
                target = sections.setdefault(child.tag, etree.Element(child.tag))
                _merge(child, target)
            else:
                written.report_loss(
                    "mujoco",
                    f"<{child.tag}> in <mujoco> is not exported; only compiler, "
                    + ", ".join(SECTIONS),
                    child.place,
                    kind="mujoco",
                    name=child.tag,
                )


def _compiler(element: Element, sections: dict[str, etree._Element], written: Written) -> None:
    for name, value in element.attributes.items():
        if name not in OURS:
            if not _refused(element, name):
                sections["compiler"].set(name, value)
            continue
        changes = name in ("balanceinertia", "boundmass", "boundinertia", "settotalmass")
        written.report_loss(
            "mujoco",
            f"{name}={value!r} of <compiler> is not exported: it "
            + ("changes the robot" if changes else "controls how MuJoCo reads URDF"),
            element.attribute_place(name),
            kind="mujoco",
            name=name,
            severity=Severity.WARNING if changes and value != "false" else Severity.INFO,
        )


def _merge(element: Element, target: etree._Element) -> None:
    for name, value in element.attributes.items():
        if not _refused(element, name):
            target.set(name, value)
    for child in element.children:
        found = target.find(child.tag)
        _merge(child, etree.SubElement(target, child.tag) if found is None else found)
