"""Check that inertials are complete."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Inertial, Robot
from ..fix import FixContext, Proposal, set_attribute, unsafe
from ..rule import ERROR, UNSAFE, URDF_AND_SDF, WARNING, Problem, rule
from ..xml.vocabulary_table import find_misspelled_attributes, find_misspelled_children
from .tensors import SIX, has_written_inertial, has_written_tensor


@rule(
    ERROR,
    effects={
        "urdfdom, pinocchio": (
            "load the link without its visuals and collisions, with an error in the log"
        ),
        "gz, gazebo-classic (with a mass)": "load the link without its visuals and collisions",
        "gz, gazebo-classic (without a mass)": (
            "take 0 kg and drop its visuals and collisions; omit a body without mass and its "
            "descendants"
        ),
        "check_urdf": "reports success anyway",
        "mujoco": "rejects the file",
        "pybullet (no element)": "rejects the robot",
        "pybullet (the mass or a moment)": "rejects the robot",
        "pybullet, drake (a product of inertia)": "take 0 for it",
    },
    formats=URDF_AND_SDF,
)
def incomplete_inertial(robot: Robot) -> Iterator[Problem]:
    """An ``<inertial>`` lacks its mass, its inertia or one of the six components.

    urdfdom stops reading the link at this point: its visuals and collisions are lost, its inertia
    is zero, and the robot is still reported as parsed. Write all components, also those that are
    zero.
    """
    for link in robot.links:
        if link.inertial is None:
            continue
        if robot.format == "sdf":
            if has_written_inertial(robot, link) and not has_written_tensor(robot, link):
                text = f"<inertial> of link '{link.name}' lacks <inertia>"
                yield Problem(
                    link,
                    f"{text}; SDF then takes 1 kg·m² about each axis. Write it",
                    at=link.inertial,
                    severity=WARNING,
                    data={"missing": ["<inertia>"]},
                )
            continue
        missing, at = _find_missing(link.inertial)
        if missing:
            yield Problem(
                link,
                f"<inertial> of link '{link.name}' lacks {', '.join(missing)}; add what is missing",
                at=at,
                effects=_select_effects(link.inertial),
                data={"missing": missing},
            )


@incomplete_inertial.full
def report_every_incomplete_inertial(robot: Robot) -> Iterator[Problem]:
    """Report each inertial that lacks an element or a number, even if one is misspelled."""
    for link in robot.links:
        if link.inertial is None or link.inertial.xml is None:
            continue
        found = {child.tag: child for child in link.inertial.xml.children}
        missing = [f"<{tag}>" for tag in ("mass", "inertia") if tag not in found]
        lacks_element = bool(missing)
        if "inertia" in found:
            missing += [name for name in SIX if name not in found["inertia"].attributes]
        if missing:
            text = f"<inertial> of link '{link.name}' lacks {', '.join(missing)}; add it"
            data = {"missing": missing, "lacks_element": lacks_element}
            yield Problem(link, text, at=link.inertial, data=data)


def _select_effects(inertial: Inertial) -> set[str]:
    mass, inertia = inertial.element.find_child("mass"), inertial.element.find_child("inertia")
    has_mass = mass is not None and "value" in mass.attributes
    has = "with" if has_mass else "without"
    keys = {"urdfdom, pinocchio", f"gz, gazebo-classic ({has} a mass)", "check_urdf", "mujoco"}
    if mass is None or inertia is None:
        keys.add("pybullet (no element)")
    elif has_mass and inertia.attributes.keys() >= {"ixx", "iyy", "izz"}:
        keys.add("pybullet, drake (a product of inertia)")
    else:
        keys.add("pybullet (the mass or a moment)")
    return keys


def _find_missing(inertial: Inertial) -> tuple[list[str], Inertial | None]:
    element = inertial.element
    missing: list[str] = []
    mass, inertia = element.find_child("mass"), element.find_child("inertia")
    if mass is None:
        missing.append("<mass>")
    elif all(":" in name for name in mass.attributes):
        missing.append("mass value")
    if inertia is None:
        missing.append("<inertia>")
    if mass is None or inertia is None:
        if missing and (meant := find_misspelled_children(element)):
            missing = [name for name in missing if name.strip("<>") not in meant.values()]
    if inertia is not None:
        lacking = [name for name in SIX if name not in inertia.attributes]
        if lacking and (meant := find_misspelled_attributes(inertia)):
            lacking = [name for name in lacking if name not in meant.values()]
        if lacking and not missing:
            return lacking, Inertial(inertia)
        missing += lacking
    return missing, inertial


@incomplete_inertial.fix(UNSAFE)
def write_products_of_zero(problem: Problem, context: FixContext) -> Proposal | None:
    """Write 0 for missing products of inertia."""
    inertial = context.get_link(problem).inertial
    inertia = inertial.element.find_child("inertia") if inertial is not None else None
    if inertial is None or inertia is None or inertial.element.find_child("mass") is None:
        return None
    missing = [name for name in SIX if name not in inertia.attributes]
    if not missing or not set(missing) <= {"ixy", "ixz", "iyz"}:
        return None
    zeros = " ".join(f'{name}="0"' for name in missing)
    return unsafe(f"write {zeros}", *(set_attribute(inertia, name, "0") for name in missing))
