"""Texts of the page: errors, notices, findings, and the properties of links and joints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from ..diagnostic import Severity
from ..errors import UrdftoolError
from ..finding import Finding
from ..model.elements import Robot
from ..model.pair_pose import PairPose
from .marks import find_highest_severity, format_counts
from .properties import escape_html, format_table, link_rows, list_joint_rows, shorten_name

MOST = 300
"""Maximum number of listed findings. Chosen, no source."""

SAID = 12
"""Maximum number of notices. Chosen, no source."""


def wrap_html(inner: str) -> str:
    """Wrap HTML in the font size of the page; its classes are those of ``page.css``."""
    return f"<div class='u-text'>{inner}</div>"


def format_error(error: UrdftoolError) -> str:
    """Format the error of a description that cannot be read."""
    lines = [str(error)]
    lines += [
        f"from {call.file.path}:{call.line}:{call.column}: {call.what}" for call in error.calls
    ]
    lines += error.notes
    text = "<br>".join(escape_html(line) for line in lines)
    return _format_alert(f"{text}<br><i>The page shows the last valid version.</i>", Severity.ERROR)


def format_bug(error: BaseException) -> str:
    """Format an exception of the page itself."""
    what = escape_html(f"{type(error).__name__}: {error}")
    return _format_alert(f"Bug in urdftool (not in the robot): {what}", Severity.ERROR)


def format_notices(messages: Iterable[str]) -> str:
    """Format problems with meshes, joints and links; empty if there are none."""
    lines = list(messages)
    if not lines:
        return ""
    rest = f"<br>… and {len(lines) - SAID} more" if len(lines) > SAID else ""
    text = "<br>".join(escape_html(line) for line in lines[:SAID])
    return _format_alert(text + rest, Severity.WARNING)


def _format_alert(inner: str, severity: Severity) -> str:
    return wrap_html(f"<div role='alert' class='u-alert u-{severity.label}'>{inner}</div>")


def format_summary(robot: Robot, findings: Iterable[Finding] | None) -> str:
    """Summarize the robot in one line."""
    mass = sum(link.mass for link in robot.links)
    moving = f" ({len(robot.moving_joints)} moving)" if robot.joints else ""
    words = [
        _count(len(robot.links), "link"),
        f"{_count(len(robot.joints), 'joint')}{moving}",
        f"{mass:.4g} kg",
    ]
    if findings is not None:
        words.append(format_counts(findings) or "no lint findings")
    return wrap_html(escape_html(" · ".join(words)))


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'s' * (number != 1)}"


def format_link(robot: Robot, name: str, rows: Iterable[tuple[str, str]]) -> str:
    """Format the properties of the selected link and its parent joint."""
    text = f"<b>{escape_html(name)}</b>{format_table(rows)}"
    joint = robot.tree.get_parent_joint(name)
    if joint is not None:
        text += f"<b>{escape_html(joint.name)}</b>"
        text += format_table(list_joint_rows(joint))
    return wrap_html(text)


def format_parts(robot: Robot, found: Mapping[str, list[Finding]]) -> str:
    """Format every link and every joint as a collapsible item."""
    links = "".join(
        _format_details(
            link.name, _link_hint(link.mass, found.get(link.name, [])), link_rows(robot, link)
        )
        for link in robot.links
    )
    joints = "".join(
        _format_details(joint.name, escape_html(joint.type), list_joint_rows(joint))
        for joint in robot.joints
    )
    return wrap_html(
        f"<b>{_count(len(robot.links), 'link')}</b>{links}"
        f"<b class='u-joints'>{_count(len(robot.joints), 'joint')}</b>{joints}"
    )


def _link_hint(mass: float, findings: list[Finding]) -> str:
    words = f"{mass:.4g} kg" if mass else ""
    severity = find_highest_severity(
        finding for finding in findings if finding.severity > Severity.INFO
    )
    if severity is None:
        return words
    text = format_counts(finding for finding in findings if finding.severity > Severity.INFO)
    return f"{words} <span class='u-{severity.label}'>{text}</span>"


def _format_details(name: str, hint: str, rows: Iterable[tuple[str, str]]) -> str:
    shown = escape_html(shorten_name(name) or "(no name)")
    return (
        f"<details><summary>{shown} "
        f"<span class='u-more'>{hint}</span></summary>{format_table(rows)}</details>"
    )


def format_pairs(pairs: Sequence[PairPose]) -> str:
    """Format the pairs that an SRDF disables although they can touch."""
    if not pairs:
        return wrap_html("No disabled pair was found in contact; pairs with the reason User, "
                         "Default or Always are not compared.")  # fmt: skip
    items = "".join(
        _format_details(
            f"{shorten_name(pair.link1, 30)}, {shorten_name(pair.link2, 30)}",
            escape_html(pair.reason),
            [(name, f"{value:.4f}") for name, value in pair.positions.items()],
        )
        for pair in pairs
    )
    counted = _count(len(pairs), "disabled pair")
    return wrap_html(f"<b>{counted} can touch</b>, at positions [rad, m]:{items}")


def format_findings(findings: list[Finding] | None, found: Mapping[str, list[Finding]]) -> str:
    """Format the findings, the most severe first; None while lint is running."""
    if findings is None:
        return wrap_html("linting …")
    if not findings:
        return wrap_html("no lint findings")
    on: dict[int, list[str]] = {}
    for link, those in found.items():
        for finding in those:
            on.setdefault(id(finding), []).append(link)
    ordered = sorted(findings, key=lambda finding: -finding.severity)
    items = "".join(_format_finding(finding, on.get(id(finding), [])) for finding in ordered[:MOST])
    more = f"<p>… and {len(findings) - MOST} more</p>" if len(findings) > MOST else ""
    return wrap_html(f"<b>{escape_html(format_counts(findings))}</b>{items}{more}")


def _format_finding(finding: Finding, links: list[str]) -> str:
    kind = finding.severity.label
    where = f" · on {', '.join(shorten_name(link, 30) for link in links[:4])}" if links else ""
    more = " …" if len(links) > 4 else ""
    times = f" (in {finding.expansions} expansions)" if finding.expansions > 1 else ""
    return (
        f"<div class='u-finding u-{kind}'><b class='u-{kind}'>{kind}</b> "
        f"{escape_html(finding.message + times)}<br>"
        f"<span class='u-more'>{escape_html(str(finding.location))} "
        f"[{escape_html(finding.code)}]{escape_html(where + more)}</span></div>"
    )
