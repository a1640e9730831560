"""Each element of SDF's schema is read, compared as written, or named as not compared."""

import pytest

from measure.sdf_probes import list_silent

EQUAL = {
    "model/pose",  # moves the whole robot
    "joint/axis/dynamics/spring_reference",  # the joint has no spring
}


@pytest.mark.parametrize(
    ("first", "step"), [(5, 32), pytest.param(0, 1, marks=pytest.mark.slow)], ids=["some", "all"]
)
def test_no_element_is_equal_without_a_word(tmp_path, first, step):
    found = list(list_silent(tmp_path, slice(first, None, step)))
    assert {path for what, path in found if what} <= EQUAL
    assert len(found) > 190 / step
