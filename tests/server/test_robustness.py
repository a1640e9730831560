"""The server with editors, documents and processes that do not behave."""

import asyncio
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from tests.server.client import Client
from tests.server.test_half_typed import Editor
from urdftool.server.answer_stream import AnswerStream
from urdftool.server.worker_process import WorkerProcess

STUCK = """
import os, sys
from urdftool.server.answer_stream import AnswerStream
stream = AnswerStream(os.dup(1), limit=1 << 20)
while True:
    stream.write(b"x" * 65536)
"""
URDF = """<robot name="r">
  <link name="a"/><link name="b"/>
  <joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 1 1"/></joint>
</robot>
"""


def test_answers_are_kept_in_order_until_they_are_read():
    source, target = os.pipe()
    stream = AnswerStream(target)
    parts = [bytes([65 + number]) * 100_000 for number in range(20)]  # a pipe has room for 64 kB
    for part in parts:
        stream.write(part)
    left, found = sum(map(len, parts)), b""
    while left > len(found):
        found += os.read(source, 1 << 20)
    assert found == b"".join(parts)
    stream.close()
    assert not any(thread is stream._thread for thread in threading.enumerate())
    os.close(source)
    os.close(target)


def test_a_process_ends_when_its_answers_are_not_read():
    process = subprocess.Popen(
        [sys.executable, "-c", STUCK], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.wait(120) == 1
    assert "left more than 1 MiB of answers unread" in process.stderr.read()


def test_a_message_that_is_not_json_is_one_line_and_the_server_goes_on():
    sent = [b"x{\x1b", b'{"jsonrpc": "2.0", "id": 1, "method": "shutdown"}']
    done = subprocess.run(
        [sys.executable, "-m", "urdftool", "server"],
        input=b"".join(b"Content-Length: %d\r\n\r\n%s" % (len(body), body) for body in sent),
        capture_output=True,
        timeout=60,
    )
    assert done.returncode == 0
    assert b'"id": 1' in done.stdout.replace(b'"id":1', b'"id": 1')
    (line,) = done.stderr.decode().splitlines()
    assert line.startswith("urdftool: Unable to handle message: JSONDecodeError")


@pytest.mark.parametrize(
    "params",
    [
        {"textDocument": {"uri": "file:///r.urdf"}, "position": {"line": "one", "character": 0}},
        {"textDocument": {"uri": "file:///r.urdf"}, "position": {"line": -1, "character": 0}},
        {"position": {"line": 0, "character": 0}},
        {},
    ],
)
def test_malformed_parameters_are_answered_with_an_error(tmp_path, params):
    with Client(tmp_path) as client:
        answer = client.request("textDocument/hover", **params)
        assert answer["error"]["code"] == -32602
        assert client.ask("textDocument/hover", **_at(tmp_path / "none.urdf")) is None


def _at(path):
    return {
        "textDocument": {"uri": path.as_uri()},
        "position": {"line": 0, "character": 0},
    }


def test_a_large_document_is_only_parsed(tmp_path, monkeypatch):
    for module in ("knowledge", "checks"):
        monkeypatch.setattr(f"urdftool.server.{module}.MOST_BYTES", 100)
    path = tmp_path / "large.urdf"
    path.write_text(URDF)
    editor = Editor(path, URDF)
    assert [code for code, _ in editor.type(URDF)] == ["not-checked"]
    assert [code for code, _ in editor.type(URDF.replace("</robot>", ""))] == ["not-well-formed"]
    assert editor.ask("hover", position={"line": 1, "character": 15}) is None


@pytest.fixture
def path(tmp_path):
    path = tmp_path.resolve() / "r.urdf"
    path.write_text(URDF)
    return path


def list_children(process):
    """Return the processes that a process started."""
    text = Path(f"/proc/{process}/task/{process}/children").read_text("ascii")
    return [int(word) for word in text.split()]


@pytest.mark.skipif(sys.platform != "linux", reason="reads the children of a process in /proc")
def test_questions_are_answered_after_the_checking_process_was_killed(path):
    pytest.importorskip("pygls")
    with Client(path.parent) as client:
        client.open(path)
        client.wait_for(path, "axis-not-unit")
        (child,) = list_children(client.process.pid)
        os.kill(child, signal.SIGKILL)
        found = client.ask_at("textDocument/hover", path, 1, 15)
        assert "link **a**" in found["contents"]["value"]
        client.change(path, text=URDF.replace("0 1 1", "0 1 2"))
        assert any(one["code"] == "axis-not-unit" for one in client.settle(path))


@pytest.mark.skipif(sys.platform != "linux", reason="reads the children of a process in /proc")
@pytest.mark.slow
def test_a_checking_process_that_hangs_is_ended(path):
    reports = []
    outline = {"path": str(path)}

    async def ask_until_answered(worker):
        while not (found := await worker.ask("symbols", outline)):  # a busy machine is slow, too
            await asyncio.sleep(0.1)
        return found

    async def run():
        others = set(list_children(os.getpid()))
        worker = WorkerProcess(reports.append, patience=2.0)
        worker.set_document(str(path), URDF)
        await ask_until_answered(worker)
        starts = worker.starts
        for child in set(list_children(os.getpid())) - others:
            os.kill(child, signal.SIGSTOP)
        assert await worker.ask("symbols", outline) is None
        assert await ask_until_answered(worker)
        assert worker.starts > starts
        worker.kill()
        while len(asyncio.all_tasks()) > 1:
            await asyncio.sleep(0.05)

    asyncio.run(run())
    assert "a check took longer than 2 s and was ended" in reports
