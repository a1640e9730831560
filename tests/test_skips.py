"""How many tests were skipped, which runs last: a green run must not mean that little was run."""

import pytest

from tests.conftest import CORPUS, MOST_SKIPPED
from urdftool import extras


def test_few_tests_are_skipped(skipped_tests):
    left_out = ("dask", "robots")
    optional = {library for library, extra in extras.EXTRA_OF.items() if extra not in left_out}
    if not CORPUS.exists() or not all(map(extras.is_installed, optional)):
        pytest.skip("without the corpus and every extra, more tests are skipped")
    assert len(skipped_tests) <= MOST_SKIPPED, skipped_tests
