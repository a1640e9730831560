"""The page of the format is as fresh as the code."""

from tests.conftest import ROOT
from urdftool.formats.mjcf.mapping import format_markdown

PAGE = ROOT / "docs" / "formats" / "mjcf.md"
BEGIN, END = "<!-- mapping begins -->\n", "<!-- mapping ends -->"


def fresh(text: str) -> str:
    """The page with the code's mapping; ``python -m tests.formats.mjcf.test_docs`` writes it."""
    before, _, rest = text.partition(BEGIN)
    return before + BEGIN + "\n" + format_markdown() + "\n" + END + rest.partition(END)[2]


def test_the_mapping_is_fresh():
    text = PAGE.read_text("utf-8")
    assert text == fresh(text)


def test_pictures_are_there():
    for name in ("so100.png", "mobile_manipulator.png"):
        assert name in PAGE.read_text("utf-8")
        assert (PAGE.parent / name).stat().st_size < 200_000


if __name__ == "__main__":
    PAGE.write_text(fresh(PAGE.read_text("utf-8")), "utf-8")
