"""Animations as GIF files."""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np

from .png_file import Image

_SEEN = 12  # pictures sampled for the palette; chosen
_COLORS = 255  # one entry is reserved for unchanged pixels


def encode_gif(frames: Sequence[Image], seconds: Sequence[float]) -> bytes:
    """Encode an endless animation with one palette as a GIF file.

    Args:
        frames: At least one picture, all of one size.
        seconds: Display time of each [s], rounded to 0.01 s, at least 0.02 s.
    """
    from PIL import Image as Pillow

    pictures = [Pillow.fromarray(frame) for frame in frames]
    some = frames[:: max(1, len(frames) // _SEEN)]
    together = Pillow.fromarray(np.concatenate([frame[::2, ::2] for frame in some]))
    palette = together.quantize(_COLORS, method=Pillow.Quantize.MEDIANCUT)
    flat = [picture.quantize(palette=palette, dither=Pillow.Dither.NONE) for picture in pictures]
    out = io.BytesIO()
    flat[0].save(
        out,
        format="GIF",
        save_all=True,
        append_images=flat[1:],
        duration=[max(20, round(100 * time) * 10) for time in seconds],
        loop=0,
        disposal=1,
        optimize=False,
    )
    return out.getvalue()
