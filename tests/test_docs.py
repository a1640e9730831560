import ast
import re
import shutil
from importlib.util import find_spec

import generate
import pytest
from generator import rule_pages
from generator.console import BLOCK, insert_output, is_same, list_pages, read_mode

from tests import stand_ins
from tests.conftest import ROOT
from urdftool.rules import get_rule
from urdftool.rules.old_names import RENAMED_RULES

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/**/*.md"))]
RUN = [path for path in list_pages() if BLOCK.search(path.read_text("utf-8"))]


def named(path):
    return str(path.relative_to(ROOT))


def of_pages(slow):
    """The pages with commands, slow ones marked as such."""
    for page in RUN:
        is_slow = read_mode(page.read_text("utf-8")).slow
        if is_slow == slow:
            yield pytest.param(page, id=named(page), marks=[pytest.mark.slow] if slow else [])


def test_generated_pages_are_fresh():
    wrong = [named(path) for path in generate.find_stale()]
    assert wrong == [], "run make docs"


@pytest.mark.parametrize("page", [*of_pages(slow=False), *of_pages(slow=True)])
def test_commands_print_what_is_shown(page):
    text = page.read_text("utf-8")
    if not read_mode(text).is_possible:
        pytest.skip(f"it needs {', '.join(read_mode(text).needs)}")
    new = insert_output(text)
    if not is_same(text, new, read_mode(text)):
        assert text == new, "run make docs"


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#]+)\)", page.read_text("utf-8")):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", [page for page in PAGES if page.parent.name == "commands"])
def test_a_page_of_a_command_has_its_help(page):
    assert generate.BEGIN in page.read_text("utf-8")


def test_a_page_of_a_rule_that_does_not_exist_is_refused(capsys):
    assert generate.write_rules(["nix"]) == 2
    assert generate.write_rules(["zero_axis"]) == 2
    err = capsys.readouterr().err
    assert err == (
        "no rule is called 'nix'; make rule NAME=… FILE=… adds one\n"
        "no rule is called 'zero_axis'; did you mean 'zero-axis'?\n"
    )


def test_every_command_has_a_page():
    for name in generate.cli.COMMANDS:
        assert (ROOT / "docs" / "commands" / f"{name}.md").exists(), name


@pytest.mark.parametrize("rule", ["axis-not-unit", "adjacent-pair-not-disabled"])
def test_a_rule_page_shows_the_changed_lines_and_folds_the_robot(rule):
    page = rule_pages.write_page(get_rule(rule))
    shown, folded = page.split("<details>", 1)
    difference = shown.split("```diff")[1]
    assert re.search(r"^[-+] +<\w", difference, re.MULTILINE)
    assert "<robot" not in shown
    assert folded.count("<details>") == 1
    assert folded.count("</details>") == 2
    assert "<robot" in folded


def test_redirects_lead_to_pages():
    text = (ROOT / "docs" / "conf.py").read_text("utf-8")
    redirects = ast.literal_eval(re.search(r"RENAMED_PAGES = (\{.*?\})", text)[1])
    redirects |= {f"rules/{a}": f"rules/{b}" for a, b in RENAMED_RULES.items()}
    for old, new in redirects.items():
        assert not (ROOT / "docs" / f"{old}.md").exists()
        assert (ROOT / "docs" / f"{new}.md").exists()


def test_the_readme_is_short():
    assert len((ROOT / "README.md").read_text("utf-8").splitlines()) < 150


def test_how_a_page_is_run():
    said = read_mode("# Title\n\n<!-- run: slow, needs mujoco, numbers vary -->\n")
    assert said.slow
    assert said.needs == ("mujoco",)
    assert said.numbers_vary
    assert read_mode("# Title\n").is_possible
    assert not read_mode("<!-- run: needs no_such_library -->").is_possible
    with pytest.raises(AssertionError):
        read_mode("<!-- run: slowly -->")


def test_words_count_where_numbers_vary():
    shown = "```console\n$ x\nlink   0.31 s\n```\n"
    vary = read_mode("<!-- run: numbers vary -->")
    assert is_same(shown, shown.replace("0.31 s", "12 s"), vary)
    assert not is_same(shown, shown.replace("link", "joint"), vary)
    assert not is_same(shown, shown + "more", vary)
    assert not is_same(shown, shown.replace("0.31", "12"), read_mode(""))


def test_progress_is_not_output():
    lines = r"3 of 5 meshes, 2 s: a.stl, b.stl\n3 of 3 links, 2 s\nthe result (checked in 8 s)\n"
    shown = insert_output(f"```console\n$ printf '{lines}'\n```\n")
    assert shown.splitlines()[2:] == ["the result", "```"]


def python_blocks():
    found = []
    for page in list_pages():
        codes = re.findall(r"```python\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
        if codes and "import urdftool" in codes[0]:
            for number, code in enumerate(codes):
                if "import " in code:
                    marks = [pytest.mark.slow] if "simplify_collisions" in code else []
                    found.append(pytest.param(code, id=f"{named(page)}-{number}", marks=marks))
    return found


@pytest.fixture(scope="module")
def examples(tmp_path_factory):
    """A folder with the files that examples name; each example has a copy of it."""
    return stand_ins.make(tmp_path_factory.mktemp("stand_ins"))


@pytest.mark.parametrize("code", python_blocks())
def test_python_of_the_pages_runs(code, examples, tmp_path, monkeypatch, capsys):
    shutil.copytree(examples, tmp_path / "here", symlinks=True)
    monkeypatch.chdir(tmp_path / "here")
    exec(code, {})
    assert capsys.readouterr().out.strip()


@pytest.mark.slow
@pytest.mark.skipif(find_spec("sphinx") is None, reason="pip install '.[docs]'")
def test_the_site_builds_without_a_warning(tmp_path):
    from sphinx.cmd.build import build_main

    words = ["-q", "-W", "-n", "-b", "html", "-d", str(tmp_path / "trees")]
    assert build_main([*words, str(ROOT / "docs"), str(tmp_path / "site")]) == 0
    pages = list((tmp_path / "site").rglob("*.html"))
    assert len(pages) > 270
    for page in pages:
        text = page.read_text("utf-8")
        loaded = re.findall(r'<(?:script|img|link)\b[^>]*?(?:src|href)="(https?:[^"]+)"', text)
        assert loaded == [], page
    assert "howto/untrusted-input.html" in (tmp_path / "site/howto/strangers.html").read_text()
    rule = (tmp_path / "site/rules/axis-not-unit.html").read_text("utf-8")
    assert "--fix --unsafe-fixes" in re.sub(r"<[^>]+>", "", rule)


def test_promises_have_tests():
    """The tests that a page names exist, in files that run."""
    text = (ROOT / "docs" / "howto" / "untrusted-input.md").read_text("utf-8")
    rows = [row for row in text.splitlines() if "`tests/" in row]
    assert len(rows) >= 20
    for row in rows:
        assert row.startswith("| "), row
        for path, name in re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", row):
            tree = ast.parse((ROOT / path).read_text("utf-8"))
            functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
            assert name in functions, f"{path}::{name}"
        assert row.count("`tests/") == len(re.findall(r"`tests/[\w/]+\.py::\w+`", row)), row
