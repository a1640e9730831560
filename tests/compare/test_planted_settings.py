"""A sample of the planted changes of settings, sensors, actuators and plugins."""

import pytest

from measure.planted_settings.__main__ import CHANGES, measure

EVERY = 9


@pytest.mark.parametrize("form", ["sdf", pytest.param("mjcf", marks=pytest.mark.library("mujoco"))])
def test_planted_changes_are_named_at_their_part(form, tmp_path):
    untouched, *results = measure(form, CHANGES[form][EVERY // 2 :: EVERY], tmp_path)
    assert untouched.titles == []
    assert [result.planted.what for result in results if not result.is_named] == []
    assert len(results) >= 5
