import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.errors import SourceError, XmlError
from urdftool.source.document import parse, read_file
from urdftool.source.location import SourceFile
from urdftool.source.well_formed import MAX_DEPTH, drop_end_tags_after_root, repair


def document(text):
    data = text if isinstance(text, bytes) else text.encode()
    return parse(SourceFile("robot.urdf", data))


def element(text, tag):
    return next(e for e in document(text).root.walk() if e.tag == tag)


ROBOT = """<?xml version="1.0"?>
<robot name="r">
  <link
    name = 'a' /><joint name="j"></joint>
</robot>"""


def test_an_element_knows_its_bytes():
    link = element(ROBOT, "link")
    assert (link.place.line, link.place.column) == (3, 3)
    assert ROBOT[link.start : link.end] == "<link\n    name = 'a' />"
    joint = element(ROBOT, "joint")
    assert ROBOT[joint.start : joint.end] == '<joint name="j"></joint>'
    root = document(ROBOT).root
    assert ROBOT[root.start : root.end] == ROBOT[22:]


def test_nested_elements_of_one_name_keep_their_ends():
    text = "<a><a/></a>"
    outer = document(text).root
    assert (outer.start, outer.end) == (0, len(text))
    assert text[outer.children[0].start : outer.children[0].end] == "<a/>"


def test_an_attribute_knows_its_bytes():
    place = element(ROBOT, "link").locate_attribute("name")
    assert ROBOT[place.start : place.end] == "name = 'a'"
    assert str(place) == "robot.urdf:4:5"
    link = element(ROBOT, "link")
    assert link.locate_attribute("absent") == link.place


def test_columns_count_characters_not_bytes():
    text = '<robot name="ü€"><link name="x"/></robot>'
    assert element(text, "link").place.column == text.index("<link") + 1


def test_a_byte_order_mark_is_no_column():
    text = b"\xef\xbb\xbf<robot name='r'><link name='x'/></robot>"
    assert document(text).root.place.column == 1
    assert next(document(text).root.list_children("link")).place.column == 17


def test_crlf_lines_count_once():
    text = '<robot name="r">\r\n  <link name="x"/>\r\n</robot>'
    assert str(element(text, "link").place) == "robot.urdf:2:3"


@pytest.mark.parametrize("encoding", ["utf-16", "utf-32-le", "iso-8859-1", "cp1252"])
def test_other_encodings_are_read(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?><robot name="é"/>'
    if encoding == "utf-32-le":
        data = b"\xff\xfe\x00\x00" + '<?xml version="1.0"?><robot name="é"/>'.encode(encoding)
    else:
        data = text.encode(encoding)
    assert document(data).root.get("name") == "é"


def test_comments_are_kept_with_their_place():
    text = "<robot><!-- one --><link/><!--two--></robot>"
    found = document(text).comments
    assert [text[c.start : c.end] for c in found] == ["<!-- one -->", "<!--two-->"]


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ("hello", 1, 1, "not XML"),
        ('<robot name="r"><link', 1, 17, "truncated"),
        ('<robot name="r">\n<link name="x">', 2, 16, "<link> of line 2"),
        ("<robot>\n<link>\n</robot>", 3, 3, "</robot> closes"),
        ("<robot/>\n<robot/>", 2, 1, "one root element"),
        ("<!-- c -->\n<?xml version='1.0'?><robot/>", 2, 1, "move the declaration"),
        ("<?xml?><robot/>", 1, 6, "XML declaration"),
        ("<robot>\n<!-- a -- b -->\n</robot>", 2, 10, "'--'"),
        ('<robot a="1" a="2"/>', 1, 14, "attribute twice"),
        ("<robot>&nbsp;</robot>", 1, 8, "entity is not defined"),
        ("version https://git-lfs.github.com/spec/v1\noid sha256:1", 1, 1, "git lfs pull"),
    ],
)
def test_what_is_not_well_formed_is_explained(text, line, column, message):
    with pytest.raises(XmlError, match=message) as caught:
        document(text)
    assert (caught.value.line, caught.value.column) == (line, column)


def test_entities_are_refused():
    bomb = '<!DOCTYPE r [<!ENTITY a "x"><!ENTITY b "&a;&a;&a;">]><robot name="&b;"/>'
    with pytest.raises(XmlError, match="entity 'a'"):
        document(bomb)
    outside = '<!DOCTYPE r [<!ENTITY a SYSTEM "file:///etc/passwd">]><robot>&a;</robot>'
    with pytest.raises(XmlError, match="entity 'a'"):
        document(outside)


