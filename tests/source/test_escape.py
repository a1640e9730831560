from xml.sax import saxutils

from hypothesis import given
from hypothesis import strategies as st

from urdftool.source.escape import escape, unescape

TEXT = st.text(st.sampled_from("&<>\"';ampltgquo #x1a"))
QUOTES = {"&quot;": '"', "&apos;": "'"}


@given(TEXT)
def test_it_is_what_the_standard_library_does(text):
    back = {character: entity for entity, character in QUOTES.items()}
    assert escape(text) == saxutils.escape(text)
    assert escape(text, back) == saxutils.escape(text, back)
    assert unescape(text) == saxutils.unescape(text)
    assert unescape(text, QUOTES) == saxutils.unescape(text, QUOTES)
    assert unescape(escape(text, back), QUOTES) == text
