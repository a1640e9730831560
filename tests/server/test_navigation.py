"""Definitions, references and renaming, as an editor asks for them."""

import pytest

from tests.server.client import Client

pytest.importorskip("pygls")

XMLNS = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LIBRARY = f"""<robot {XMLNS}>
  <xacro:property name="length" value="${{2 * half}}"/>
  <xacro:property name="half" value="0.5"/>
  <xacro:macro name="bar" params="name *pose size:=${{length}}">
    <link name="${{name}}_bar">
      <visual><xacro:insert_block name="pose"/>
        <geometry><box size="${{size}} 1 1"/></geometry></visual>
    </link>
    <xacro:if value="$(arg wide)">
      <link name="${{name}}_wide"/>
    </xacro:if>
  </xacro:macro>
  <xacro:macro name="unused" params="size"><link name="${{size}} ${{half}}"/></xacro:macro>
</robot>
"""
MAIN = f"""<robot name="one" {XMLNS}>
  <xacro:arg name="wide" default="false"/>
  <xacro:include filename="library.xacro"/>
  <material name="red"><color rgba="1 0 0 1"/></material>
  <link name="base"><visual><geometry><mesh filename="package://one/base.stl"/></geometry>
    <material name="red"/></visual></link>
  <xacro:bar name="left"><origin xyz="0 0 0"/></xacro:bar>
  <joint name="turn" type="fixed"><parent link="base"/><child link="left_bar"/></joint>
  <gazebo reference="left_bar"><mu1>1</mu1></gazebo>
  <transmission name="t"><joint name="turn"/></transmission>
</robot>
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("robot").resolve()
    (folder / "library.xacro").write_text(LIBRARY)
    (folder / "one.urdf.xacro").write_text(MAIN)
    (folder / "package.xml").write_text("<package><name>one</name></package>")
    (folder / "base.stl").write_bytes(bytes(84))
    return folder


@pytest.fixture(scope="module")
def client(folder):
    with Client(folder) as client:
        client.open(folder / "one.urdf.xacro")
        client.open(folder / "library.xacro")
        client.settle(folder / "library.xacro")
        yield client


def find(text, marked):
    """Return line and column of the mark ``|`` in a part of a text."""
    offset = text.index(marked.replace("|", "")) + marked.index("|")
    before = text[:offset].split("\n")
    return len(before) - 1, len(before[-1])


def get_text(folder, location):
    """Return file name and text of a location."""
    path = folder / location["uri"].rpartition("/")[2]
    start, end = location["range"]["start"], location["range"]["end"]
    line = path.read_text("latin-1").split("\n")[start["line"]]
    return path.name, start["line"], line[start["character"] : end["character"]]


MAIN_FILE, LIBRARY_FILE = "one.urdf.xacro", "library.xacro"


@pytest.mark.parametrize(
    ("file", "marked", "expected"),
    [
        (MAIN_FILE, "<xacro:b|ar name", [(LIBRARY_FILE, 3, "bar")]),
        (MAIN_FILE, "</xacro:b|ar>", [(LIBRARY_FILE, 3, "bar")]),
        (MAIN_FILE, "bar na|me=", [(LIBRARY_FILE, 3, "name")]),
        (MAIN_FILE, 'parent link="ba|se"', [(MAIN_FILE, 4, "base")]),
        (MAIN_FILE, 'child link="left|_bar"', [(LIBRARY_FILE, 4, "${name}_bar")]),
        (MAIN_FILE, 'reference="left|_bar"', [(LIBRARY_FILE, 4, "${name}_bar")]),
        (MAIN_FILE, '<joint name="tu|rn"/>', [(MAIN_FILE, 7, "turn")]),
        (MAIN_FILE, '<material name="r|ed"/>', [(MAIN_FILE, 3, "red")]),
        (MAIN_FILE, 'filename="lib|rary', [(LIBRARY_FILE, 0, "")]),
        (MAIN_FILE, "package://one/ba|se.stl", [("base.stl", 0, "")]),
        (LIBRARY_FILE, "${2 * ha|lf}", [(LIBRARY_FILE, 2, "half")]),
        (LIBRARY_FILE, "size:=${len|gth}", [(LIBRARY_FILE, 1, "length")]),
        (LIBRARY_FILE, "${na|me}_bar", [(LIBRARY_FILE, 3, "name")]),
        (LIBRARY_FILE, 'insert_block name="po|se"', [(LIBRARY_FILE, 3, "pose")]),
        (LIBRARY_FILE, "$(arg wi|de)", [(MAIN_FILE, 1, "wide")]),
        # code that no expansion reaches
        (LIBRARY_FILE, "${na|me}_wide", [(LIBRARY_FILE, 3, "name")]),
        (LIBRARY_FILE, 'link name="${si|ze} ${half}', [(LIBRARY_FILE, 12, "size")]),
        (LIBRARY_FILE, "${size} ${ha|lf}", [(LIBRARY_FILE, 2, "half")]),
        (MAIN_FILE, "<rob|ot name", []),
    ],
)
def test_definition(client, folder, file, marked, expected):
    line, column = find((folder / file).read_text(), marked)
    found = client.ask_at("textDocument/definition", folder / file, line, column)
    assert [get_text(folder, one) for one in found] == expected


@pytest.mark.parametrize(
    ("file", "marked", "expected"),
    [
        (
            LIBRARY_FILE,
            '<link name="${name}_b|ar"',
            [(LIBRARY_FILE, 4), (MAIN_FILE, 7), (MAIN_FILE, 8)],
        ),
        (
            LIBRARY_FILE,
            'params="na|me',
            [(LIBRARY_FILE, 3), (LIBRARY_FILE, 4), (LIBRARY_FILE, 9), (MAIN_FILE, 6)],
        ),
        (
            LIBRARY_FILE,
            'property name="ha|lf',
            [(LIBRARY_FILE, 1), (LIBRARY_FILE, 2), (LIBRARY_FILE, 12)],
        ),
        (LIBRARY_FILE, 'macro name="b|ar', [(LIBRARY_FILE, 3), (MAIN_FILE, 6), (MAIN_FILE, 6)]),
        (MAIN_FILE, 'arg name="wi|de', [(LIBRARY_FILE, 8), (MAIN_FILE, 1)]),
        (MAIN_FILE, '<joint name="tu|rn" type', [(MAIN_FILE, 7), (MAIN_FILE, 9)]),
    ],
)
def test_references(client, folder, file, marked, expected):
    line, column = find((folder / file).read_text(), marked)
    context = {"includeDeclaration": True}
    found = client.ask_at("textDocument/references", folder / file, line, column, context=context)
    places = sorted(get_text(folder, one)[:2] for one in found)
    assert places == expected
