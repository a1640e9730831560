"""A run that skipped many tests fails: green must not mean that little was run."""

from types import SimpleNamespace

import pytest

from tests import conftest


class Reporter:
    """Counts of a run, and what was written after it."""

    def __init__(self, skipped):
        self.stats = {"skipped": [None] * skipped}
        self.lines = []

    def write_line(self, line, **markup):
        self.lines.append(line)


@pytest.mark.parametrize("more", [0, 1])
@pytest.mark.parametrize("role", ["alone", "worker"])
def test_a_run_fails_that_skipped_too_many(monkeypatch, tmp_path, more, role):
    monkeypatch.setattr(conftest, "CORPUS", tmp_path)
    monkeypatch.setattr(conftest.extras, "is_installed", lambda library: True)
    reporter = Reporter(conftest.MOST_SKIPPED + more)
    manager = SimpleNamespace(get_plugin={"terminalreporter": reporter}.get)
    config = SimpleNamespace(pluginmanager=manager)
    if role == "worker":
        config.workerinput = {}
    session = SimpleNamespace(config=config, exitstatus=pytest.ExitCode.OK)
    conftest.pytest_sessionfinish(session)
    fails = more and role == "alone"
    assert session.exitstatus == (pytest.ExitCode.TESTS_FAILED if fails else pytest.ExitCode.OK)
    assert len(reporter.lines) == bool(fails)
