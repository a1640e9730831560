import csv
import io
import subprocess
import sys
from contextlib import redirect_stderr, suppress
from pathlib import Path

import pytest
import xacro
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from tests.cases import list_cases
from tests.conftest import CORPUS, XACRO
from urdftool.errors import PackageNotFound, XacroError, XmlError
from urdftool.source import xacro_hooks
from urdftool.source.document import read_file
from urdftool.source.expand import expand_xacro
from urdftool.source.location import SourceFile
from urdftool.source.packages import Packages


def expand(path, **arguments):
    return expand_xacro(read_file(path), arguments, Packages(path))


def expand_text(inside, **arguments):
    file = SourceFile("r.xacro", XACRO.format(inside).encode())
    return expand_xacro(file, arguments, Packages())


def canonical(text):
    parser = etree.XMLParser(remove_comments=True, remove_blank_text=True)
    return etree.tostring(etree.fromstring(text.encode(), parser), method="c14n")


def find(description, tag, name=None):
    for element in description.make_document().root.walk():
        if element.tag == tag and name in (None, element.get("name")):
            return element
    raise AssertionError(f"no <{tag}>")


# Equal to xacro ------------------------------------------------------------------------------


def _rows():
    if not CORPUS.exists():
        return []
    with open(CORPUS / "MANIFEST.tsv") as table:
        return [row for row in csv.DictReader(table, delimiter="\t") if row["kind"] == "xacro"]


def _plain_xacro(path, arguments, monkeypatch):
    """What xacro itself makes of a file when it is told where packages are; None if it fails."""
    import xacro.substitution_args as substitution

    def eval_find(name):
        return str(Packages(path, paths=[CORPUS]).find(name))

    monkeypatch.setattr(substitution, "_eval_find", eval_find)
    monkeypatch.setitem(substitution._eval_dict, "find", eval_find)
    try:
        with redirect_stderr(io.StringIO()):
            return xacro.process_file(path, mappings=dict(arguments)).toprettyxml(indent="  ")
    except Exception:
        return None


@pytest.mark.corpus
@pytest.mark.parametrize(
    "row", list_cases(_rows(), 4), ids=lambda row: f"{row['path']} {row['xacro_args']}"
)
def test_the_corpus_expands_as_xacro_expands_it(row, monkeypatch):
    monkeypatch.chdir(CORPUS)
    path = row["path"]
    arguments = dict(word.split(":=") for word in row["xacro_args"].split())
    try:
        ours = expand_xacro(read_file(path), arguments, Packages(path, paths=[CORPUS])).text
    except (XacroError, XmlError, PackageNotFound) as error:
        ours, failure = None, error
    if ours is None:
        assert row["error"], f"the manifest says that it expands: {failure}"
        assert failure.line is not None
    theirs = _plain_xacro(path, arguments, monkeypatch)
    if theirs is not None:
        assert ours is not None
        assert canonical(ours) == canonical(theirs)
    if row["xacro_with_install_rules"] == "ok":
        assert ours is not None


CASES = [
    '<link name="a${1+2}" size="${2*0.5} $(arg x)"/>',
    "<link name='$${literal} $$(x) $ alone'/>",
    '<xacro:property name="p" value="3"/><xacro:property name="q" value="${p*2}"/><a b="${q}"/>',
    '<xacro:property name="p" value="3"/><xacro:property name="p" value="4"/><a b="${p}"/>',
    '<xacro:macro name="m" params="a b:=2 *block"><l n="${a}-${b}"/>'
    '<xacro:insert_block name="block"/></xacro:macro><xacro:m a="1"><o x="${1/2}"/></xacro:m>'
    '<xacro:m a="x" b="y"><o/></xacro:m>',
    '<xacro:macro name="m" params="**many"><w><xacro:insert_block name="many"/></w></xacro:macro>'
    "<xacro:m><many><i/><j/></many></xacro:m>",
    '<xacro:macro name="m" params="n"><xacro:if value="${n > 0}"><l n="${n}"/><xacro:m n="${n-1}"/>'
    '</xacro:if></xacro:macro><xacro:m n="5"/>',
    '<xacro:unless value="0"><a/></xacro:unless><xacro:if value="false"><b/></xacro:if>',
    '<xacro:element xacro:name="link" name="x"/><a><xacro:attribute name="b" value="c"/></a>',
    "<!-- kept --><a/><!-- lost --><xacro:arg name='y' default='1'/><b c='$(arg y)'/>",
    "<a>text ${1+1} &amp; &lt;</a><![CDATA[ <raw> ]]>",
    '<xacro:property name="o"><origin xyz="0 0 1"/></xacro:property><xacro:insert_block name="o"/>',
    '<a list="${[i*i for i in range(4)]}" d="${dict(a=1)[\'a\']}" pow="${2**3} ${1 &lt;&lt; 4}"/>',
    '<xacro:macro name="m" params="x:=^|7"><a v="${x}"/></xacro:macro><xacro:m/>',
    '<xacro:call macro="m"/>',
    # elements in which xacro seems to change nothing
    "<a><!-- xacro:eval-comments --><!-- ${1+1} --><b/></a><c><!-- ${1+1} --></c>",
    '<a xmlns:xacro="http://www.ros.org/wiki/xacro"><b/></a><a xacro:c="d"><b><c/></b></a>',
    "<a><b>$${x}</b></a><a><b><c/>${1+1}</b></a><a><b c='$$(x)'/></a>",
    '<xacro:macro name="m" params="*block"><xacro:insert_block name="block"/><a><b/></a>'
    '<xacro:insert_block name="block"/></xacro:macro><xacro:m><c><d e="$${1+1}"/></c></xacro:m>',
    # names alone, values that look like numbers, and arguments that are evaluated twice
    '<xacro:property name="p" value="${q}"/><xacro:property name="q" value="1_0"/><a b="${p}"/>',
    '<xacro:property name="p" value="true"/><a b="${p}" c="${p and 1}" d="${ p }"/>',
    '<xacro:macro name="m" params="a b c"><l a="${a}" b="${b}" c="${c}"/></xacro:macro>'
    '<xacro:m a="${[1]}" b="${[1]}" c="x${1}"/>',
]


