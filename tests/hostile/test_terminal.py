"""What a terminal would obey is shown there, whatever it is printed by."""

import os
import pty
import sys

import pytest

from tests.hostile.writers import process
from urdftool.control_characters import escape_controls
from urdftool.terminal import escape_text

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no such terminals")

NASTY = "\x9b31m\u202eevil\u2066"


def test_ours_passes():
    for text in ("\x1b[31mred\x1b[0m", "\r\x1b[K12/13", "a\r\n", "\ta\n", "é–×\n", "\x1b[1;91m"):
        assert escape_text(text, "stderr") == text
    assert escape_text("\r\x1b[Kover") == "\\r\\x1b[Kover"


@pytest.mark.parametrize(
    "text",
    ["\x1b[8m", "\x1b]0;title\x07", "\x1b[2J", "\x9b2J", "\u202e", "a\rb", "\x08", "\x7f", "\0"],
)
def test_what_is_obeyed_is_written_out(text):
    written = escape_text(text)
    assert written.isprintable()
    assert "\\" in written
    assert escape_controls(text).isprintable()


ROBOT = f"""<robot name="r{NASTY}"><link name="a{NASTY}">
<visual><geometry><mesh filename="b{NASTY}.stl"/></geometry></visual></link>
<link name="c"/><joint name="j{NASTY}" type="fixed"><parent link="a{NASTY}"/><child link="c"/>
</joint></robot>"""
COMMANDS = ["expand IN", "lint IN", "info IN", "graph IN -o -", "inertia robot IN"]
COMMANDS += ["diff IN OTHER", "export sdf IN -o OUT", "lint IN --format concise"]
COMMANDS += ["lint IN --unsafe-fixes --diff", "expand BROKEN", "lint BROKEN"]


@pytest.mark.parametrize("command", COMMANDS)
def test_no_command_sends_it_raw(tmp_path, command):
    (tmp_path / "r.urdf").write_text(ROBOT)
    (tmp_path / "other.urdf").write_text(ROBOT.replace("evil", "good"))
    (tmp_path / "broken.urdf").write_text(f"<robot name='r'>\x1b]0;owned\x07 {NASTY}</robo>")
    names = {"IN": "r.urdf", "OTHER": "other.urdf", "BROKEN": "broken.urdf", "OUT": "out"}
    words = [names.get(word, word) for word in command.split()]
    ours, theirs = pty.openpty()
    child = process(words, tmp_path, tmp_path, stdout=theirs, stderr=theirs)
    os.close(theirs)
    said = b""
    while True:
        try:
            piece = os.read(ours, 4096)
        except OSError:
            break
        if not piece:
            break
        said += piece
    os.close(ours)
    assert child.wait(60) in (0, 1, 2)
    assert said
    text = said.decode()
    assert escape_text(text) == text
    assert not any(c in text for c in ("\x9b", "\u202e", "\u2066", "\x07"))
