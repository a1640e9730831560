"""The commands that write, with a fault at each event; ``commands.py`` says what must hold."""

import json
import os
import subprocess
import sys

import pytest

from tests.conftest import ROOT
from tests.faults.commands import COMMANDS

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="forks, and reads /proc"),
]
LIBRARIES = {"usd": ["pxr"], "mjcf": ["mujoco"], "mjcf-file": ["mujoco"]}


@pytest.mark.parametrize("name", COMMANDS)
def test_the_old_or_the_new_outputs_are_there(name):
    for library in LIBRARIES.get(name, ()):
        pytest.importorskip(library)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
    words = [sys.executable, "-m", "tests.faults.commands", name]
    done = subprocess.run(
        words, capture_output=True, text=True, cwd=ROOT, env=environment, check=True
    )
    result = json.loads(done.stdout)[name]
    assert not result["problems"]
    assert result["events"] >= 15
