"""The page of the format has its pictures."""

from tests.conftest import ROOT

PAGE = ROOT / "docs" / "formats" / "mjcf.md"


def test_pictures_are_there():
    for name in ("so100.png", "mobile_manipulator.png"):
        assert name in PAGE.read_text("utf-8")
        assert (PAGE.parent / name).stat().st_size < 200_000
