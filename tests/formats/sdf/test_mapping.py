"""The page of the mapping says what the code does."""

import re

from tests.conftest import ROOT

PAGE = ROOT / "docs" / "formats" / "sdf.md"
SOURCES = sorted((ROOT / "urdftool" / "formats" / "sdf").glob("*.py"))


def test_every_loss_is_on_the_page(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "docs")
    from generator.sdf_mapping import LOSSES

    code = "".join(path.read_text("utf-8") for path in SOURCES)
    used = set(re.findall(r't\.(?:report_loss|report_note)\(\s*"([a-z0-9-]+)"', code))
    used |= set(re.findall(r't\.report_loss if [^"]*"([a-z0-9-]+)"', code))
    used |= {"safety", "calibration"}  # by a variable
    used |= {"free-base", "welded-base"}  # before the translation
    used |= set(re.findall(r'else t\.(?:report_loss|report_note)\)\("([a-z0-9-]+)"', code))
    assert used == set(LOSSES)


def test_the_numbers_of_the_page_are_good_enough():
    rows = re.findall(r"^\| 68 \| (keep|lump) \| (.*) \|$", PAGE.read_text("utf-8"), re.MULTILINE)
    assert [mode for mode, _ in rows] == ["keep", "lump"]
    for _, cells in rows:
        *_, equal, unannounced = (int(cell) for cell in cells.split(" | "))
        assert equal >= 64
        assert unannounced == 0
