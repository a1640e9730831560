"""The page that sums up the measurements says what their pages say."""

import ast
import csv
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "docs" / "measurements"
SECTIONS = (FOLDER / "index.md").read_text("utf-8").split("\n## ")[1:]
NUMBER = re.compile(r"(?<![\w.,-])\d[\d,.]*(?:e-?\d+)?(?<![.,])")


def list_pages(section):
    return [FOLDER / f"{name}.md" for name in re.findall(r"\]\(([\w-]+)\.md\)", section)]


@pytest.mark.parametrize("section", SECTIONS, ids=lambda section: section.split("\n")[0])
def test_every_number_is_on_a_page_of_the_section(section):
    pages = list_pages(section)
    assert pages
    known = {n for page in pages for n in NUMBER.findall(page.read_text("utf-8"))}
    plain = re.sub(r"\]\([^)]*\)", "", section)
    assert {n for n in NUMBER.findall(plain) if len(n) > 1} - known == set()


def test_every_page_is_summed_up():
    summed_up = {page for section in SECTIONS for page in list_pages(section)}
    assert summed_up == set(FOLDER.glob("*.md")) - {FOLDER / "index.md"}


def test_old_addresses_lead_to_the_pages():
    tree = ast.parse((ROOT / "docs" / "conf.py").read_text("utf-8"))
    [moved] = [ast.unparse(n.value) for n in tree.body if "MOVED_PAGES = " in ast.unparse(n)[:14]]
    pages = {Path(new).name for new in eval(moved, {}).values()}
    assert pages == {page.stem for page in FOLDER.glob("*.md")} - {"index"}


def test_the_page_counts_the_verdicts_of_its_rows():
    from measure.benchmarks.simulate_robots import ROWS, summarize

    rows = [line.split("\t") for line in ROWS.read_text("utf-8").splitlines()[1:]]
    page = (FOLDER / "simulate-robots.md").read_text("utf-8")
    counts, table = summarize(rows).split("\n\n")
    assert counts in page
    assert table in page


def test_the_page_of_fidelity_counts_its_rows():
    from measure.benchmarks.fidelity_page import DATA, PAGE

    rows = list(csv.DictReader(DATA.read_text("utf-8").splitlines(), delimiter="\t"))
    page = PAGE.read_text("utf-8").partition("\n<!-- usd ")[0]
    lines = [line.split(" | ") for line in page.splitlines() if line.startswith("| ")]
    tools, equal = ([cell.strip(" |") for cell in line[1:]] for line in (lines[0], lines[-1]))
    assert equal == [
        str(sum((row["tool"], row["result"]) == (tool, "equal") for row in rows)) for tool in tools
    ]
    notes = [row["notes"] for row in rows]
    unreported = sum("difference not reported" in note for note in notes)
    assert f"; in {unreported} it found a difference that was not reported as a loss." in page
    assert f" {sum('forced' in note for note in notes)} needed `--force`." in page
