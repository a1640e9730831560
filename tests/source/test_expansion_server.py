"""Expansions in processes that are prepared before: equal results, and the same walls."""

import os
import signal
import sys
import time

import pytest

from tests.source.test_expansion_process import (
    ATTEMPTS,
    ENDLESS,
    XACRO,
    _has_landlock,
    path,
    run_in_process,
)
from tests.source.test_last_expansion import (
    CHANGES,
    MAIN,
    check_defect,
    expand_with,
    folder,
    list_facts,
)
from urdftool.errors import XacroError
from urdftool.source import expansion_json, expansion_server, limits
from urdftool.source.document import read_file
from urdftool.source.expand import expand_xacro
from urdftool.source.expansion_server_child import serve_connection
from urdftool.source.packages import Packages
from urdftool.workspace import Workspace

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the process is a fork on Linux")
__all__ = ["folder", "path"]


class Fork:
    """The process as a fork of this one, in which functions may be replaced."""

    def __init__(self, connection):
        self.pid = os.fork()
        if not self.pid:
            os.dup2(connection.fileno(), 3)
            os.closerange(4, 1000)
            connection.detach()
            serve_connection(type(connection)(fileno=3))
            os._exit(0)

    def kill(self):
        os.kill(self.pid, signal.SIGKILL)

    def wait(self):
        return os.waitpid(self.pid, 0)[1]


@pytest.fixture
def base():
    workspace = Workspace()
    workspace.expansion_server = expansion_server.ExpansionServer(Fork, at_once=True)
    yield workspace
    workspace.expansion_server.close()


def expand(path, workspace):
    workspace.expansion_server.prepare()
    workspace = workspace.get_with_overlay({})
    return expand_xacro(
        read_file(str(path), workspace), {}, Packages(str(path), workspace=workspace)
    )


def test_an_expansion_is_as_without_the_server(folder, base):
    for changes in ({}, {"main.xacro": MAIN.replace("end", "last")}, *CHANGES.values()):
        found = []
        for workspace in (base, Workspace()):
            found.append(list_facts(expand_with(workspace, folder, changes)))
        assert found[0] == found[1]
        base.expansion_server.prepare()
    assert base.expansion_server.used > 0


def test_only_nodes_that_changed_are_read_again(folder, base, monkeypatch):
    read = []

    class Piece(expansion_json.Piece):
        def __init__(self, text):
            read.append(text)
            super().__init__(text)

    monkeypatch.setattr(expansion_json, "Piece", Piece)
    for changes in ({}, {"main.xacro": MAIN.replace('"end"', '"last"')}):
        read.clear()
        expand_with(base, folder, changes)
        base.expansion_server.prepare()
    assert len(read) == 1
    assert b'"last"' in read[0]


PREFIXED = MAIN.replace(
    '<link name="end"/>', '<link name="end"><xacro:element xacro:name="q:b"/></link>'
)


@pytest.mark.parametrize(
    ("before", "text", "message"),
    [
        (MAIN, MAIN.replace('"end"', """"${'\\x01'}\""""), "XML does not allow"),
        (
            PREFIXED.replace("<robot", '<robot xmlns:q="y"'),
            PREFIXED.replace("end", "last"),
            "prefix of 'q:b'",
        ),
        (PREFIXED.replace("<robot", '<robot xmlns:q="y"'), PREFIXED, "prefix of 'q:b'"),
    ],
)
def test_a_tree_that_cannot_be_written_is_reported_each_time(folder, base, before, text, message):
    expand_with(base, folder, {"main.xacro": before})
    for _ in range(2):
        base.expansion_server.prepare()
        with pytest.raises(XacroError, match=message):
            expand_with(base, folder, {"main.xacro": text})


@pytest.mark.parametrize("text", ["<robot>", "<robot xmlns:xacro='x'><a b='${1 +}'/></robot>"])
def test_a_defect_is_reported_as_without_the_server(folder, base, text):
    check_defect(base, folder, text)


def test_the_process_has_no_files_programs_network_or_environment(path, base, monkeypatch, capfd):
    needs_landlock = () if _has_landlock() else ("signal", "list", "remove")

    def work(run):
        done = [name for name in ATTEMPTS if name not in needs_landlock and _succeeds(name)]
        return f"done: {done} {dict(os.environ)}"

    run_in_process(monkeypatch, work)
    with pytest.raises(XacroError):  # there is no tree
        expand(path, base)
    assert "done: [] {}" in capfd.readouterr().err


