"""Encodings, characters and file names that text cannot have: messages, never a traceback."""

import os
import shutil
import sys
from xml.etree import ElementTree

import pytest
from hypothesis import given, note, settings
from hypothesis import strategies as st

from tests.conftest import FIXTURES, XACRO
from urdftool.errors import SourceError, XacroError
from urdftool.source.document import parse
from urdftool.source.expand import expand_xacro
from urdftool.source.location import SourceFile
from urdftool.source.packages import Packages
from urdftool.source.xacro_parse import parse_xacro
from urdftool.source.xacro_tree import COMMENT, ELEMENT

# Encodings --------------------------------------------------------------------------------------

NOT_TEXT = (
    "zlib",
    "hex",
    "rot13",
    "base64",
    "bz2",
    "uu",
    "quopri",
    "idna",
    "punycode",
    "undefined",
)
NOT_READ = ("utf-7", "utf-16", "utf-32", "unicode_escape", "raw_unicode_escape", "cp037")
UNKNOWN = ("nonsense", "iso-8859-99", "shift_jis", "gb2312", "x" * 300)
FILES = {
    "r.urdf": '<robot name="r"><link name="a"/></robot>',
    "none.urdf": '<robot name="r"></robot>',
    "r.xacro": XACRO.format('<link name="${1}"/>'),
    "r.sdf": '<sdf version="1.9"><model name="m"><link name="a"/></model></sdf>',
    "none.sdf": '<sdf version="1.9"></sdf>',
    "r.srdf": '<robot name="r"><group name="g"><link name="a"/></group></robot>',
    "r.xml": "<mujoco><worldbody><body><geom size='1'/></body></worldbody></mujoco>",
}  # fmt: skip
COMMANDS = ("lint", "info", "expand")
QUICK = ("zlib", "utf-7", "nonsense")


def is_said(done):
    """Whether a run ended with a result or a message."""
    good = done.code in (0, 1) or (done.code == 2 and done.err)
    return bool(good) and "Traceback" not in done.err and "bug in" not in done.err + done.out


@pytest.mark.parametrize(
    "encoding",
    [
        pytest.param(name, marks=[] if name in QUICK else [pytest.mark.slow])
        for name in (*NOT_TEXT, *NOT_READ, *UNKNOWN)
    ],
)
def test_encodings_that_are_not_read(urdftool, write, encoding):
    head = f'<?xml version="1.0" encoding="{encoding}"?>\n'
    for name, text in FILES.items():
        if name.endswith(".xml"):
            pytest.importorskip("mujoco")
        write(name, head + text)
        for command in COMMANDS:
            assert is_said(urdftool(*command.split(), name)), (command, name)
    done = urdftool("lint", "none.urdf")
    assert f"encoding '{encoding}' is not supported" in " ".join(done.out.split())
    done = urdftool("info", "r.sdf")  # libsdformat takes the bytes as UTF-8, whatever is written
    said = " ".join(done.err.split())
    assert (done.code, f"encoding '{encoding}' is not supported" in said) == (0, True)


def test_an_encoding_of_other_files(urdftool, write, xacro_file):
    head = '<?xml version="1.0" encoding="zlib"?>\n'
    xacro_file("r.xacro", '<xacro:include filename="part.xacro"/><link name="a"/>')
    write("part.xacro", head + XACRO.format(""))
    done = urdftool("expand", "r.xacro")
    assert done.code == 2
    assert "part.xacro:1:1: the text cannot be decoded (encoding 'zlib'" in done.err
    write("pkg/package.xml", head + "<package><name>p</name></package>")
    write("pkg/r.urdf", FILES["r.urdf"])
    assert is_said(urdftool("lint", "pkg"))
    write("r.srdf", head + FILES["r.srdf"])
    write("r.urdf", FILES["r.urdf"])
    assert is_said(urdftool("simulate", "r.urdf", "--duration", "0.1", "--srdf", "r.srdf"))


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be", "utf-32-le", "utf-32-be"])
def test_wide_text_without_a_mark(urdftool, write, encoding):
    write("r.urdf", FILES["r.urdf"].encode(encoding))
    assert "robot" in urdftool("info", "r.urdf").out
    assert urdftool("lint", "r.urdf").code in (0, 1)
    write("cut.urdf", FILES["r.urdf"].encode(encoding)[:-1])
    assert is_said(urdftool("info", "cut.urdf"))


