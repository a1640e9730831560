"""Findings of rules in a verdict: which of them matter in this run, and under which kind."""

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
    describe_mass_taken,
    describe_tensor_taken,
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
    }
)
"""Rules whose findings a kind of verdict consists of, the one that says most first."""

REMARKS = frozenset(("no-extent",))
"""Kinds that never fail a run: the shape is left out, as the exporters do."""


class Described(NamedTuple):
    """A finding about a link or the robot in a run.

    Attributes:
        finding: Of a rule.
        robot: The robot.
        run: The run.
        body: The rigid body of the link; None for a finding about the robot.
        massless: Links that the run depends on and that have no mass.
    """

    finding: Finding
    robot: Robot
    run: Run
    body: RigidBody | None
    massless: frozenset[str]


def check_description(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report what rules find in the file and matters in a run, and what the engine misread."""
    findings = compute_once(robot, "findings", lambda: validate(robot, "simulate"))
    known = {body.name for body in run.bodies.bodies if not body.mass}
    massless = frozenset(
        {body.name for body in list_massless_bodies(robot, run)}
        | list_large_massless_links(robot, run)
    )
    for kind, rules in KINDS.items():
        told: set[str] = set()
        for rule in rules:
            for finding in (one for one in findings if one.code == rule):
                about = Described(finding, robot, run, find_body(run, finding.name), massless)
                if finding.name in told or (finding.kind == "link" and about.body is None):
                    continue
                if (cause := _CAUSES[kind](about)) is None:
                    continue
                told.add(finding.name)
                yield _make_fault(kind, about, cause)
                if kind == "impossible-inertia" and about.body is not None:
                    known.add(about.body.name)
    yield from check_read_back(robot, run, known)


def _make_fault(kind: str, about: Described, cause: str) -> Fault:
    finding = about.finding
    is_remark = kind in REMARKS
    if kind == "no-collision-geometry":
        is_remark = about.run.bodies.fixed_base
    return Fault(
        kind,
        Severity.INFO if is_remark else Severity.ERROR,
        finding.message,
        finding.location,
        finding.kind,
        finding.name if finding.kind == "link" else "",
        cause,
        finding.code,
    )


def _explain_always(_about: Described) -> str | None:
    return ""


def _explain_extent(_about: Described) -> str | None:
    return "it is left out"


def _explain_scale(about: Described) -> str | None:
    """Explain a shape in millimeters; its finding does, unless a mesh has a scale already."""
    scale = about.finding.data.get("scale", ())
    if not scale or all(factor == 1.0 for factor in scale):
        return ""
    right = " ".join(f"{factor / 1000:g}" for factor in scale)
    return f'it is a thousand times too large by its scale; write <mesh scale="{right}">'


def _explain_moving_body(about: Described) -> str | None:
    return None if about.body is None or is_held(about.run, about.body) else ""


def _explain_mass(about: Described) -> str | None:
    """Explain a link without mass by what the engine took; None if its body has enough."""
    run, body = about.run, about.body
    if body is None or about.finding.name not in about.massless:
        return None
    if body.mass:
        return "it has a shape and no <inertial> with a mass"
    advice = "" if body.parent >= 0 else ": give it one, or fix it to the world with --fixed-base"
    return f"it has no <inertial> with a mass; {describe_mass_taken(run, body)}{advice}"


def _explain_tensor(about: Described) -> str | None:
    """Explain an inconsistent tensor by what the engine took; None if its body has another."""
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
    return describe_tensor_taken(run, body) if about.finding.name == worst else None


def _explain_size(about: Described) -> str | None:
    """Explain an inertia that slows its link; None where it does not matter."""
    robot, run, link = about.robot, about.run, about.robot.link[about.finding.name]
    if about.body is None or is_held(run, about.body):
        return None
    if not slows_link(robot, link, run, placeholder=about.finding.code == "placeholder-inertia"):
        return None
    return "a tensor of ones, or of other units; the link turns far too slowly"


def _explain_density(about: Described) -> str | None:
    """Explain a mass that is too large for its link; None for a light link."""
    run, link = about.run, about.robot.link[about.finding.name]
    if about.body is None or is_held(run, about.body):
        return None
    if compute_mass_share(link, run) <= run.thresholds.light_link:
        return None
    return "lead is lighter: its mass is in grams, or its shapes in another unit"


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
    }
)
"""For each kind, the cause of a fault; None where a finding does not matter in a run."""
