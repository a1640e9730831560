"""Text on pictures, in Pillow's built-in font, which is the same on every machine."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from .png_file import Image

Color = tuple[int, int, int]


class Words(NamedTuple):
    """A line of text.

    Attributes:
        text: The text.
        at: Column and row of its upper left corner.
        width: Available width in pixels; a longer text is shortened in its middle.
        height: Height of the letters in pixels.
        color: Red, green and blue, 0 … 255.
    """

    text: str
    at: tuple[int, int]
    width: int
    height: int
    color: Color = (40, 44, 52)


def draw_text(image: Image, lines: Iterable[Words]) -> Image:
    """Draw lines of text onto a copy of a picture."""
    from PIL import Image as Pillow
    from PIL import ImageDraw, ImageFont

    canvas = Pillow.fromarray(image)
    pen = ImageDraw.Draw(canvas)
    fonts: dict[int, Any] = {}
    for line in lines:
        font = fonts.setdefault(line.height, ImageFont.load_default(line.height))
        text = replace_undrawable(line.text)
        length = len(text)
        while length > 1 and pen.textlength(text, font=font) > line.width:
            length -= 1 if length < 40 else length // 8
            text = _shorten(replace_undrawable(line.text), length)
        pen.text(line.at, text, fill=line.color, font=font)
    return np.array(canvas)


def replace_undrawable(text: str) -> str:
    """Replace characters that cannot be drawn: drop accents, print controls as a middle dot."""
    plain = "".join(
        letter
        for letter in unicodedata.normalize("NFKD", text)
        if not unicodedata.combining(letter)
    )
    return "".join(letter if letter.isprintable() else "·" for letter in plain)


def _shorten(text: str, length: int) -> str:
    head = (length + 1) // 2
    return f"{text[:head]}…{text[len(text) - (length - head) :]}"