@pytest.mark.parametrize(
    "name", ["iso-8859-1", "windows-1252", "cp1252", "KOI8-R", "latin1", "UTF_8"]
)
def test_encodings_that_are_read(name):
    text = f'<?xml version="1.0" encoding="{name}"?><robot name="r"/>'
    assert parse(SourceFile("r.urdf", text.encode(name))).root.get("name") == "r"


YAML_LINES = (b"a: \xff\xfe\x00", b'a: "\\ud800"', b'a: "\\x00"', "a: \u202e".encode(), b"\x00")


@pytest.mark.parametrize("data", YAML_LINES)
def test_text_of_other_files(urdftool, write, xacro_file, data):
    write("v.yaml", data)
    write("r.urdf", FILES["r.urdf"])
    xacro_file("r.xacro", "<link name=\"${xacro.load_yaml('v.yaml')['a']}\"/>")
    for words in (
        "expand r.xacro",
        "info r.xacro",
        "lint r.xacro",
        "simulate r.urdf --duration 0.1 --controllers v.yaml",
        "inertia robot r.urdf --masses v.yaml",
        "--config v.yaml lint r.urdf",
        "lint r.urdf --baseline v.yaml",
    ):
        assert is_said(urdftool(*words.split())), words
    write("urdftool.toml", data)
    assert is_said(urdftool("lint", "r.urdf"))
    write("package.xml", data)
    assert is_said(urdftool("lint", "."))


# File names -------------------------------------------------------------------------------------

BYTES = os.fsdecode(b"bad\xff\xfename")
NAMED = """
lint BAD.urdf --format full
lint BAD.urdf --format concise
lint BAD.urdf --format json
lint BAD.urdf --format sarif
lint BAD.urdf --format github
lint . --format junit
lint . --format html
lint BAD.xacro
lint --fix --diff BAD.urdf
info BAD.urdf
info BAD.urdf --format json
expand BAD.xacro
expand BAD.xacro --deps
expand BAD.xacro -o BAD.out
expand BAD.xacro -o o.urdf --depfile BAD.d
BAD
--BAD
expand BAD.xacro --source-map - -o o.urdf
graph BAD.urdf -o -
graph BAD.urdf -o BAD.gv
diff BAD.urdf good.urdf
diff BAD.urdf good.urdf --format json
verify BAD.urdf BAD.sdf
verify BAD.urdf BAD.sdf --format json
inertia robot BAD.urdf
inertia mesh BAD.obj --mass 1
collision BAD.urdf -o BAD.o.urdf --method hull
bundle BAD.urdf -o b
bundle good.urdf -o BAD
bundle good.urdf -o BAD.zip
export sdf BAD.urdf -o s.sdf --verify
info absentBAD
export sdf good.urdf -o BAD.o.sdf --verify
export mjcf BAD.urdf -o m.xml --force
export mjcf good.urdf -o BAD.xml --verify
export urdf BAD.sdf -o BAD.o.urdf --verify
export usd BAD.urdf -o u.usda
export usd good.urdf -o BAD.usda
info good.urdf -p x=BAD
lint good.urdf --output-file BAD.txt
lint good.urdf --write-baseline BAD.json
lint good.urdf --package-path BAD
info arg.xacro n:=BAD
expand arg.xacro n:=BAD
expand arg.xacro n:=a f:=BAD.xacro
expand arg.xacro n:=a f:=absentBAD
info mesh.xacro n:=BAD
view good.urdf --picture BAD.png --size 32x32
lint --select BAD good.urdf
lint --explain BAD
""".strip().splitlines()


