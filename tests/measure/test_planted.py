"""Changes of a written model are found, each in the row that is about it."""

import pytest

from measure.planted.__main__ import PAGE, TITLES
from measure.planted.measure import CHANGES, differing

EACH = [(form, planted) for form, changes in CHANGES.items() for planted in changes]


@pytest.fixture(autouse=True)
def _mujoco(request):
    if "form" in request.fixturenames and request.getfixturevalue("form") == "mjcf":
        pytest.importorskip("mujoco")


@pytest.mark.parametrize("form", CHANGES)
def test_nothing_is_found_where_nothing_is_changed(form):
    assert [(check.name, check.differing) for check in differing(form, None)] == []


@pytest.mark.parametrize(("form", "planted"), EACH, ids=[f"{f}: {p.what}" for f, p in EACH])
def test_a_change_is_found_in_its_row(form, planted):
    assert planted.row in [check.name for check in differing(form, planted)]


@pytest.mark.parametrize("form", CHANGES)
def test_the_page_has_every_change(form):
    text = PAGE.read_text("utf-8")
    section = text.partition(f"\n## {TITLES[form]}\n")[2].partition("\n## ")[0]
    rows = [line.split(" | ") for line in section.splitlines() if line.startswith("| ")][1:]
    named = [(row[0].removeprefix("| "), row[1]) for row in rows]
    assert named == [(planted.what, planted.row) for planted in CHANGES[form]]
    assert len(named) >= 60
