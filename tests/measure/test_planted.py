"""Changes of a written model are found, each in the row that is about it."""

import pytest

from measure.planted.__main__ import PAGE, TITLES
from measure.planted.measure import CHANGES, differing


def list_changes():
    """List the changes of each format: the first of each row, and the others, which are slow."""
    for form, changes in CHANGES.items():
        rows = set()
        for planted in changes:
            marks = [pytest.mark.slow] if planted.row in rows else []
            rows.add(planted.row)
            yield pytest.param(form, planted, marks=marks, id=f"{form}: {planted.what}")


@pytest.fixture(autouse=True)
def _mujoco(request):
    if "form" in request.fixturenames and request.getfixturevalue("form") == "mjcf":
        pytest.importorskip("mujoco")


@pytest.mark.parametrize("form", CHANGES)
def test_nothing_is_found_where_nothing_is_changed(form):
    assert [(check.name, check.differing) for check in differing(form, None)] == []


@pytest.mark.parametrize(("form", "planted"), list(list_changes()))
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
