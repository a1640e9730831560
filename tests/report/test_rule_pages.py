"""Pages of rules on the terminal."""

import re

import pytest

from urdftool.report.rule_pages import format_page, format_rule_list, remove_markup
from urdftool.rules import FAMILY_OF


@pytest.mark.parametrize("name", FAMILY_OF)
def test_a_page_has_no_marks_of_code(name):
    text = format_page(name)
    assert "`" not in text
    assert not re.search(r"^\.\. |::$", text, re.MULTILINE)


def test_the_list_has_no_marks_of_code():
    assert "`" not in format_rule_list()
    assert "<limit>" in format_rule_list()


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("``<axis>`` is wrong", "<axis> is wrong"),
        (":func:`~urdftool.load` reads it", "load reads it"),
        ("see :class:`Rule`", "see Rule"),
    ],
)
def test_marks_of_a_docstring_are_removed(text, shown):
    assert remove_markup(text) == shown