@pytest.mark.parametrize("inside", CASES)
def test_constructs_expand_as_xacro_expands_them(inside, tmp_path):
    path = tmp_path / "r.xacro"
    inside = '<xacro:macro name="m"><called/></xacro:macro>' + inside
    path.write_text(XACRO.format(inside))
    ours = expand(path, x="given")
    theirs = xacro.process_file(str(path), mappings={"x": "given"})
    assert canonical(ours.text) == canonical(theirs.toprettyxml(indent="  "))


pieces = st.sampled_from(["${", "}", "$", "$$", "$(", ")", "a", "1+1", " ", "{", "(", "'", "arg x"])


@settings(max_examples=25)
@given(st.lists(pieces, max_size=7).map("".join))
def test_any_text_is_evaluated_as_xacro_evaluates_it(text):
    file = SourceFile("r.xacro", b'<r xmlns:xacro="http://www.ros.org/wiki/xacro"/>')
    written = text.replace("&", "&amp;").replace('"', "&quot;")
    file.data = file.data.replace(b"<r ", f'<r t="{written}" '.encode())
    try:
        xacro.init_stacks(None)
        document = xacro.parse(file.data.decode())
        xacro.process_doc(document, mappings={"x": "given"})
        theirs = document.documentElement.getAttribute("t")
    except Exception:
        with pytest.raises(XacroError):
            expand_xacro(file, {"x": "given"}, Packages())
    else:
        ours = expand_xacro(file, {"x": "given"}, Packages())
        assert ours.tree.documentElement.getAttribute("t") == theirs


def test_xacro_is_not_changed_in_this_process():
    import xacro.substitution_args as substitution

    own = (xacro_hooks.xacro, xacro_hooks.substitution_args)
    before = [(module, dict(vars(module))) for module in (xacro, substitution, *own)]
    for inside in ("<a/>", '<a b="${nope}"/>'):
        with suppress(XacroError):
            expand_text(inside)
    assert [dict(vars(module)) == values for module, values in before] == [True] * 4
    assert xacro_hooks.xacro is not xacro


def test_arguments_do_not_leak_from_one_file_to_the_next():
    expand_text('<xacro:arg name="p" default="1"/><a b="$(arg p)"/>')
    with pytest.raises(XacroError, match="'p' has no value"):
        expand_text('<a b="$(arg p)"/>')


# Where it came from --------------------------------------------------------------------------


def test_an_element_of_a_macro_names_its_line_and_the_call(xacro_file):
    path = xacro_file(
        "r.xacro",
        '<xacro:macro name="wheel" params="prefix">\n  <link name="${prefix}wheel"/>\n'
        '</xacro:macro>\n<xacro:wheel prefix="left_"/>\n<xacro:wheel prefix="${\'right\'}_"/>',
    )
    expansion = expand(path)
    for name, line, argument in (("left_wheel", 5, "left_"), ("right_wheel", 6, "right_")):
        link = find(expansion, "link", name)
        assert (link.place.line, link.place.column) == (3, 3)
        (call,) = link.calls
        assert (call.macro, call.line, dict(call.arguments)) == (
            "wheel",
            line,
            {"prefix": argument},
        )


