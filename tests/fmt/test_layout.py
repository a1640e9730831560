"""Layout of XML files: what changes, what stays, and that twice is once."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import FIXTURES
from urdftool.fmt.discover import find_files
from urdftool.fmt.layout import format_xml
from urdftool.fmt.run import format_file, list_events
from urdftool.source.location import SourceFile

CASES = {
    "indented by two": ("<a>\n\t<b>\n<c/></b>\n</a>", "<a>\n  <b>\n    <c/></b>\n</a>\n"),
    "spaces in a tag": (
        "<a x = '1'   y=\"2\" ><b /></a >",
        "<a x='1' y=\"2\"><b/></a>\n",
    ),
    "order of attributes": ('<a z="1" y="2" x="3"/>', '<a z="1" y="2" x="3"/>\n'),
    "lines of a tag": ('<a\n x="1"\n\ty="2"\n/>', '<a\n    x="1"\n    y="2"/>\n'),
    "blank lines": ("<a>\n\n\n\n<b/>\n<c/></a>", "<a>\n\n  <b/>\n  <c/></a>\n"),
    "inside of a comment": ("<a>\n<!-- 1\n     2 -->\n</a>", "<a>\n  <!-- 1\n     2 -->\n</a>\n"),
    "comment behind a tag": ("<a>\n<b/>   <!-- b -->\n</a>", "<a>\n  <b/>   <!-- b -->\n</a>\n"),
    "text": ("<a>\n<b>\n x\n\ty </b>\n</a>", "<a>\n  <b>\n x\n\ty </b>\n</a>\n"),
    "tags in text": ("<a>\n<b>x <c  />\n</b></a>", "<a>\n  <b>x <c  />\n</b></a>\n"),
    "CDATA": ("<a>\n<b><![CDATA[\n<x >]]></b>\n</a>", "<a>\n  <b><![CDATA[\n<x >]]></b>\n</a>\n"),
    "preserved": (
        "<a>\n<b xml:space='preserve'>\n<c />\n</b></a>",
        "<a>\n  <b xml:space='preserve'>\n<c />\n</b></a>\n",
    ),
    "a blank as content": ("<a>\n<b> </b><c></c>\n</a>", "<a>\n  <b> </b><c></c>\n</a>\n"),
    "empty over two lines": ("<a>\n<b>\n</b>\n</a>", "<a>\n  <b>\n  </b>\n</a>\n"),
    "line break in a value": ('<a x="1\n  2"/>', '<a x="1\n  2"/>\n'),
    "greater-than in a value": ('<a x=">  /"  />', '<a x=">  /"/>\n'),
    "declaration": ('<?xml version="1.0"?><a/>', '<?xml version="1.0"?>\n<a/>\n'),
    "line ends": ("<a>\r\n<b/>\r\n</a>", "<a>\r\n  <b/>\r\n</a>\r\n"),
    "byte order mark": ("\ufeff<a>\n<b/></a>", "\ufeff<a>\n  <b/></a>\n"),
    "spaces at the ends of lines": ("<a>  \n<b/>\t\n</a>\n\n\n", "<a>\n  <b/>\n</a>\n"),
    "one line that is short": ("<a><b/><c/></a>", "<a><b/><c/></a>\n"),
}


@pytest.mark.parametrize(("before", "after"), CASES.values(), ids=CASES)
def test_layout(before, after):
    assert format_xml(before.encode()).decode() == after
    assert format_xml(after.encode()).decode() == after


def test_one_line_that_is_wide_is_broken_from_the_outside():
    link = '<link name="{}"><inertial><mass value="1"/></inertial></link>'
    text = f'<robot name="r">{link.format("a")}{link.format("b")}<!-- c --></robot>'
    assert format_xml(text.encode()).decode() == (
        f'<robot name="r">\n  {link.format("a")}\n  {link.format("b")}<!-- c -->\n</robot>\n'
    )


def test_latin_1_is_kept():
    data = '<?xml version="1.0" encoding="iso-8859-1"?>\n<a x="é"  />\n'.encode("latin-1")
    assert format_file(SourceFile("a", data)).after == data.replace(b"  />", b"/>")


NAMES = st.sampled_from(["a", "b", "xacro:macro", "link"])
SPACES = st.sampled_from(["", " ", "\n", "\n\n", "\n\n\n", "\r\n", "\t", " \n\t "])
VALUES = st.text(st.sampled_from("xé0 \n\t>/='{}$"), max_size=8)
COMMENTS = st.text(st.sampled_from("ab \n<>&"), max_size=12)
ATTRIBUTES = st.dictionaries(st.sampled_from(["x", "y", "xyz"]), VALUES, max_size=3)


NO_CONTENT = st.just("")


@st.composite
def elements(draw, content=NO_CONTENT):
    name = draw(NAMES)
    attributes = "".join(
        f'{draw(SPACES) or " "}{key} {draw(st.sampled_from(["=", "= "]))}"{value}"'
        for key, value in draw(ATTRIBUTES).items()
    )
    parts = draw(st.lists(content, max_size=4))
    if not parts and draw(st.booleans()):
        return f"<{name}{attributes}{draw(SPACES)}/>"
    inner = "".join(draw(SPACES) + part for part in parts) + draw(SPACES)
    return f"<{name}{attributes}>{inner}</{name}{draw(st.sampled_from(['', ' ']))}>"


LEAVES = st.one_of(
    elements(),
    COMMENTS.map(lambda text: f"<!--{text}-->"),
    st.sampled_from(["text", " 1 2 3 ", "&lt;", "<![CDATA[ <x> ]]>", "<?go on?>"]),
)
TREES = st.recursive(LEAVES, lambda below: elements(below), max_leaves=12)


@given(elements(TREES))
def test_any_xml_stays_the_same_and_twice_is_once(text):
    data = text.encode()
    done = format_file(SourceFile("a.urdf", data))  # raises if it is not the same XML
    assert format_xml(done.after) == done.after


@given(elements(TREES))
def test_events_see_what_the_layout_must_not_change(text):
    before = list_events(SourceFile("a", text.encode()))
    for old, new in (("text", "texts"), ("1 2 3", "1 2  3"), ("<?go", "<?stay")):
        if old in text:
            changed = text.replace(old, new, 1)
            assert list_events(SourceFile("a", changed.encode())) != before


def test_all_fixtures_stay_the_same_xml():
    folders = [str(FIXTURES / "robots"), str(FIXTURES / "formats")]
    files = [SourceFile(path, Path(path).read_bytes()) for path in find_files(folders)]
    done = [format_file(file) for file in files]
    assert len(done) > 20
    assert all(format_xml(one.after) == one.after for one in done)
