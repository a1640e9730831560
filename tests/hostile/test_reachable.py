"""What expressions reach: values, listed functions and classes, and nothing else."""

import re
import subprocess
import sys

import pytest

from tests.conftest import ROOT
from tests.hostile.walk import PLANTED


def walk(*names):
    """Walk in a process of its own; gives what is reached and not listed, and the last line."""
    line = [sys.executable, "-W", "ignore", "-m", "tests.hostile.walk", *names]
    done = subprocess.run(line, cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.splitlines(), done.stderr


def test_no_other_object_is_reached():
    bad, counts = walk()
    assert not bad, "\n".join(bad)
    expressions, kinds = map(int, re.findall(r"[0-9]+", counts))
    assert expressions > 10_000
    assert kinds > 200


@pytest.mark.slow
@pytest.mark.parametrize("name", PLANTED)
def test_an_object_that_is_not_listed_is_found(name):
    bad, _ = walk(name)
    assert any(line.endswith(f": {name}") for line in bad)
