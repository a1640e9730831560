"""Documents as they are while somebody types: broken, of any encoding, hostile."""

import json
from pathlib import Path

import pytest

from tests.conftest import FIXTURES
from urdftool.server.frames import pack, unpack_length
from urdftool.server.knowledge import make_path
from urdftool.server.moves import compare_texts
from urdftool.server.publication import Publication
from urdftool.server.repair import repair_xml
from urdftool.server.session import Session
from urdftool.source.document import parse
from urdftool.source.location import SourceFile

TYPED = '  <material name="typed"><color rgba="1 0 0 1"/></material>\n'
QUESTIONS = ("hover", "definition", "references", "completion", "prepare-rename", "rename")
FILES = [
    path
    for name in (
        *("axis-not-unit", "fixed-joint-limit", "inertia-not-positive-definite", "mesh-not-found"),
        *("unknown-parent-link", "zero-mass", "duplicate-link", "color-range"),
        *("missing-inertial", "negative-mass", "unknown-attribute"),
        *("cylinder-inertia", "limit-swapped", "heavy-damping", "unused-arg", "macro-redefined"),
    )
    for path in sorted((FIXTURES / "rules" / name).glob("bad.urdf*"))
][:10]


class Editor:
    """One document in the checking process, with the diagnostics that are shown."""

    def __init__(self, path, text, encoding="utf-16"):
        self.path, self.text = make_path(path), text
        self.session, self.publication = Session(), Publication()
        folder = str(Path(self.path).parent)
        self.session.knowledge.configure(encoding, [folder], {}, (), (), None, ())
        self.type(text)

    def type(self, text):
        """Replace the text and check it; return code and range of each diagnostic."""
        self.publication.move(self.path, compare_texts(self.text, text, "utf-16"))
        self.text = text
        self.session.set_document(self.path, text)
        self.ask("check", paths=[self.path])
        shown = self.publication.list_diagnostics(self.path)
        return {(one["code"], str(one["range"])) for one in shown}

    def ask(self, method, **params):
        return self.session.compute_answer(
            method, {"path": self.path, **params}, self.publication.receive, lambda: None
        )

    def ask_all(self, line, character):
        """Ask every question at a position."""
        position = {"line": line, "character": character}
        for method in QUESTIONS:
            self.ask(method, position=position, name="other")
        self.ask("symbols")
        self.ask("actions", range={"start": position, "end": position})


def list_vanished(path, step=1):
    """Type a line before the end of a file; return prefixes at which a finding is not shown."""
    text = path.read_text()
    editor = Editor(path, text)
    known = editor.type(text)
    assert known, path
    place = text.rindex("</robot>")
    place = text.rindex("\n", 0, place) + 1
    return [
        (TYPED[:length], missing)
        for length in range(1, len(TYPED) + 1, step)
        if (missing := known - editor.type(text[:place] + TYPED[:length] + text[place:]))
    ]


def test_findings_stay_while_another_line_is_half_typed():
    assert not list_vanished(FILES[0], step=4)


def test_findings_of_text_that_is_gone_go(tmp_path):
    path = tmp_path / "a.urdf"
    path.write_text('<robot name="r"><link name="a"/><link nam="b"/></robot>')
    editor = Editor(path, path.read_text())
    assert {"unknown-attribute", "missing-name"} <= {code for code, _ in editor.type(editor.text)}
    assert {code for code, _ in editor.type("")} == {"not-well-formed"}


@pytest.mark.slow
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.parent.name)
def test_findings_stay_at_every_prefix(path):
    assert not list_vanished(path)


def ask_at_prefixes(path, step):
    text = path.read_text()
    editor = Editor(path, text)
    for length in range(0, len(text), step):
        editor.type(text[:length])
        editor.ask_all(text.count("\n", 0, length), len(text[:length].rpartition("\n")[2]))


def test_questions_about_the_start_of_a_document():
    ask_at_prefixes(FILES[0], 150)


@pytest.mark.slow
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.parent.name)
def test_questions_at_every_prefix(path):
    ask_at_prefixes(path, 1)


