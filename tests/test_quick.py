"""The list of quick tests: its files exist, and no slow test is in them."""

import subprocess
import sys

from tests.conftest import QUICK, ROOT


def test_quick_files_exist_and_cover_the_parts():
    assert [path for path in QUICK if not path.exists()] == []
    parts = {path.relative_to(ROOT / "tests").parts[0] for path in QUICK}
    assert {"compare", "fmt", "formats", "geometry", "lint", "mechanics", "rules"} <= parts


def test_other_files_are_not_collected():
    words = ["-m", "pytest", "-q", "-p", "no:xdist", "--collect-only", "-m", "quick"]
    places = ["tests/fmt", "tests/info", "tests/test_quick.py"]
    done = subprocess.run(
        [sys.executable, *words, *places], capture_output=True, text=True, cwd=ROOT
    )
    found = {line.partition("::")[0] for line in done.stdout.splitlines() if "::" in line}
    expected = {str(path.relative_to(ROOT)) for path in QUICK}
    assert found == {path for path in expected if path.startswith(("tests/fmt/", "tests/info/"))}
    assert "errors" not in done.stdout
