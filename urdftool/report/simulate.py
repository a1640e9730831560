"""Format a verdict as text, and as JSON; the schema is ``docs/schemas/simulate.json``."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from ..control_characters import escape_controls
from ..diagnostic import Severity
from ..model.elements import Robot
from .counted import format_count
from .findings import Painter
from .json_text import format_json, replace_non_finite
from .tables import Cell, render_table

if TYPE_CHECKING:
    from ..simulation.checks.final_state import FinalState
    from ..simulation.engine_comparison import EngineComparison
    from ..simulation.fault import Fault
    from ..simulation.verdict import Verdict

_MOST = 6  # names in one line; chosen

_LABELS = {
    Severity.ERROR: ("error", "red"),
    Severity.WARNING: ("warning", "yellow"),
    Severity.INFO: ("note", "blue"),
}


def format_text(robot: Robot, verdicts: Sequence[Verdict], *, colors: bool = False) -> str:
    """Format the results as a table, followed by a paragraph for each fault."""
    paint = Painter(colors)
    lines: list[str] = []
    if len(verdicts) == 1:
        lines += _format_one(robot, verdicts[0], paint)
    else:
        lines += _format_several(robot, verdicts, paint)
    return "".join(f"{line}\n" for line in lines)


def _format_one(robot: Robot, verdict: Verdict, paint: Painter) -> Iterator[str]:
    yield _format_headline(robot, verdict, paint)
    rows = list(_list_rows(verdict))
    width = max(len(label) for label, _ in rows)
    for label, text in rows:
        yield f"  {paint(f'{label:<{width}}', 'cyan')}  {text}"
    yield from _format_faults(verdict.faults, paint)


def _format_headline(robot: Robot, verdict: Verdict, paint: Painter) -> str:
    name = escape_controls(robot.name) or "the robot"
    gaps = f"; {describe_gaps(verdict.gaps)}" if verdict.gaps else ""
    if verdict.passes:
        return f"{name}: {paint(describe_outcome(verdict), 'green', bold=True)}{gaps}"
    kinds = ", ".join(dict.fromkeys(fault.code for fault in verdict.faults if fault.fails))
    return f"{name}: {paint(describe_outcome(verdict), 'red', bold=True)} ({kinds}){gaps}"


def describe_gaps(gaps: Sequence[Fault]) -> str:
    """Describe the remarks that name what no check looked at, one for each link."""
    return f"visuals of {format_count(len(gaps), 'link')} not read"


def describe_outcome(verdict: Verdict) -> str:
    """Describe the result: a robot that settles upright stands, in spite of model errors."""
    if not verdict.stands:
        return "does not stand"
    sagging = next((text for text, _ in verdict.motion.describe_joints()), "")
    if not verdict.passes:
        return sagging or "stands, with model errors"
    if sagging:
        return sagging
    return "stands" + (", with warnings" * any(fault.is_warning for fault in verdict.faults))


def _list_rows(verdict: Verdict) -> Iterator[tuple[str, str]]:
    run, rest = verdict.run, verdict.rest
    recording, bodies = run.recording, run.bodies
    held = len(recording.held)
    unactuated = len(recording.joints) - held
    yield "engine", f"{recording.engine}, {recording.steps} steps of {run.settings.timestep:g} s"
    root = "fixed to the world" if bodies.fixed_base else "free"
    if run.settings.fixed_in_exports:
        root += " (exports fix it; --fixed-base)"
    joints = "no joints"
    if recording.joints:
        joints = f"{format_count(held, 'joint')} held, {unactuated} unactuated or mimic"
    yield "robot", f"{bodies.mass:.4g} kg, {len(bodies.bodies)} bodies, {joints}; root {root}"
    if held and run.settings.controls is None:
        yield "held by", describe_holding(verdict)
    if rest.settled is None:
        yield "at rest", f"not in {recording.times[-1]:.3g} s"
    else:
        yield "at rest", f"after {rest.settled:.2f} s"
    if not bodies.fixed_base and math.isfinite(rest.drop):
        went = "sank" if rest.drop > -5e-5 else "rose"  # smaller values print as 0.0 mm
        yield (
            "root",
            f"{went} {1000 * abs(rest.drop):.1f} mm, moved {1000 * rest.drift:.1f} mm, "
            f"tilted {math.degrees(rest.tilt):.1f}°",
        )
    if rest.supports and not bodies.fixed_base:
        names = ", ".join(escape_controls(name) for name in rest.supports[:6])
        yield "stands on", names + (f", {len(rest.supports) - 6} more" * (len(rest.supports) > 6))
        if rest.margin is not None:
            yield (
                "static margin",
                f"{1000 * rest.margin:.1f} mm from the center of mass to the nearest edge"
                + _describe_tipping(verdict),
            )
    if run.swept:
        blocked = sum(fault.code == "blocked" for fault in verdict.faults)
        yield (
            "sweep",
            f"{format_count(len(run.swept), 'joint')} through their limits, {blocked} blocked",
        )


def describe_holding(verdict: Verdict) -> str:
    """Describe what holds the joints, and what an exported robot has instead."""
    run = verdict.run
    means = run.recording.capabilities.holds_by
    passes = "" if run.settings.self_collision else "; no contact between links"
    note = ""
    if not run.recording.capabilities.loads_leaders and any(j.leader for j in run.bodies.joints):
        note = "; mimic joints by motors of their own, whose load does not reach their leaders"
    return f"{means} within effort limits{note} ('export mjcf': servos, which yield){passes}"


def _describe_tipping(verdict: Verdict) -> str:
    """Describe which tilt tips a robot over on level ground, if it is small."""
    rest, run = verdict.rest, verdict.run
    if rest.margin is None or rest.center is None or rest.margin < 0 or run.settings.slope:
        return ""
    tilt = math.atan2(rest.margin, rest.center[2])
    small = tilt < run.thresholds.narrow_tilt
    return f": a tilt of {math.degrees(tilt):.1f}° tips the robot over" * small


def _format_faults(faults: Sequence[Fault], paint: Painter) -> Iterator[str]:
    groups: dict[tuple[str, Severity, str], list[Fault]] = {}
    for fault in faults:
        groups.setdefault(fault.group, []).append(fault)
    for fault, *alike in groups.values():
        label, color = _LABELS[fault.severity]
        place = f"{escape_controls(str(fault.location))}: " if fault.location is not None else ""
        yield ""
        yield (
            f"{paint(place, bold=True)}{paint(label, color, bold=True)}: "
            f"{escape_controls(fault.message)}"
        )
        others = list(dict.fromkeys(other.name for other in alike if other.name != fault.name))
        if others:
            shown = ", ".join(escape_controls(name) for name in others[:_MOST])
            more = f", {len(others) - _MOST} more" if len(others) > _MOST else ""
            yield f"   {paint('=', 'cyan')} same for {shown}{more}"
        if fault.cause:
            yield f"   {paint('=', 'cyan')} {escape_controls(fault.cause)}"
        if fault.rule:
            yield f"   {paint('=', 'cyan')} urdftool lint --explain {fault.rule}"


def _format_several(robot: Robot, verdicts: Sequence[Verdict], paint: Painter) -> Iterator[str]:
    good = sum(verdict.stands for verdict in verdicts)
    word = paint(f"{good} of {len(verdicts)}", "green" if good == len(verdicts) else "red")
    yield f"{escape_controls(robot.name) or 'the robot'}: stands in {word} trials" + (
        f"; {describe_gaps(verdicts[0].gaps)}" if verdicts[0].gaps else ""
    )
    seen: dict[tuple[str, str], tuple[Fault, list[int]]] = {}
    for number, verdict in enumerate(verdicts, 1):
        tilt = math.degrees(math.hypot(*verdict.run.settings.start_rpy[:2]))
        kinds = ", ".join(dict.fromkeys(f.code for f in verdict.faults if f.fails))
        settled = "moving" if verdict.rest.settled is None else f"{verdict.rest.settled:6.2f} s"
        yield f"  trial {number:>3}  from {tilt:4.1f}°  {settled:>8}  {kinds or 'stands'}"
        for fault in verdict.faults:
            seen.setdefault((fault.code, fault.name), (fault, []))[1].append(number)
    faults = [fault for fault, _ in seen.values()]
    yield from _format_faults(sorted(faults, key=lambda fault: fault.severity, reverse=True), paint)


def format_comparison_text(comparison: EngineComparison, *, colors: bool = False) -> str:
    """Format the values in which two engines differ as a table, with the possible causes."""
    paint = Painter(colors)
    if not comparison.differences:
        return f"\n{paint('the engines agree', 'green')}\n"
    several = any(part.trial for part in comparison.differences)
    heads = (*(("trial",) if several else ()), "value", *comparison.engines, "allowed")
    rows: list[tuple[Cell, ...]] = [tuple((head, "cyan") for head in heads)]
    for part in comparison.differences:
        trial = (str(part.trial),) if several else ()
        allowed = "" if part.unit == "s" else part.write_value(part.bound)
        rows.append(
            (*trial, part.what, part.write_value(part.one), part.write_value(part.other), allowed)
        )
    table = render_table(rows, left=range(len(heads)), colors=colors)
    count = format_count(len(comparison.differences), "value")
    lines = ["", f"{paint('error', 'red', bold=True)}: the engines differ in {count}"]
    lines += [f"  {line}" for line in table.splitlines()]
    lines += [
        f"   {paint('=', 'cyan')} possible cause: {escape_controls(c)}" for c in comparison.causes
    ]
    return "".join(f"{line}\n" for line in lines)


def to_json(
    robot: Robot,
    verdicts: Sequence[Verdict],
    *,
    timings: bool = False,
    comparison: EngineComparison | None = None,
) -> str:
    """Format all results with the time series as JSON; meters, radians, kilograms, seconds."""
    document: dict[str, Any] = {
        "version": 1,
        "name": robot.name,
        "path": robot.source.path if robot.source is not None else None,
        "stands": all(verdict.stands for verdict in verdicts),
        "passes": all(verdict.passes for verdict in verdicts),
        "trials": [_build_trial(verdict, timings) for verdict in verdicts],
    }
    differences = [] if comparison is None else comparison.report_faults(robot)
    document["differences"] = [_build_fault(fault) for fault in differences]
    document["passes"] = document["passes"] and not differences
    return format_json(document) + "\n"


def _build_trial(verdict: Verdict, timings: bool) -> dict[str, Any]:
    run, rest = verdict.run, verdict.rest
    recording = run.recording
    return {
        "stands": verdict.stands,
        "passes": verdict.passes,
        "faults": [_build_fault(fault) for fault in verdict.faults],
        "settings": asdict(run.settings),
        "engine": recording.engine,
        "mass": run.bodies.mass,
        "fixed": run.bodies.fixed_base,
        "rest": _build_final_state(rest),
        "held": {name: recording.targets[name] for name in recording.held},
        "held_by": recording.capabilities.holds_by if run.settings.controls is None else None,
        "bodies": list(recording.bodies),
        "joints": list(recording.joints),
        "contacts": [asdict(contact) for contact in recording.contacts],
        "sweep": [asdict(joint) for joint in run.swept],
        "steps": recording.steps,
        **({"seconds": recording.seconds} if timings else {}),
        "series": {
            name: replace_non_finite(getattr(recording, name).tolist())
            for name in (
                *("times", "poses", "velocities", "positions", "rates", "efforts"),
                *("kinetic", "potential", "depths"),
            )
        },
    }


def _build_final_state(state: FinalState) -> dict[str, Any]:
    """Return the values of a final state, with ``centre``, a deprecated name of ``center``."""
    values = {key: replace_non_finite(value) for key, value in asdict(state).items()}
    return values | {"centre": values["center"]}


def _build_fault(fault: Fault) -> dict[str, Any]:
    place = fault.location
    return {
        "kind": fault.code,
        "old_kind": fault.old_kind,
        "fails": fault.fails,
        "severity": fault.severity.label,
        "message": fault.message,
        "cause": fault.cause or None,
        "rule": fault.rule or None,
        "what": fault.what,
        "name": fault.name,
        "path": None if place is None else place.file.path,
        "line": None if place is None else place.line,
        "column": None if place is None else place.column,
    }
