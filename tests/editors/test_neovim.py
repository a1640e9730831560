"""A session in Neovim, without a screen, which docs/editors.md shows."""

import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.conftest import FIXTURES, ROOT

SESSION = Path(__file__).with_name("session.lua")
PAGE = (ROOT / "docs" / "editors.md").read_text("utf-8")
CALL = "xacro:arm_link name"
NEOVIM = shutil.which("nvim")  # tests see few programs


@pytest.mark.slow
@pytest.mark.skipif(NEOVIM is None, reason="Neovim, nvim, is not installed")
@pytest.mark.skipif(find_spec("pygls") is None, reason="it needs the extra 'server'")
def test_a_robot_is_opened_jumped_in_fixed_and_renamed(tmp_path):
    shutil.copytree(FIXTURES / "robots" / "demo_arm", tmp_path / "demo_arm")
    record = tmp_path / "record.txt"
    variables = {
        **os.environ,
        "URDFTOOL": f"{sys.executable} -m urdftool",
        "ROBOT": str(tmp_path / "demo_arm/urdf/arm.urdf.xacro"),
        "RECORD": str(record),
        "FIX": "unknown-attribute",
        "JUMP": CALL,
        "JUMP_OFFSET": "8",
        "RENAME": CALL,
        "RENAME_OFFSET": "8",
        "NEW_NAME": "tube_link",
    }
    words = [NEOVIM, "--clean", "-n", "--headless", "-c", f"luafile {SESSION}"]
    done = subprocess.run(words, env=variables, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr + record.read_text()
    recorded = re.search(r"<!-- recording: neovim -->\n\n```text\n(.*?)```", PAGE, re.DOTALL)
    assert record.read_text() == recorded[1]