def test_a_macro_in_a_macro_names_both_calls(xacro_file):
    path = xacro_file(
        "r.xacro",
        '<xacro:macro name="a" params="n"><link name="${n}"/></xacro:macro>\n'
        '<xacro:macro name="b" params="n">\n<xacro:a n="${n}_x"/>\n</xacro:macro>\n'
        '<xacro:b n="one"/>',
    )
    link = find(expand(path), "link", "one_x")
    assert [(call.macro, call.line) for call in link.calls] == [("a", 4), ("b", 6)]


def test_a_file_included_twice_names_both_includes(xacro_file, write):
    write("part.xacro", XACRO.format('<link name="l"/>'))
    path = xacro_file(
        "r.xacro",
        '<xacro:include filename="part.xacro"/>\n<xacro:include filename="part.xacro"/>',
    )
    links = [e for e in expand(path).make_document().root.walk() if e.tag == "link"]
    assert [str(link.place) for link in links] == ["part.xacro:2:1"] * 2
    assert [[c.line for c in link.calls] for link in links] == [[2], [3]]
    assert all(call.what == "include" for link in links for call in link.calls)


def test_a_block_keeps_the_line_of_the_caller(xacro_file):
    path = xacro_file(
        "r.xacro",
        '<xacro:macro name="m" params="*origin"><j><xacro:insert_block name="origin"/></j>'
        '</xacro:macro>\n<xacro:m>\n<origin xyz="1 2 3"/>\n</xacro:m>',
    )
    assert find(expand(path), "origin").place.line == 4


def test_an_attribute_of_an_expanded_element_is_found_in_the_source(xacro_file):
    path = xacro_file("r.xacro", '<link name="${1}"\n   mass="2"/>')
    place = find(expand(path), "link").locate_attribute("mass")
    assert (place.line, place.column) == (3, 4)


# What goes wrong -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("inside", "line", "column", "message"),
    [
        ('\n<a b="${widht}"/><xacro:property name="width" value="1"/>', 3, 4, "mean 'width'"),
        ('<xacro:macro name="wheel"/>\n<xacro:wheeel/>', 3, 1, "mean 'wheel'"),
        ('<a b="$(arg prefix)"/>', 2, 4, "prefix:=VALUE"),
        ('<xacro:include filename="absent.xacro"/>', 2, 16, "absent.xacro: "),
        ('<xacro:macro name="m" params="a"/>\n<xacro:m/>', 3, 1, "without 'a'"),
        ('<xacro:macro name="m"/>\n<xacro:m a="1"/>', 3, 10, "no parameter 'a'"),
        ('<xacro:if value="maybe"/>', 2, 1, "condition maybe "),
        ('<xacro:property name="a" value="${a}"/><b c="${a}"/>', 2, 43, "circular"),
        ('<a b="${1 +}"/>', 2, 4, "invalid syntax"),
        ('<a b="${10**10**9}"/>', 2, 4, "number exceeds the limit"),
        ('<a b="${__import__}"/>', 2, 4, "__import__"),
        ('<a b="${unclosed"/>', 2, 4, "no closing bracket"),
        ('<xacro:property value="1"/>', 2, 1, "has no attribute 'name'"),
        ('<xacro:macro name="m"><xacro:m/></xacro:macro>\n<xacro:m/>', 2, 23, "calls itself"),
        (
            '<xacro:macro name="m" params="a *b **c"/>\n<xacro:m a="1"><d/></xacro:m>',
            *(3, 1, r"\('b', 'c'\).* \(<d>\); add .* for 'c'"),
        ),
        (
            '<xacro:macro name="m" params="*b"/>\n<xacro:m><d/><e/></xacro:m>',
            *(3, 1, r"\('b'\).* \(<d>, <e>\); remove <e>"),
        ),
        ('<xacro:macro name="m"/>\n<xacro:m><d/></xacro:m>', 3, 1, r"no block parameters.*\*d"),
        ('<a/>\n<xacro:insert_block name="d"/>', 3, 1, "block 'd' is not defined"),
        (
            '<xacro:macro name="m" params="*body"><xacro:insert_block name="bodi"/></xacro:macro>'
            "<xacro:m><d/></xacro:m>",
            *(2, 38, r"'m' has no block parameter 'bodi'.*mean 'body'"),
        ),
        ('<xacro:macro name="m" params="a:=^"/>\n<xacro:m/>', 3, 1, r"property 'a'"),
        ('<xacro:macro name="call"/>', 2, 1, "cannot be named 'call'"),
        ('<xacro:macro name="a.b"/>', 2, 1, "to a_b"),
        ('<xacro:property name="a-b" value="1"/>', 2, 1, "'a-b' is not a valid .* to a_b"),
        ('<xacro:property name="__a" value="1"/>', 2, 1, "'__a' is not a valid .* to a"),
        ('<xacro:property name="a" value="1" default="2"/>', 2, 1, "keep only one"),
        ('<a/>\n<xacro:call a="1"/>', 3, 1, "<xacro:call> has no attribute 'macro'"),
        ("<a/>\n<xacro:element/>", 3, 1, "<xacro:element> has no attribute 'xacro:name'"),
        ('<a>\n<xacro:attribute name="" value="1"/></a>', 3, 1, "empty name"),
        ('<a b="$(find c d)"/>', 2, 4, r"use \$\(find PACKAGE\)$"),
        ('<a b="$(find $c)"/>', 2, 4, r"'\$' is not allowed inside \$\(find \$c\);"),
        ("<a b=\"${dict(a=1)['b']}\"/>", 2, 4, "key 'b' does not exist, in"),
    ],
)
def test_what_fails_names_its_line_and_says_what_would_be_right(
    xacro_file, inside, line, column, message
):
    with pytest.raises(XacroError, match=message) as caught:
        expand(xacro_file("r.xacro", inside))
    assert (caught.value.line, caught.value.column) == (line, column)