@pytest.fixture
def badly_named(write, tmp_path):
    """A folder of files whose name is not UTF-8."""
    try:
        write(f"{BYTES}.urdf", FILES["r.urdf"].replace("/></robot>", "><visual><geometry><mesh "
              'filename="cube.obj"/></geometry></visual></link></robot>'))  # fmt: skip
    except (OSError, UnicodeError):
        pytest.skip("the file system has no such names")
    write("good.urdf", FILES["r.urdf"])
    write(f"{BYTES}.xacro", FILES["r.xacro"])
    write(f"{BYTES}.sdf", FILES["r.sdf"])
    argument = '<xacro:arg name="n" default=""/><xacro:arg name="f" default=""/>'
    include = '<xacro:if value="${True}"><xacro:include filename="$(arg f)"/></xacro:if>'
    write("arg.xacro", XACRO.format(f'{argument}<link name="$(arg n)"/>{include}'))
    mesh = '<visual><geometry><mesh filename="$(arg n).obj"/></geometry></visual>'
    write("mesh.xacro", XACRO.format(f'{argument}<link name="a">{mesh}</link>'))
    write(f"{BYTES}/{BYTES}.urdf", FILES["r.urdf"])
    for name in ("cube.obj", f"{BYTES}.obj", "cube.mtl"):
        shutil.copyfile(FIXTURES / "meshes" / name.replace(BYTES, "cube"), tmp_path / name)
    return tmp_path


@pytest.mark.skipif(sys.platform == "win32", reason="all names are text there")
@pytest.mark.parametrize(
    "command",
    [*NAMED[::2], *(pytest.param(command, marks=pytest.mark.slow) for command in NAMED[1::2])],
)
def test_names_that_are_not_utf8(capfdbinary, badly_named, command):
    from urdftool import cli, terminal

    before = sys.stdout, sys.stderr
    try:
        terminal.install()
        code = cli.call([word.replace("BAD", BYTES) for word in command.split()])
        sys.stdout.flush()
        sys.stderr.flush()
    finally:
        sys.stdout, sys.stderr = before
    out, err = capfdbinary.readouterr()
    assert code in (0, 1, 2), err
    assert code != 2 or err
    assert b"Traceback" not in err
    assert b"bug in" not in err
    (err if "--de" in command else out + err).decode("utf-8")  # names of files are bytes there


# What is not XML --------------------------------------------------------------------------------

PLACES = {
    "an attribute": '<link name="a"><x y="${V}"/></link>',
    "a text": '<link name="a">${V}</link>',
    "a text with more": '<link name="a">a ${V} b<x/></link>',
    "a comment": '<link name="a"/><!-- xacro:eval-comments --><!-- ${V} -->',
    "the end of a comment": '<link name="a"/><!-- xacro:eval-comments --><!-- ${V}-->',
    "the name of an element": '<link name="a"/><xacro:element xacro:name="${V}"/>',
    "the name of an attribute": '<link name="a"><xacro:attribute name="${V}" value="1"/></link>',
    "a namespace": '<link name="a"><xacro:attribute name="xmlns:p" value="${V}"/></link>',
    "a macro": '<xacro:macro name="m" params="p"><link name="${p}"/></xacro:macro>'
    '<xacro:m p="${V}"/>',
}  # fmt: skip


def expand(inside):
    file = SourceFile("r.xacro", XACRO.format(inside).encode())
    return expand_xacro(file, {}, Packages())


