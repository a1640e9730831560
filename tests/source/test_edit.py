"""Byte-exact edits."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from urdftool.errors import SourceError
from urdftool.source.document import parse
from urdftool.source.edit import (
    Edit,
    Source,
    apply,
    insert_child,
    parse_source,
    read_literal,
    set_attribute,
)
from urdftool.source.location import SourceFile


def source_of(text):
    return parse_source(SourceFile("r.urdf", text.encode() if isinstance(text, str) else text))


def link(source):
    return source.document.root.find_child("link")


def with_child(text, lines=("<a>", "\t<b/>", "</a>"), after=None):
    source = source_of(text)
    parent = link(source)
    edit = insert_child(source, parent, lines, after=after and parent.find_child(after))
    data = apply(source.file, [edit])
    parse(SourceFile("after.urdf", data))
    return data.decode()


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (
            "<robot>\n  <link>\n    <visual/>\n  </link>\n</robot>",
            "<robot>\n  <link>\n    <a>\n      <b/>\n    </a>\n    <visual/>\n  </link>\n</robot>",
        ),
        (
            "<robot>\n\t<link>\n\t\t<visual/>\n\t</link>\n</robot>",
            "<robot>\n\t<link>\n\t\t<a>\n\t\t\t<b/>\n\t\t</a>\n\t\t<visual/>\n\t</link>\n</robot>",
        ),
        (
            "<robot>\r\n <link> <!-- x -->\r\n  <visual/>\r\n </link>\r\n</robot>",
            "<robot>\r\n <link> <!-- x -->\r\n  <a>\r\n   <b/>\r\n  </a>\r\n  <visual/>\r\n </link>"
            "\r\n</robot>",
        ),
        (
            "<robot>\n    <link/>\n</robot>",
            "<robot>\n    <link>\n        <a>\n            <b/>\n        </a>\n    </link>\n"
            "</robot>",
        ),
        (
            "<robot>\n  <link></link>\n</robot>",
            "<robot>\n  <link>\n    <a>\n      <b/>\n    </a>\n  </link>\n</robot>",
        ),
        ("<robot><link/></robot>", "<robot><link><a><b/></a></link></robot>"),
        (
            "<robot><link><visual/></link></robot>",
            "<robot><link><a><b/></a><visual/></link></robot>",
        ),
        (
            '<robot>\n  <link name="a>b" >\n  <visual/>\n  </link>\n</robot>',
            '<robot>\n  <link name="a>b" >\n  <a>\n    <b/>\n  </a>\n  <visual/>\n  </link>\n'
            "</robot>",
        ),
    ],
)
def test_a_child_in_front(before, after):
    assert with_child(before) == after


def test_a_child_after_another():
    before = "<robot>\n  <link>\n    <mass/> <!-- kg -->\n    <c/>\n  </link>\n</robot>"
    after = "<robot>\n  <link>\n    <mass/> <!-- kg -->\n    <x/>\n    <c/>\n  </link>\n</robot>"
    assert with_child(before, ("<x/>",), after="mass") == after
    before = "<robot>\n  <link>\n    <mass>\n    </mass><c/>\n  </link>\n</robot>"
    after = "<robot>\n  <link>\n    <mass>\n    </mass>\n    <x/><c/>\n  </link>\n</robot>"
    assert with_child(before, ("<x/>",), after="mass") == after


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('<robot><link name="a"/></robot>', '<robot><link name="b"/></robot>'),
        ("<robot><link name = 'a' /></robot>", "<robot><link name = 'b' /></robot>"),
        ("<robot><link/></robot>", '<robot><link name="b"/></robot>'),
        ('<robot><link\n  x="1"\n/></robot>', '<robot><link\n  x="1" name="b"\n/></robot>'),
    ],
)
def test_an_attribute(before, after):
    source = source_of(before)
    edit = set_attribute(source, link(source), "name", "b")
    assert apply(source.file, [edit]).decode() == after


def test_what_an_attribute_may_not_hold_is_escaped():
    source = source_of("<robot><link name='a'/></robot>")
    value = "a<b & \"c\" 'd'"
    data = apply(source.file, [set_attribute(source, link(source), "name", value)])
    assert parse(SourceFile("r", data)).root.find_child("link").get("name") == value


def test_the_literal_value():
    source = source_of('<robot><link name="a &lt; ${b}"/></robot>')
    assert read_literal(link(source), "name") == "a < ${b}"
    assert read_literal(link(source), "mass") is None


def test_edits_that_overlap_are_refused():
    file = SourceFile("r", b"0123456789")
    assert apply(file, [Edit(5, 6, b"x"), Edit(2, 2, b"y"), Edit(2, 2, b"z")]) == b"01yz234x6789"
    with pytest.raises(ValueError):
        apply(file, [Edit(2, 5, b""), Edit(4, 6, b"")])


def test_text_that_had_to_be_decoded_is_refused():
    with pytest.raises(SourceError):
        Source(SourceFile("r", "<robot/>".encode("utf-16")))


NAMES = st.sampled_from(["a", "b", "mass"])
BLANK = st.sampled_from(["", " ", "\n", "\n  ", "\r\n\t", " <!-- c -->\n", "<!-- d -->"])


@settings(max_examples=150, deadline=None)
@given(st.lists(st.tuples(BLANK, NAMES), max_size=4), BLANK, BLANK, st.booleans())
def test_an_insertion_adds_bytes_and_takes_none(children, end, before, first):
    inner = "".join(f"{blank}<{name}/>" for blank, name in children) + end
    source = source_of(f"<robot>{before}<link>{inner}</link></robot>")
    parent = link(source)
    after = None if first or not parent.children else parent.children[-1]
    edit = insert_child(source, parent, ("<x>", "\t<y/>", "</x>"), after=after)
    data = apply(source.file, [edit])
    if edit.end == edit.start:
        assert data[: edit.start] + data[edit.start + len(edit.text) :] == source.file.data
    found = parse(SourceFile("r", data)).root.find_child("link").children
    index = [child.tag for child in found].index("x")
    assert [c.tag for c in found if c.tag != "x"] == [name for _, name in children]
    assert index == (len(children) if after is not None else 0)
