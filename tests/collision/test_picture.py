"""Labels on pictures of collision geometry."""

import io

import numpy as np
from PIL import Image

from urdftool.collision.picture import SIZE, draw_side_by_side
from urdftool.drawing.shapes import make_bare_shapes
from urdftool.geometry.tessellate import tessellate
from urdftool.model.pose import IDENTITY


def test_both_halves_have_a_label():
    box = make_bare_shapes([(*tessellate("box", (1, 1, 1)), (0.5, 0.5, 0.5, 1.0))])
    picture = draw_side_by_side(box, {"": IDENTITY}, box, right_label="collision geometry: 1 piece")
    bare = draw_side_by_side(box, {"": IDENTITY}, box, right_label="")
    pixels, without = (np.array(Image.open(io.BytesIO(data))) for data in (picture, bare))
    half = SIZE[0]
    assert (pixels[:40, :half].min(axis=2) < 100).sum() > 100
    assert (pixels[:40, half + 2 :].min(axis=2) < 100).sum() > 100
    assert (without[:40, half + 2 :].min(axis=2) < 100).sum() == 0
    assert np.array_equal(pixels[60:], without[60:])
