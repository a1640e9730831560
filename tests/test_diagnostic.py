"""Diagnostics: their data, and the deprecated names of their attributes."""

import math

import pytest

from urdftool.diagnostic import Diagnostic, Fix, Severity, freeze
from urdftool.finding import Finding
from urdftool.source.location import Place, SourceFile

PLACE = Place(SourceFile("r.urdf", b"<robot/>"), 0, 8, ())


@pytest.mark.parametrize(
    ("old", "new", "value"), [("rule", "code", "zero-axis"), ("place", "location", PLACE)]
)
def test_old_names_of_a_finding_can_be_read(old, new, value):
    finding = Finding("zero-axis", Severity.ERROR, "the axis is zero", PLACE)
    with pytest.warns(DeprecationWarning, match=f"'{old}' is now '{new}'"):
        assert getattr(finding, old) == value
    assert getattr(finding, new) == value


def test_the_first_fix_is_the_best():
    best, other = Fix(True, "write 1", ()), Fix(False, "remove it", ())
    assert Diagnostic("a", Severity.INFO, "…", fixes=(best, other)).fix is best
    assert Diagnostic("a", Severity.INFO, "…").fix is None


def test_frozen_data_is_equal_where_the_data_is():
    data = {"links": ["a", "b"], "size": (1, 2.5), "of": {"x": None}}
    assert freeze(data) == freeze({"of": {"x": None}, "size": [1, 2.5], "links": ("a", "b")})
    assert freeze(data) != freeze({**data, "links": ["b", "a"]})
    assert freeze({"mass": math.nan}) == freeze({"mass": float("nan")})
    assert hash(freeze(data)) == hash(freeze(dict(data)))
