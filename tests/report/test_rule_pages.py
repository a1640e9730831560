"""Pages of rules on the terminal."""

import pytest

from urdftool.report.rule_pages import page, rule_list
from urdftool.rules import FAMILY_OF


@pytest.mark.parametrize("name", FAMILY_OF)
def test_a_page_has_no_marks_of_code(name):
    assert "``" not in page(name)


def test_the_list_has_no_marks_of_code():
    assert "``" not in rule_list()
    assert "<limit>" in rule_list()