@pytest.mark.parametrize(
    ("broken", "tags"),
    [
        (b'<robot><link name="a"/><li', ["link"]),
        (b'<robot><link name="a"/><link name="b\n<joint name="c"/></robot>', ["link", "joint"]),
        (b'<robot><link name="a"><joint name="c"/></robot>', ["joint"]),
        (b'<robot><link name="a"/></link></robot>', ["link"]),
        (b'<robot><link name="a & b"/></robot>', ["link"]),
        (b'<robot><!-- <link --><link name="a"/>', ["link"]),
    ],
)
def test_repair_keeps_offsets(broken, tags):
    repaired = repair_xml(broken)
    root = parse(SourceFile("robot", repaired)).root
    assert [element.tag for element in root.children] == tags
    for element in root.children:
        assert broken[element.start :].startswith(b"<" + element.tag.encode())


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
@pytest.mark.parametrize("declared", ["utf-8", "iso-8859-1"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_columns_of_definitions(tmp_path, encoding, declared, end):
    letter = "🤖" if declared == "utf-8" else "é"
    lines = [
        f'<?xml version="1.0" encoding="{declared}"?>',
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">',
        f'<!-- {letter} --><xacro:property name="len" value="1"/>',
        f'<link name="a"/><!-- {letter} --><material name="m${{len}}"/>',
        "</robot>",
    ]
    path = tmp_path / "r.urdf.xacro"
    path.write_bytes(end.join(lines).encode(declared))
    editor = Editor(path, end.join(lines), encoding)

    def count(text):
        if encoding == "utf-32":
            return len(text)
        return (
            len(text.encode(encoding))
            if encoding == "utf-8"
            else len(text.encode("utf-16-le")) // 2
        )

    use = {"line": 3, "character": count(lines[3][: lines[3].index("len")])}
    (found,) = editor.ask("definition", position=use)
    first = count(lines[2][: lines[2].index("len")])
    assert found["range"]["start"] == {"line": 2, "character": first}


def test_a_byte_order_mark_of_an_included_file(tmp_path):
    main, part = tmp_path / "main.urdf.xacro", tmp_path / "part.xacro"
    xmlns = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    written = f'<robot {xmlns}><xacro:property name="x" value="1"/></robot>'
    part.write_text(written, "utf-8-sig")
    include = '<xacro:include filename="part.xacro"/>'
    text = f'<robot name="r" {xmlns}>{include}<link name="${{x}}"/></robot>'
    main.write_text(text)
    place = {"line": 0, "character": text.index("x}")}
    (found,) = Editor(main, text).ask("definition", position=place)
    assert found["range"]["start"] == {"line": 0, "character": written.index('x" value')}


def test_an_include_that_vanishes_and_returns(tmp_path):
    main, part = tmp_path / "main.urdf.xacro", tmp_path / "part.xacro"
    xmlns = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    written = f'<robot {xmlns}><xacro:property name="x" value="1"/></robot>'
    part.write_text(written)
    include = '<xacro:include filename="part.xacro"/>'
    text = f'<robot name="r" {xmlns}>{include}\n<link name="a${{x}}"/></robot>'
    main.write_text(text)
    editor = Editor(main, text)
    place = {"line": 1, "character": text.split("\n")[1].index("x}")}
    before = editor.type(text)
    part.unlink()
    editor.ask("refresh")
    assert editor.type(text) > before
    assert editor.ask("definition", position=place) == []
    part.write_text(written)
    editor.ask("refresh")
    assert editor.type(text) == before
    (found,) = editor.ask("definition", position=place)
    assert found["path"] == make_path(part)


def test_a_large_document_has_no_names(tmp_path, monkeypatch):
    monkeypatch.setattr("urdftool.server.knowledge.MOST_BYTES", 1000)
    path = tmp_path / "large.urdf"
    text = '<robot name="r">' + '<link name="a"/>' * 100 + "</robot>"
    path.write_text(text)
    editor = Editor(path, text)
    position = {"line": 0, "character": text.index('"a"') + 1}
    assert editor.ask("definition", position=position) == []
    assert editor.ask("completion", position=position) == []
    assert editor.ask("rename", position=position, name="b")["refused"]


@pytest.mark.slow  # the expression runs to its limit of processor time
def test_an_expression_that_does_not_end(tmp_path):
    path = tmp_path / "endless.urdf.xacro"
    text = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<link name="${len([0 for x in range(999999) for y in range(999999)])}"/></robot>"""
    path.write_text(text)
    editor = Editor(path, text)
    assert any(code == "endless-expansion" for code, _ in editor.type(text))


def test_there_are_ten_files():
    assert len(FILES) == 10


def test_messages_between_the_processes():
    data = pack({"a": "é"})
    assert unpack_length(data[:4]) == len(data) - 4
    assert json.loads(data[4:]) == {"a": "é"}


def test_findings_of_a_file_that_is_not_edited_follow_the_edits_of_another(tmp_path):
    xacro = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
    macros = tmp_path / "macros.xacro"
    part = '<link name="x"><colision/></link>'
    macros.write_text(xacro.format(f'<xacro:macro name="part">{part}</xacro:macro>'))
    plain = xacro.format('<xacro:include filename="macros.xacro"/><link name="a"/>')
    path = tmp_path / "robot.urdf.xacro"
    path.write_text(plain)
    editor = Editor(path, plain)

    def list_codes():
        shown = editor.publication.list_diagnostics(make_path(macros))
        return {one["code"] for one in shown} & {"unreached-typo", "unknown-element"}

    assert list_codes() == {"unreached-typo"}
    editor.type(plain.replace('name="a"', 'name="b"'))
    assert list_codes() == {"unreached-typo"}  # as kept with the file
    editor.type(plain.replace('<link name="a"/>', "<xacro:part/>"))
    assert list_codes() == {"unknown-element"}
    editor.type(plain)
    assert list_codes() == {"unreached-typo"}
