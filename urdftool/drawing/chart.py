"""Curves over time as a picture: panels one below the other, each with its axis and its names.

Drawn with Pillow, which is there anyway; Matplotlib and what it needs are 60 MB more for this.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from .lettering import shown
from .png_file import Image

Curve = npt.NDArray[np.float64]
Color = tuple[int, int, int]

COLORS: tuple[Color, ...] = (
    (31, 119, 180), (255, 127, 14), (44, 160, 44), (214, 39, 40), (148, 103, 189), (140, 86, 75),
    (227, 119, 194), (23, 190, 207),
)  # fmt: skip
"""Of curves, one after the other."""

_INK, _SOFT, _GRID, _PAPER = (40, 44, 52), (110, 116, 126), (226, 229, 233), (255, 255, 255)
_LEFT, _RIGHT, _TOP, _BOTTOM, _GAP = 96, 250, 58, 48, 34
_FINER = 2
_DASH = 9  # pixels


@dataclass(frozen=True, eq=False)
class Line:
    """A curve.

    Attributes:
        label: What it is called; an empty one is not named.
        x: Shape (n,).
        y: Shape (n,); where it is no finite number the curve has a gap.
        color: Its colour.
        dashed: Whether it is dashed.
    """

    label: str
    x: Curve
    y: Curve
    color: Color
    dashed: bool = False


@dataclass(frozen=True)
class Panel:
    """Curves with one axis.

    Attributes:
        title: What is shown, with its unit.
        lines: The curves.
        least: The least that the axis spans, so that rounding does not fill it.
    """

    title: str
    lines: tuple[Line, ...]
    least: float = 1e-6


def chart(
    title: str,
    panels: Sequence[Panel],
    *,
    label: str = "",
    mark: tuple[float, str] | None = None,
    size: tuple[int, int] = (1200, 1000),
) -> Image:
    """Panels over one horizontal axis.

    Args:
        title: Above it all.
        panels: From above.
        label: Of the horizontal axis.
        mark: Where there is a vertical line, and what is written at it.
        size: Width and height in pixels.
    """
    return _Chart(panels, size, mark).draw(title, label)


def ticks(low: float, high: float, count: int) -> list[float]:
    """Round numbers within bounds, some ``count`` of them."""
    span = high - low
    step = 10.0 ** math.floor(math.log10(span / count))
    for factor in (1, 2, 5, 10):
        if span / (step * factor) <= count:
            step *= factor
            break
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [number * step for number in range(first, last + 1)]


class _Chart:
    def __init__(
        self, panels: Sequence[Panel], size: tuple[int, int], mark: tuple[float, str] | None
    ) -> None:
        from PIL import Image as Pillow
        from PIL import ImageDraw, ImageFont

        self.panels, self.mark = panels, mark
        self.size = (size[0] * _FINER, size[1] * _FINER)
        self.canvas = Pillow.new("RGB", self.size, _PAPER)
        self.pen = ImageDraw.Draw(self.canvas)
        self.fonts = {
            name: ImageFont.load_default(height * _FINER)
            for name, height in (("title", 20), ("panel", 15), ("small", 13))
        }
        every = [line.x for panel in panels for line in panel.lines if len(line.x)]
        self.first = min((float(x.min()) for x in every), default=0.0)
        self.last = max((float(x.max()) for x in every), default=1.0)
        if self.last <= self.first:
            self.last = self.first + 1.0

    def draw(self, title: str, label: str) -> Image:
        from PIL import Image as Pillow

        self._text((_LEFT, 16), title, "title", _INK)
        width, height = (side // _FINER for side in self.size)
        room = (height - _TOP - _BOTTOM) / max(1, len(self.panels))
        for number, panel in enumerate(self.panels):
            top = _TOP + number * room + _GAP * 0.75
            box = (_LEFT, top, width - _RIGHT, top + room - _GAP)
            self._panel(panel, box, last=number == len(self.panels) - 1)
        self._text(((_LEFT + width - _RIGHT) / 2, height - 14), label, "small", _SOFT, "mm")
        whole = self.canvas.resize((width, height), Pillow.Resampling.BOX)
        return np.array(whole)

    def _panel(self, panel: Panel, box: tuple[float, float, float, float], *, last: bool) -> None:
        left, top, right, bottom = box
        low, high = _bounds(panel)
        self._text((left, top - 20), panel.title, "panel", _INK)

        def place(x: float, y: float) -> tuple[float, float]:
            along = left + (x - self.first) / (self.last - self.first) * (right - left)
            return along * _FINER, (bottom - (y - low) / (high - low) * (bottom - top)) * _FINER

        for value in ticks(low, high, 5):
            row = place(self.first, value)[1]
            self.pen.line((left * _FINER, row, right * _FINER, row), _GRID, _FINER)
            self._text((left - 8, row / _FINER), _number(value, high - low), "small", _SOFT, "rm")
        for value in ticks(self.first, self.last, 10):
            column = place(value, low)[0]
            self.pen.line((column, top * _FINER, column, bottom * _FINER), _GRID, _FINER)
            if last:
                text = _number(value, self.last - self.first)
                self._text((column / _FINER, bottom + 12), text, "small", _SOFT, "mm")
        if self.mark is not None and self.first < self.mark[0] < self.last:
            column = place(self.mark[0], low)[0]
            self._dashes([(column, top * _FINER), (column, bottom * _FINER)], _SOFT, 1)
            self._text((column / _FINER + 5, top + 9), self.mark[1], "small", _SOFT, "lm")
        for line in panel.lines:
            self._curve(line, place)
        self.pen.rectangle([side * _FINER for side in box], outline=_SOFT, width=_FINER)
        self._names(panel, right + 14, top)

    def _curve(self, line: Line, place: Any) -> None:
        points: list[tuple[float, float]] = []
        for x, y in (*zip(line.x.tolist(), line.y.tolist(), strict=True), (0.0, math.nan)):
            if math.isfinite(y):
                points.append(place(x, y))
                continue
            if len(points) > 1 and line.dashed:
                self._dashes(points, line.color, 2)
            elif len(points) > 1:
                self.pen.line(points, line.color, 2 * _FINER, joint="curve")
            points = []

    def _dashes(self, points: list[tuple[float, float]], color: Color, width: int) -> None:
        """A line that is drawn and left out in turn, whatever its points are apart."""
        gone, drawn = 0.0, True
        for (x, y), (to_x, to_y) in pairwise(points):
            length = math.hypot(to_x - x, to_y - y)
            done = 0.0
            while done < length:
                piece = min(_DASH * _FINER - gone, length - done)
                a, b = done / length, (done + piece) / length
                if drawn:
                    ends = (x + a * (to_x - x), y + a * (to_y - y))
                    further = (x + b * (to_x - x), y + b * (to_y - y))
                    self.pen.line((ends, further), color, width * _FINER)
                done += piece
                gone += piece
                if gone >= _DASH * _FINER - 1e-9:
                    gone, drawn = 0.0, not drawn

    def _names(self, panel: Panel, left: float, top: float) -> None:
        for number, line in enumerate(line for line in panel.lines if line.label):
            row = top + 8 + 17 * number
            ends = [(left * _FINER, row * _FINER), ((left + 22) * _FINER, row * _FINER)]
            if line.dashed:
                self._dashes(ends, line.color, 2)
            else:
                self.pen.line(ends, line.color, 2 * _FINER)
            self._text((left + 29, row), self._short(line.label), "small", _INK, "lm")

    def _short(self, text: str) -> str:
        room = (_RIGHT - 60) * _FINER
        kept = text = shown(text)
        while len(kept) > 4 and self.pen.textlength(kept, font=self.fonts["small"]) > room:
            half = (len(kept) - 2) // 2
            kept = f"{text[:half]}…{text[len(text) - half :]}"
        return kept

    def _text(
        self, at: tuple[float, float], text: str, font: str, color: Color, anchor: str = "la"
    ) -> None:
        spot = (at[0] * _FINER, at[1] * _FINER)
        self.pen.text(spot, shown(text), color, font=self.fonts[font], anchor=anchor)


def _bounds(panel: Panel) -> tuple[float, float]:
    """What an axis spans."""
    values = np.concatenate([np.zeros(0), *(line.y for line in panel.lines)])
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    least = max(panel.least, 1e-6 * max(abs(low), abs(high)))
    if high - low < least:
        middle = (high + low) / 2
        low, high = middle - least / 2, middle + least / 2
    margin = 0.06 * (high - low)
    return low - margin, high + margin


def _number(value: float, span: float) -> str:
    """A tick's value, no more exact than its axis is."""
    digits = max(0, 2 - math.floor(math.log10(span)))
    if digits > 5 or abs(value) >= 1e6:
        return f"{value:.3g}"
    text = f"{value:.{digits}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text in ("-0", "") else text
