"""Each attribute of MuJoCo's schema is read, compared as written, or named as not compared."""

import pytest

mujoco = pytest.importorskip("mujoco")

from measure.schema_probes import PLAIN, list_silent  # noqa: E402

EQUAL = {
    "compiler@fusestatic",  # bodies on a fixed joint become one, and move the same
    *(f"body@{name}" for name in ("axisangle", "euler", "pos", "quat", "xyaxes", "zaxis")),
    "body/joint@springref",  # the joint has no spring
}
"""Attributes that move the whole robot, or make no difference."""


@pytest.mark.parametrize(
    ("first", "step"), [(7, 36), pytest.param(0, 1, marks=pytest.mark.slow)], ids=["some", "all"]
)
def test_no_attribute_is_equal_without_a_word(tmp_path, first, step):
    found = list(list_silent(PLAIN, tmp_path, slice(first, None, step)))
    silent = {
        f"{probe.element}@{probe.attribute}" for what, probe in found if what not in ("", "?")
    }
    assert silent <= EQUAL
    assert len(found) > 150 / step
