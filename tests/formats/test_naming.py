"""Names that are taken: which comes next."""

from itertools import islice

import pytest

from urdftool.formats.common.naming import (
    UniqueNames,
    get_first_free,
    get_free_name,
    list_numbered_names,
    replace_file_name,
)


def test_numbers_come_before_a_suffix():
    assert list(islice(list_numbered_names("arm", suffix=".stl"), 2)) == ["arm_2.stl", "arm_3.stl"]
    assert next(list_numbered_names("arm", 1)) == "arm_1"


def test_a_free_name_stays():
    assert get_free_name("arm", {"leg"}) == "arm"
    assert get_free_name("arm", {"arm", "arm_2", None}) == "arm_3"
    assert get_first_free(["arm", "leg"], ("arm",)) == "leg"


def test_candidates_are_tried_before_numbers():
    names = UniqueNames(("arm",))
    taken = [names.take("arm", "arm_link") for _ in range(3)]
    assert taken == ["arm_link", "arm_link_1", "arm_link_2"]


def test_a_name_without_letters_is_unnamed():
    assert UniqueNames().take("", "") == "unnamed_1"
    assert replace_file_name("..--") == "unnamed"


@pytest.mark.parametrize(("fold", "second"), [(True, "ARM_1"), (False, "ARM")])
def test_case_counts_only_where_files_have_it(fold, second):
    names = UniqueNames(fold=fold)
    assert names.take("arm") == "arm"
    assert names.take("ARM") == second
