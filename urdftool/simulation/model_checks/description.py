"""Decide which findings of rules affect a run, and report them under verdict kinds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import NamedTuple

from ...diagnostic import Severity
from ...finding import Finding
from ...lint.validate import validate
from ...model.elements import Robot
from ..fault import Fault
from ..mesh_cache import compute_once
from ..rigid_bodies import RigidBody, link_mass_properties
from ..run import Run
from .bodies import (
    check_read_back,
    describe_simulated_mass,
    describe_simulated_tensor,
    find_body,
    is_held,
    is_impossible,
    list_large_massless_links,
    list_massless_bodies,
)
from .mass_distribution import compute_mass_share, slows_link

KINDS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "no-collision-geometry": ("missing-collision",),
        "no-extent": ("non-positive-dimension",),
        "no-mass": (
            *("zero-mass", "massless-root-body", "massless-moving-body"),
            "missing-inertial",
        ),
        "impossible-inertia": (
            *("zero-inertia", "inertia-not-positive-definite", "inertia-triangle-inequality"),
            *("inertia-component-typo", "inertia-off-by-power-of-ten", "incomplete-inertial"),
        ),
        "inertia-too-large": (
            *("placeholder-inertia", "inertia-off-by-power-of-ten", "inertia-exceeds-geometry"),
            "radius-of-gyration",
        ),
        "too-dense": ("implausible-density",),
        "mass-outlier": ("mass-outlier",),
        "too-large": ("mesh-in-millimeters", "shape-in-millimeters"),
        "plugin-mismatch": ("plugin-unknown-entity",),
    }
)
"""Rules of each verdict kind, the most specific one first."""

REMARKS = frozenset(("no-extent",))
"""Kinds that never fail a run: the shape is ignored, as by the exporters."""

WARNINGS = frozenset(
    (
        *("no-mass", "impossible-inertia", "inertia-too-large", "too-dense", "mass-outlier"),
        "plugin-mismatch",
    )
)
"""Kinds of values in the file, which fail a run with ``--strict`` only.

A root without mass is an error: what an engine does with it is not a motion of the robot.
"""


class Described(NamedTuple):
    """A finding about a link or the robot in a run.

    Attributes:
        finding: Of a rule.
        robot: The robot.
        run: The run.
        body: The rigid body of the link; None for a finding about the robot.
        massless: Links without mass that affect the run.
    """

    finding: Finding
    robot: Robot
    run: Run
    body: RigidBody | None
    massless: frozenset[str]


def check_description(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report findings of rules that affect a run, and values that the engine loaded differently."""
    findings = compute_once(robot, "findings", lambda: validate(robot, "simulate"))
    known = {body.name for body in run.bodies.bodies if not body.mass}
    massless = frozenset(
        {body.name for body in list_massless_bodies(robot, run)}
        | list_large_massless_links(robot, run)
    )
    for kind, rules in KINDS.items():
        reported: set[str] = set()
        for rule in rules:
            for finding in (one for one in findings if one.code == rule):
                about = Described(finding, robot, run, find_body(run, finding.name), massless)
                if finding.name in reported or (finding.kind == "link" and about.body is None):
                    continue
                if (cause := _CAUSES[kind](about)) is None:
                    continue
                reported.add(finding.name)
                yield _make_fault(kind, about, cause)
                if kind == "impossible-inertia" and about.body is not None:
                    known.add(about.body.name)
    yield from check_read_back(robot, run, known)


def _make_fault(kind: str, about: Described, cause: str) -> Fault:
    finding = about.finding
    return Fault(
        kind,
        _choose_severity(kind, about),
        finding.message,
        finding.location,
        finding.kind,
        finding.name if finding.kind == "link" else "",
        cause,
        finding.code,
    )


def _choose_severity(kind: str, about: Described) -> Severity:
    """Choose the severity of a finding: values of the file that do not describe a motion warn."""
    if kind in REMARKS or (kind == "no-collision-geometry" and about.run.bodies.fixed_base):
        return Severity.INFO
    if kind == "no-mass" and about.body is about.run.bodies.bodies[0]:
        return Severity.ERROR  # engines weld such a root to the world, or cannot move it
    return Severity.WARNING if kind in WARNINGS else Severity.ERROR


def _explain_always(_about: Described) -> str | None:
    return ""


def _explain_plugin(_about: Described) -> str | None:
    return "the engine runs no plugins; the plugin does not find it in Gazebo"


def _explain_extent(_about: Described) -> str | None:
    return "the shape is ignored"


def _explain_scale(about: Described) -> str | None:
    """Explain the scale of a mesh in millimeters; empty if the finding explains it."""
    scale = about.finding.data.get("scale", ())
    if not scale or all(factor == 1.0 for factor in scale):
        return ""
    right = " ".join(f"{factor / 1000:g}" for factor in scale)
    return f'the scale is a thousand times too large; write <mesh scale="{right}">'


def _explain_moving_body(about: Described) -> str | None:
    return None if about.body is None or is_held(about.run, about.body) else ""


def _explain_mass(about: Described) -> str | None:
    """Explain a link without mass by the behavior of the engine; None if its body has enough."""
    run, body = about.run, about.body
    if body is None or about.finding.name not in about.massless:
        return None
    if body.mass:
        return "the link has geometry but no <inertial> with a mass"
    advice = "" if body.parent >= 0 else "; add a mass, or pass --fixed-base"
    return f"the link has no <inertial> with a mass; {describe_simulated_mass(run, body)}{advice}"


def _explain_tensor(about: Described) -> str | None:
    """Explain an inconsistent tensor by the behavior of the engine; None if it has no effect."""
    run, body, link = about.run, about.body, about.robot.link
    if body is None or body.properties is None or is_held(run, body):
        return None
    excess = run.thresholds.tensor_excess
    if not is_impossible(body.properties.tensor, excess):
        return None
    bad = [
        link[name]
        for name in body.links
        if (own := link_mass_properties(link[name])) is not None
        and is_impossible(own.tensor, excess)
    ]
    worst = max(bad, key=lambda one: one.mass).name if bad else body.name
    return describe_simulated_tensor(run, body) if about.finding.name == worst else None


def _explain_size(about: Described) -> str | None:
    """Explain an inertia that slows its link; None if it has no effect."""
    robot, run, link = about.robot, about.run, about.robot.link[about.finding.name]
    if about.body is None or is_held(run, about.body):
        return None
    if not slows_link(robot, link, run, placeholder=about.finding.code == "placeholder-inertia"):
        return None
    return "placeholder tensor or wrong units; the link rotates too slowly"


def _explain_density(about: Described) -> str | None:
    """Explain a mass that is too large for its link; None for a light link."""
    run, link = about.run, about.robot.link[about.finding.name]
    if about.body is None or is_held(run, about.body):
        return None
    if compute_mass_share(link, run) <= run.thresholds.light_link:
        return None
    return "check the units of the mass and of the geometry"


_CAUSES: Mapping[str, Callable[[Described], str | None]] = MappingProxyType(
    {
        "no-collision-geometry": _explain_always,
        "no-extent": _explain_extent,
        "no-mass": _explain_mass,
        "impossible-inertia": _explain_tensor,
        "inertia-too-large": _explain_size,
        "too-dense": _explain_density,
        "mass-outlier": _explain_moving_body,
        "too-large": _explain_scale,
        "plugin-mismatch": _explain_plugin,
    }
)
"""Function of each kind that explains a finding; None if the finding does not affect the run."""
