"""Pictures of a robot with labels of findings at its links."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..diagnostic import Severity
from ..drawing.camera import Camera, View
from ..drawing.picture import SIZE, draw
from ..drawing.png_file import Image
from ..drawing.raster import Floats
from ..drawing.shapes import Shapes
from ..drawing.text import replace_undrawable
from ..finding import Finding
from ..model.elements import Robot
from ..model.pose import Pose
from .marks import format_counts, group_by_link

MOST = 10
"""Labels of a picture. Chosen, no source: more of them are not legible."""

_COLORS = {
    Severity.ERROR: (179, 38, 30),
    Severity.WARNING: (178, 116, 0),
    Severity.INFO: (31, 95, 168),
}
_INK, _PAPER, _SOFT = (29, 36, 48), (255, 255, 255), (91, 102, 117)
"""Colors of text, labels and remarks, 0 … 255. Chosen, no source."""

_ROBOT_WIDTH = 0.46
"""Part of the picture between both columns of labels. Chosen, no source."""

_TINT = 0.65
"""Weight of the color of a severity in that of its link. Chosen, no source."""

_GRAY = 0.72
"""Brightness of links without findings, 0 … 1. Chosen, no source."""

_LETTERS = 48
"""Most characters of a line of a label. Chosen, no source."""

_LINES = 3
"""Most lines of the message of a label. Chosen, no source."""

_HEIGHT = 960
"""Height of a picture [pixels] for which the sizes below are. Chosen, no source."""

_TITLE, _TEXT, _STEP, _PAD = 19, 17, 22, 10
"""Letters of the rule and of the message, a line, and a margin [pixels]. Chosen, no source."""


@dataclass
class _Label:
    """A finding, the point of its link, and the place of its text in pixels."""

    finding: Finding
    anchor: tuple[float, float]
    lines: list[str]
    row: float = 0.0
    side: int = 0

    def measure(self, scale: float) -> float:
        """Return the height in pixels."""
        return ((len(self.lines) + 1) * _STEP + 2 * _PAD) * scale


def draw_findings(
    robot: Robot,
    shapes: Shapes,
    poses: Mapping[str, Pose],
    findings: Sequence[Finding],
    *,
    camera: Camera | None = None,
    size: tuple[int, int] = SIZE,
) -> Image:
    """Draw a robot in gray, links with findings in the color of the most severe, and labels.

    Returns:
        Pixels, shape (height, width, 3).
    """
    by_link = group_by_link(robot, findings)
    view = _fit_between_labels(shapes, poses, camera or Camera(), size)
    image = draw(_tint(shapes, by_link), poses, camera=view, size=size)
    labels = list(_make_labels(shapes, poses, by_link, view))
    shown = {id(label.finding) for label in labels}
    rest = [finding for finding in findings if id(finding) not in shown]
    _place(labels, size)
    return _write(image, labels, rest)


def _fit_between_labels(
    shapes: Shapes, poses: Mapping[str, Pose], camera: Camera, size: tuple[int, int]
) -> View:
    corners, _, there = shapes.transform(poses)
    narrow = max(8, round(size[0] * _ROBOT_WIDTH))
    view = camera.view(corners[there].reshape(-1, 3), (narrow, size[1]))
    return View(view.axes, view.eye, (view.reach[0] * size[0] / narrow, view.reach[1]), size)


def _tint(shapes: Shapes, by_link: Mapping[str, Sequence[Finding]]) -> Shapes:
    """Return the shapes in gray, and in a mixture with the color of the severity of their link."""
    colors = np.array(shapes.colors)
    colors[:, :3] = _GRAY
    for row, name in enumerate(shapes.links):
        if found := by_link.get(name):
            severity = max(finding.severity for finding in found)
            tone = np.array(_COLORS[severity]) / 255
            colors[shapes.link == row, :3] = _GRAY * (1 - _TINT) + tone * _TINT
    return shapes.with_colors(colors)


def _make_labels(
    shapes: Shapes, poses: Mapping[str, Pose], by_link: Mapping[str, Sequence[Finding]], view: View
) -> Iterator[_Label]:
    """Yield a label for each of the most severe findings, at the first link that it concerns."""
    first: dict[int, tuple[Finding, str]] = {}
    for link, found in by_link.items():
        for finding in found:
            first.setdefault(id(finding), (finding, link))
    ordered = sorted(first.values(), key=lambda pair: -pair[0].severity)
    for finding, link in ordered[:MOST]:
        point = _find_center(shapes, poses, link)
        if point is not None:
            column, row = view.project(point)
            yield _Label(finding, (float(column), float(row)), _wrap(finding.message, view.size))


def _find_center(shapes: Shapes, poses: Mapping[str, Pose], link: str) -> Floats | None:
    """Return the center of the geometry of a link [m], or its origin; None without a pose."""
    pose = poses.get(link)
    if pose is None:
        return None
    row = shapes.links.index(link) if link in shapes.links else -1
    corners = shapes.corners[shapes.link == row].reshape(-1, 3)
    center = (corners.min(axis=0) + corners.max(axis=0)) / 2 if len(corners) else np.zeros(3)
    return np.asarray(np.array(pose.rotation) @ center + np.array(pose.translation))


def _wrap(message: str, size: tuple[int, int]) -> list[str]:
    """Split a message into lines that fit a label; a long one is cut."""
    from PIL import ImageFont

    text, font = replace_undrawable(message), ImageFont.load_default(_TEXT)
    width = size[0] * _HEIGHT / size[1] * (1 - _ROBOT_WIDTH) / 2 - 4 * _PAD
    lines: list[str] = []
    for letters in range(_LETTERS, 8, -2):
        lines = textwrap.wrap(text, letters, max_lines=_LINES, placeholder=" …")
        if all(font.getlength(line) <= width for line in lines):
            break
    return lines


def _place(labels: Sequence[_Label], size: tuple[int, int]) -> None:
    """Assign labels to both columns, from top to bottom, without overlap."""
    scale = size[1] / _HEIGHT
    by_column = sorted(labels, key=lambda label: label.anchor[0])
    half = (len(by_column) + 1) // 2
    for side, some in enumerate((by_column[:half], by_column[half:])):
        some.sort(key=lambda label: label.anchor[1])
        total = sum(label.measure(scale) for label in some)
        gap = max(0.0, (size[1] * 0.92 - total) / max(1, len(some)))
        row = gap / 2
        for label in some:
            label.side, label.row = side, row
            row += label.measure(scale) + gap


def _write(image: Image, labels: Iterable[_Label], rest: Sequence[Finding]) -> Image:
    """Draw labels with lines to their links, and the number of the other findings."""
    from PIL import Image as Pillow
    from PIL import ImageDraw, ImageFont

    canvas = Pillow.fromarray(image)
    pen = ImageDraw.Draw(canvas)
    height, width = image.shape[:2]
    scale = height / _HEIGHT
    title, text = (ImageFont.load_default(max(8, height_ * scale)) for height_ in (_TITLE, _TEXT))
    wide = width * (1 - _ROBOT_WIDTH) / 2 - _PAD * scale
    for label in labels:
        color = _COLORS[label.finding.severity]
        left = _PAD * scale if label.side == 0 else width - wide
        box = (left, label.row, left + wide - _PAD * scale, label.row + label.measure(scale))
        edge = box[2] if label.side == 0 else box[0]
        x, y = label.anchor
        dot = 5 * scale
        pen.line(
            [(edge, (box[1] + box[3]) / 2), (x, y)], fill=color, width=max(1, round(2 * scale))
        )
        pen.ellipse((x - dot, y - dot, x + dot, y + dot), fill=color, outline=_PAPER)
        pen.rounded_rectangle(box, 6 * scale, fill=_PAPER, outline=color)
        at = (box[0] + _PAD * scale, box[1] + _PAD * scale * 0.7)
        pen.text(at, label.finding.code, fill=color, font=title)
        for number, line in enumerate(label.lines, 1):
            pen.text((at[0], at[1] + number * _STEP * scale), line, fill=_INK, font=text)
    if rest:
        words = f"and {format_counts(rest)} without a label"
        at = (_PAD * scale, height - (_STEP + _PAD) * scale)
        pen.text(at, words, fill=_SOFT, font=text)
    return np.array(canvas)