def list_nodes(node):
    """Return the tree below a node: names, attributes, texts; without the space around them."""
    found = []
    for child in node.childNodes:
        if child.nodeType == ELEMENT:
            attributes = sorted(dict(child.attributes).items())
            found.append((child.tagName, attributes, list_nodes(child)))
        elif child.nodeType == COMMENT and "=====" in child.data:
            continue
        elif text := child.data.strip(" \n\t"):
            found.append((child.nodeType, text))
    return [f for f in found if not str(f[1]).startswith((" |", "|"))]


def check_written(expansion):
    """Check that what was expanded is read again as the same tree, by two parsers."""
    again = parse_xacro(SourceFile("again.urdf", expansion.text.encode()))
    assert list_nodes(again) == list_nodes(expansion.tree)
    ElementTree.fromstring(expansion.text)


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize(
    "text",
    [*(chr(code) for code in (0, 1, 8, 11, 12, 14, 27, 31, 0xD800, 0xDFFF, 0xFFFE, 0xFFFF)),
     "\ude00\ud83d", "a\x1b[31m"],
)  # fmt: skip
def test_characters_that_xml_forbids(place, text):
    with pytest.raises(XacroError) as caught:
        expand(PLACES[place].replace("V", ascii(text)))
    assert caught.value.line == (1 if "comment" in place else 2)  # that of the element around it
    assert "XML" in str(caught.value)


@pytest.mark.parametrize(
    ("place", "text"),
    [
        ("the end of a comment", "a-"), ("a comment", "\r"),
        ("the name of an element", "a b"), ("the name of an element", "a>"),
        ("the name of an element", "1"), ("the name of an element", "a:b"),
        ("the name of an element", "a/"), ("the name of an attribute", "a='1' b"),
        ("the name of an attribute", "q:a"), ("the name of an attribute", "a:b:c"),
        ("the name of an attribute", ":a"), ("the name of an attribute", "xmlns:xmlns"),
        ("a namespace", ""), ("a namespace", "a b"), ("a namespace", "http://www.w3.org/XML/1998/namespace"),
    ],
)  # fmt: skip
def test_names_and_comments_that_are_not_xml(place, text):
    with pytest.raises(SourceError) as caught:
        expand(PLACES[place].replace("V", ascii(text)))
    assert caught.value.line == (1 if "comment" in place else 2)


def test_names_of_other_types():
    for value in ("1", "1.5", "None and 1", "[1]"):
        for place in ("the name of an element", "the name of an attribute"):
            with pytest.raises(SourceError):
                check_written(expand(PLACES[place].replace("V", value)))
                raise XacroError("it is a name")  # as None is


@settings(max_examples=30)
@given(st.sampled_from(sorted(PLACES)), st.text(max_size=6))
def test_what_expands_is_read_again(place, text):
    try:
        expansion = expand(PLACES[place].replace("V", ascii(text).replace("&", "&amp;")
                           .replace("<", "&lt;").replace('"', "&quot;")))  # fmt: skip
    except SourceError:
        return
    check_written(expansion)


@settings(max_examples=6)
@given(st.text(st.sampled_from("ab-:]>&<\"'\r\n\t é\x85\u2028\U0001f916xmlns?!"), max_size=8))
def test_what_expands_is_read_again_with_odd_marks(text):
    quoted = "".join(f"\\U{ord(character):08x}" for character in text)
    for place, inside in PLACES.items():
        try:
            expansion = expand(inside.replace("V", f"'{quoted}'"))
        except SourceError:
            continue
        note(place)
        check_written(expansion)


def test_all_commands_agree(urdftool, xacro_file):
    xacro_file("r.xacro", '<link name="a"/><link name="${chr}"/>'.replace("${chr}", r"${'\x1b'}"))
    for command in ("expand", "lint", "info", "graph -o -", "inertia robot", "bundle -o b",
                    "export urdf -o u.urdf", "export sdf -o s.sdf", "verify r.xacro"):  # fmt: skip
        done = urdftool(*command.split(), "r.xacro")
        assert done.code == 2, command
        assert r"attribute 'name' has '\x1b', which XML does not allow" in done.err + done.out
