"""Texts of the page: errors, notices, findings, and the properties of links and joints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ..diagnostic import Severity
from ..errors import UrdftoolError
from ..finding import Finding
from ..model.elements import Robot
from .marks import counted, worst
from .numbers import joint_rows, link_rows, safe, shortened, table

COLORS = {Severity.ERROR: "#e03131", Severity.WARNING: "#e8590c", Severity.INFO: "#1c7ed6"}

MOST = 300
"""Maximum number of listed findings."""

SAID = 12
"""Maximum number of notices."""

_SMALL = "font-size:.85em;line-height:1.35;padding:.2em .75em"


def box(inner: str) -> str:
    """Wrap HTML in the font size of the page."""
    return f"<div style='{_SMALL}'>{inner}</div>"


def broken(error: UrdftoolError) -> str:
    """Format the error of a description that cannot be read."""
    lines = [str(error)]
    lines += [
        f"from {call.file.path}:{call.line}:{call.column}: {call.what}" for call in error.calls
    ]
    lines += error.notes
    text = "<br>".join(safe(line) for line in lines)
    return _alert(f"{text}<br><i>The page shows the last valid version.</i>", "#e03131")


def bug(error: BaseException) -> str:
    """Format an exception of the page itself."""
    what = safe(f"{type(error).__name__}: {error}")
    return _alert(f"Bug in urdftool (not in the robot): {what}", "#e03131")


def notices(messages: Iterable[str]) -> str:
    """Format problems with meshes, joints and links; empty if there are none."""
    lines = list(messages)
    if not lines:
        return ""
    rest = f"<br>… and {len(lines) - SAID} more" if len(lines) > SAID else ""
    return _alert("<br>".join(safe(line) for line in lines[:SAID]) + rest, "#e8590c")


def _alert(inner: str, color: str) -> str:
    return box(
        f"<div role='alert' style='border-left:4px solid {color};padding:.4em .6em;"
        f"background:{color}18;overflow-wrap:anywhere;max-height:9em;overflow-y:auto'>"
        f"{inner}</div>"
    )


def summary(robot: Robot, findings: Iterable[Finding] | None) -> str:
    """Summarize the robot in one line."""
    mass = sum(link.mass for link in robot.links)
    moving = f" ({len(robot.moving_joints)} moving)" if robot.joints else ""
    words = [
        _count(len(robot.links), "link"),
        f"{_count(len(robot.joints), 'joint')}{moving}",
        f"{mass:.4g} kg",
    ]
    if findings is not None:
        words.append(counted(findings) or "no lint findings")
    return box(safe(" · ".join(words)))


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'s' * (number != 1)}"


def one_link(robot: Robot, name: str, rows: Iterable[tuple[str, str]]) -> str:
    """Format the properties of the selected link and its parent joint."""
    text = f"<b style='overflow-wrap:anywhere'>{safe(name)}</b>{table(rows)}"
    joint = robot.tree.parent_joint(name)
    if joint is not None:
        text += f"<b style='overflow-wrap:anywhere'>{safe(joint.name)}</b>"
        text += table(joint_rows(joint))
    return box(text)


def all_parts(robot: Robot, found: Mapping[str, list[Finding]]) -> str:
    """Format every link and every joint as a collapsible item."""
    links = "".join(
        _unfolding(
            link.name, _link_hint(link.mass, found.get(link.name, [])), link_rows(robot, link)
        )
        for link in robot.links
    )
    joints = "".join(
        _unfolding(joint.name, safe(joint.type), joint_rows(joint)) for joint in robot.joints
    )
    return box(
        f"<b>{_count(len(robot.links), 'link')}</b>{links}"
        f"<b style='display:block;margin-top:.6em'>{_count(len(robot.joints), 'joint')}</b>{joints}"
    )


def _link_hint(mass: float, findings: list[Finding]) -> str:
    words = f"{mass:.4g} kg" if mass else ""
    severity = worst(finding for finding in findings if finding.severity > Severity.INFO)
    if severity is None:
        return words
    text = counted(finding for finding in findings if finding.severity > Severity.INFO)
    return f"{words} <span style='color:{COLORS[severity]}'>{text}</span>"


def _unfolding(name: str, hint: str, rows: Iterable[tuple[str, str]]) -> str:
    shown = safe(shortened(name) or "(no name)")
    return (
        f"<details><summary style='cursor:pointer;overflow-wrap:anywhere'>{shown} "
        f"<span style='opacity:.7'>{hint}</span></summary>{table(rows)}</details>"
    )


def list_of(findings: list[Finding] | None, found: Mapping[str, list[Finding]]) -> str:
    """Format the findings, the most severe first; None while lint is running."""
    if findings is None:
        return box("linting …")
    if not findings:
        return box("no lint findings")
    on: dict[int, list[str]] = {}
    for link, those in found.items():
        for finding in those:
            on.setdefault(id(finding), []).append(link)
    ordered = sorted(findings, key=lambda finding: -finding.severity)
    items = "".join(_item(finding, on.get(id(finding), [])) for finding in ordered[:MOST])
    more = f"<p>… and {len(findings) - MOST} more</p>" if len(findings) > MOST else ""
    return box(f"<b>{safe(counted(findings))}</b>{items}{more}")


def _item(finding: Finding, links: list[str]) -> str:
    color = COLORS[finding.severity]
    where = f" · on {', '.join(shortened(link, 30) for link in links[:4])}" if links else ""
    more = " …" if len(links) > 4 else ""
    times = f" (in {finding.expansions} expansions)" if finding.expansions > 1 else ""
    return (
        f"<div style='border-left:4px solid {color};padding-left:.6em;margin:.5em 0;"
        f"overflow-wrap:anywhere'><b style='color:{color}'>{finding.severity.label}</b> "
        f"{safe(finding.message + times)}<br>"
        f"<span style='opacity:.65'>{safe(str(finding.location))} "
        f"[{safe(finding.code)}]{safe(where + more)}</span></div>"
    )