def _succeeds(name):
    try:
        ATTEMPTS[name]()
    except OSError:
        return False
    return True


@pytest.mark.slow
def test_one_step_that_does_not_end_is_ended_at_its_element(path, base, monkeypatch):
    monkeypatch.setattr(limits, "TOTAL_SECONDS", 1.0)
    path.write_text(XACRO.format(ENDLESS + '\n<link name="${python.set([(a20,) * 40000])}"/>'))
    with pytest.raises(XacroError, match="more than 1 s of CPU time") as caught:
        expand(path, base)
    assert caught.value.line == 2


def test_memory_is_limited_by_the_system(path, base, monkeypatch):
    monkeypatch.setattr(limits, "MEMORY", 64 << 20)
    path.write_text(XACRO.format('\n<link name="${[[x] * 99999 for x in python.range(999)]}"/>'))
    with pytest.raises(XacroError, match="memory") as caught:
        expand(path, base)
    assert caught.value.line == 2


def test_an_expansion_goes_on_without_a_server_that_was_killed(path, base):
    text = expand(path, base).text
    base.expansion_server._process.kill()
    assert [expand(path, base).text for _ in range(2)] == [text] * 2


def test_a_server_that_ends_again_and_again_is_not_started_any_more(path, base, monkeypatch):
    monkeypatch.setattr(expansion_server, "_MAX_STARTS", 2)
    for _ in range(4):
        assert 'name="2"' in expand(path, base).text
        base.expansion_server.close()
    assert base.expansion_server._starts == 2


def test_the_server_starts_after_the_first_expansion(path):
    workspace = Workspace()
    workspace.expansion_server = server = expansion_server.ExpansionServer(Fork)
    for starts in (0, 1, 1):
        assert 'name="2"' in expand(path, workspace).text
        assert server._starts == starts
    server.close()


def test_yaml_and_other_encodings_are_imported_before_the_walls(tmp_path, base):
    (tmp_path / "c.yaml").write_text("a: 1\n")
    latin = '<?xml version="1.0" encoding="cp1250"?>' + XACRO.format('<link name="\u0159"/>')
    (tmp_path / "part.xacro").write_bytes(latin.encode("cp1250"))
    main = tmp_path / "main.xacro"
    include = '<xacro:include filename="part.xacro"/>'
    main.write_text(XACRO.format(include + "<link name=\"a${xacro.load_yaml('c.yaml').a}\"/>"))
    for _ in range(3):
        text = expand(main, base).text
        assert 'name="\u0159"' in text
        assert 'name="a1"' in text


@pytest.mark.slow
def test_files_that_were_not_used_for_a_while_are_dropped(folder, base, monkeypatch):
    monkeypatch.setattr(expansion_server, "MAX_KEPT", 400)
    expand_with(base, folder, {})
    for count in range(2):
        changed = {"b.xacro": f"<!-- {count} -->" + CHANGES["an included file"]["b.xacro"]}
        found = [list_facts(expand_with(one, folder, changed)) for one in (base, Workspace())]
        assert found[0] == found[1]
        base.expansion_server.prepare()
    kept = base.expansion_server._kept
    assert 0 < sum(len(data) for _, data in kept) <= 400


def count_descriptors():
    return len(os.listdir("/proc/self/fd"))


def test_nothing_is_left_of_the_processes(path):
    before = count_descriptors()
    workspace = Workspace()
    workspace.expansion_server = server = expansion_server.ExpansionServer(at_once=True)
    for _ in range(3):
        assert 'name="2"' in expand(path, workspace).text
    pid = server._process.pid
    server.close()
    assert count_descriptors() == before
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_the_processes_end_with_the_connection(path, base):
    expand(path, base)
    base.expansion_server.prepare()
    pid = base.expansion_server._process.pid
    base.expansion_server._connection.close()
    until = time.monotonic() + 30
    while os.waitpid(pid, os.WNOHANG) == (0, 0):
        assert time.monotonic() < until
        time.sleep(0.01)
    base.expansion_server._process.kill = base.expansion_server._process.wait = lambda: 0