def test_a_failure_in_a_macro_names_the_calls(xacro_file):
    path = xacro_file(
        "r.xacro",
        '<xacro:macro name="m" params="a"><l n="${b}"/></xacro:macro>\n<xacro:m a="1"/>',
    )
    with pytest.raises(XacroError, match="'b' is not defined") as caught:
        expand(path)
    assert [call.what for call in caught.value.calls] == ["macro 'm' a=1"]


def test_a_missing_package_is_named_with_the_places_searched(xacro_file):
    with pytest.raises(PackageNotFound, match="'nowhere'") as caught:
        expand(xacro_file("r.xacro", '<xacro:include filename="$(find nowhere)/a.xacro"/>'))
    assert caught.value.line == 2
    assert caught.value.notes
    assert not any(str(Path.cwd()) in note for note in caught.value.notes), "one style of path"


def test_an_included_file_that_is_not_well_formed_is_named(xacro_file, write):
    write("bad.xacro", "<robot>\n<link>\n</robot>")
    with pytest.raises(XmlError) as caught:
        expand(xacro_file("r.xacro", '<xacro:include filename="bad.xacro"/>'))
    assert caught.value.path == "bad.xacro"
    assert caught.value.line == 3


def test_an_include_of_itself_ends():
    with pytest.raises(XacroError, match="nested more than"):
        path = Path("self.xacro")
        path.write_text(XACRO.format('<xacro:include filename="self.xacro"/>'))
        expand(path)


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_an_optional_include_may_be_missing():
    assert expand_text('<xacro:include filename="absent.xacro" optional="true"/><a/>').text


def test_yaml_is_read_and_its_faults_are_placed(xacro_file, write):
    write("c.yaml", "a: {b: !degrees 180}\n")
    inside = '<xacro:property name="c" value="${xacro.load_yaml(\'%s\')}"/><l n="${c.a.b}"/>'
    expansion = expand(xacro_file("r.xacro", inside % "c.yaml"))
    assert find(expansion, "l").get("n").startswith("3.14159")
    assert expansion.dependencies == ["c.yaml"]
    write("bad.yaml", "a: [1\nb: }")
    with pytest.raises(XacroError, match=r"bad\.yaml:2"):
        expand(xacro_file("s.xacro", inside % "bad.yaml"))


def test_units_of_yaml_are_read_also_where_yaml_is_loaded_before(xacro_file, write):
    write("c.yaml", "a: !millimeters 5\n")
    code = "import yaml, urdftool\nprint(urdftool.expand('r.xacro'))"
    inside = '<xacro:include filename="part.xacro"/><l n="${c.a}"/>'
    write("part.xacro", XACRO.format('<xacro:property name="c" value="${load_yaml(\'c.yaml\')}"/>'))
    xacro_file("r.xacro", inside)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert '<l n="0.005"/>' in done.stdout, done.stderr


def test_too_many_elements_end(monkeypatch):
    monkeypatch.setattr(xacro_hooks, "MAX_ELEMENTS", 2000)  # of a fork; others have the real one
    macros = "".join(
        f'<xacro:macro name="m{i}"><xacro:m{i - 1}/><xacro:m{i - 1}/></xacro:macro>'
        for i in range(1, 30)
    )
    with pytest.raises(XacroError, match="more than"):
        expand_text(f'<xacro:macro name="m0"><a/></xacro:macro>{macros}<xacro:m29/>')
