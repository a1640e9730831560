"""The page of verdicts is what the verdicts say."""

from tests.precision.__main__ import PAGE, VERDICTS, judged, page


def test_the_page_shows_the_verdicts():
    rows = judged()
    assert {row["verdict"] for row in rows} <= set(VERDICTS)
    assert all(row["reason"] for row in rows)
    assert PAGE.read_text("utf-8") == page(rows)