def test_depth_is_bounded():
    depth = MAX_DEPTH + 1
    with pytest.raises(XmlError, match="nested"):
        document("<a>" * depth + "</a>" * depth)


def test_files_that_cannot_be_read(write, tmp_path):
    with pytest.raises(SourceError, match="no such file"):
        read_file("absent.urdf")
    with pytest.raises(SourceError, match="folder"):
        read_file(tmp_path)
    with pytest.raises(SourceError, match="empty"):
        read_file(write("empty.urdf", " \n"))
    with pytest.raises(SourceError, match="MiB"):
        read_file(write("large.urdf", b" " * (33 * 1024 * 1024)))


@pytest.mark.parametrize(
    ("rest", "place"),
    [
        (b"</m>", (1, 12)),
        (b"\n</m>\n", (2, 1)),
        (b"<!-- </x> --></m></other>", (1, 25)),
        (b"", None),
        (b"<!-- </m> -->", None),
        (b"text</m>", None),
        (b"<b/></m>", None),
        (b"</m", None),
    ],
)
def test_end_tags_after_the_root_are_dropped(rest, place):
    file = SourceFile("m.xml", b"<m><a/>" + b"</m>" + rest)
    dropped = drop_end_tags_after_root(file)
    if place is None:
        assert dropped is None
        return
    kept, found = dropped
    assert (found.line, found.column) == place
    assert parse(kept).root.tag == "m"
    assert len(kept.data) == len(file.data)


def test_a_second_end_tag_is_called_so():
    for text in (b"<m/></m>", b"<m/>\n</m>\n", b"</m><m/>"):
        with pytest.raises(XmlError, match="</m> is an end tag, but no element is open here"):
            parse(SourceFile("m.xml", text))


@pytest.mark.parametrize(
    ("inside", "column", "words"),
    [
        ('<a b="c & d"/>', 10, "write &amp; for the character"),
        ('<a b="c &amp d"/>', 13, "write &amp; for the character"),
        ("<a b=c/>", 6, "the value of an attribute has no quotes"),
        ("<a/><!-- c", 5, "the comment that opens here is not closed"),
    ],
)
def test_what_is_missing_is_named_where_it_is(inside, column, words):
    with pytest.raises(XmlError, match=words) as caught:
        parse(SourceFile("m.xml", f"<m>\n{inside}\n</m>".encode()))
    assert (caught.value.at.line, caught.value.at.column) == (2, column)


def test_lax_readers_see_the_mended_file_at_the_same_bytes():
    text = b"<!-- (c) -- all -->\n<?xml version='1.0'?>\n<robot name='r'/>"
    repaired = repair(SourceFile("r.urdf", text))
    assert len(repaired.data) == len(text)
    assert parse(repaired).root.start == text.index(b"<robot")
    assert repair(SourceFile("r.urdf", b"<robot/>")) is None


names = st.text("abzAZé_", min_size=1, max_size=6)
values = st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=12)


@st.composite
def elements(draw, depth=3):
    attributes = draw(st.dictionaries(names, values, max_size=3))
    blank = draw(st.sampled_from([" ", "\n  ", "\t"]))
    written = "".join(
        blank + name + draw(st.sampled_from(["=", " = "])) + '"' + _escaped(value) + '"'
        for name, value in attributes.items()
    )
    tag = draw(names)
    children = draw(st.lists(elements(depth=depth - 1), max_size=2)) if depth else []
    if not children and draw(st.booleans()):
        return f"<{tag}{written}/>"
    return f"<{tag}{written}>{''.join(children)}</{tag}>"


def _escaped(value):
    return value.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")


@given(elements())
def test_every_element_and_attribute_is_found_at_its_bytes(text):
    data = text.encode()
    for found in parse(SourceFile("x", data)).root.walk():
        piece = data[found.start : found.end].decode()
        assert piece.startswith(f"<{found.tag}")
        assert piece.endswith(("/>", f"</{found.tag}>"))
        assert parse(SourceFile("y", piece.encode())).root.attributes == found.attributes
        for name in found.attributes:
            place = found.locate_attribute(name)
            assert data[place.start : place.end].decode().startswith(name)
