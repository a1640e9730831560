"""What TinyXML2 accepts that is not well-formed: rows were run in libsdformat 12.3 and MuJoCo 4."""

import pytest

from urdftool.errors import XmlError
from urdftool.source.location import SourceFile
from urdftool.source.tinyxml2 import parse_as_tinyxml2

ROOT = '<sdf version="1.7"><model name="m"/></sdf>'
ACCEPTED = {
    "blanks before the declaration": ('\n<?xml version="1.0"?>' + ROOT, 2),
    "two dashes in a comment": ("<!-- a -- b -->" + ROOT, 1),
    "a dash at the end of a comment": ("<!-- a --->" + ROOT, 1),
    "a declaration without a version": ("<?xml?>" + ROOT, 1),
    "no blank between attributes": (ROOT.replace('"m"', '"m"\n canonical_link="a"b="c"d=""'), 2),
}
REJECTED = {
    "a comment before the declaration": '<!-- a --><?xml version="1.0"?>' + ROOT,
    "text after the root": ROOT + "text",
    "an attribute twice": ROOT.replace("name", 'name="a" name'),
    "an element that is not closed": ROOT.removesuffix("</sdf>"),
}


def parse(text):
    return parse_as_tinyxml2(SourceFile("m.sdf", text.encode()))


@pytest.mark.parametrize("name", ACCEPTED)
def test_a_defect_is_accepted_and_reported(name):
    text, line = ACCEPTED[name]
    read = parse(text)
    assert read.document.root.find_child("model") is not None
    assert (read.error.at.line, read.surplus) == (line, None)


def test_an_end_tag_after_the_root_is_accepted_with_its_place():
    read = parse(ROOT + "\n</sdf>")
    assert (read.error, read.surplus.line) == (None, 2)


@pytest.mark.parametrize("name", REJECTED)
def test_another_defect_is_rejected(name):
    with pytest.raises(XmlError):
        parse(REJECTED[name])


def test_well_formed_text_has_no_defect():
    read = parse(ROOT)
    assert (read.error, read.surplus) == (None, None)


def test_a_missing_blank_moves_what_follows_by_a_column():
    read = parse(ROOT.replace('"m"', '"m"pose="1"\n b="c"'))
    assert read.document.root.find_child("model").attributes == {"name": "m", "pose": "1", "b": "c"}
    assert read.error.message == "a blank is missing between two attributes"
    assert read.error.at.column == ROOT.index('m"') + 3
