"""Completion, as an editor asks for it: the text is half-typed."""

import pytest

from tests.server.client import Client
from tests.server.test_navigation import LIBRARY, MAIN, find

pytest.importorskip("pygls")

HERE = '  <gazebo reference="left_bar">'


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("robot").resolve()
    (folder / "library.xacro").write_text(LIBRARY)
    (folder / "one.urdf.xacro").write_text(MAIN)
    (folder / "package.xml").write_text("<package><name>one</name></package>")
    (folder / "meshes").mkdir()
    (folder / "meshes" / "base.stl").write_bytes(bytes(84))
    (folder / "meshes" / "read.me").write_text("no mesh")
    return folder


@pytest.fixture(scope="module")
def client(folder):
    snippets = {"completionItem": {"snippetSupport": True}}
    capabilities = {"textDocument": {"completion": snippets}}
    with Client(folder, capabilities=capabilities) as client:
        client.open(folder / "one.urdf.xacro")
        client.open(folder / "library.xacro")
        client.settle(folder / "one.urdf.xacro")
        yield client


def complete(client, path, text, marked):
    """Type a text with a mark ``|`` at the cursor; return the items by label."""
    client.change(path, text=text.replace(marked, marked.replace("|", "")))
    line, column = find(text.replace(marked, marked.replace("|", "")), marked)
    found = client.ask_at("textDocument/completion", path, line, column)
    return {item["label"]: item for item in found["items"]}


@pytest.mark.parametrize(
    ("typed", "expected", "absent"),
    [
        ("  <|", ["link", "joint", "gazebo", "xacro:bar", "xacro:include"], ["visual", "box"]),
        ("  <xacro:b|", ["xacro:bar", "xacro:unused"], []),
        ("  <xacro:bar |", ["name", "size"], ["pose"]),
        ('  <xacro:bar name="x" |/>', ["size"], ["name"]),
        ('  <joint name="j" type="|', ["revolute", "fixed"], ["left_bar"]),
        ('  <joint name="j" type="f|"/>', ["fixed"], []),
        (
            '  <joint name="j" type="fixed"><parent link="|"/></joint>',
            ["base", "left_bar"],
            ["turn"],
        ),
        ('  <joint name="j" type="fixed"><parent |', ["link"], ["name"]),
        ('  <joint name="j" type="fixed"><mimic joint="|"/></joint>', ["turn"], ["base"]),
        ('  <gazebo reference="|"/>', ["base", "turn"], []),
        ('  <link name="n"><inertial><|</inertial></link>', ["mass", "origin"], ["link"]),
        ('  <link name="n"><visual><geometry><mesh filename="|', ["package://", "meshes"], []),
        ('  <link name="n"><visual><geometry><mesh filename="package://o|', ["one"], []),
        (
            '  <link name="n"><visual><geometry><mesh filename="package://one/meshes/|"/>',
            ["base.stl"],
            ["read.me"],
        ),
        ('  <xacro:include filename="$(find |', ["one"], []),
        ('  <xacro:include filename="$(|', ["find", "arg"], []),
        ('  <xacro:include filename="|"/>', ["library.xacro"], ["meshes/base.stl"]),
        ('  <link name="n$(arg |)"/>', ["wide"], []),
        ('  <link name="${|"/>', ["length", "half", "pi"], ["name", "size"]),
        ('  <link name="${ha|}"/>', ["half"], []),
        ('  <link name="n"><visual><material name="|"/></visual></link>', ["red"], []),
        ("  <!-- <| -->", [], ["link"]),
    ],
)
def test_completion(client, folder, typed, expected, absent):
    typed = f"{typed}\n{HERE}"
    found = complete(client, folder / "one.urdf.xacro", MAIN.replace(HERE, typed), typed)
    assert [name for name in expected if name not in found] == []
    assert [name for name in absent if name in found] == []


def test_parameters_of_the_macro_around(client, folder):
    text = LIBRARY.replace('size="${size} 1', 'size="${|} 1')
    found = complete(client, folder / "library.xacro", text, 'size="${|} 1')
    client.change(folder / "library.xacro", text=LIBRARY)
    assert [*found][:2] == ["name", "size"]
    assert "pose" not in found


def test_an_attribute_is_inserted_with_its_quotes(client, folder):
    text = MAIN.replace(HERE, f'  <joint name="j" ty|>\n{HERE}')
    found = complete(client, folder / "one.urdf.xacro", text, '<joint name="j" ty|>')
    assert found["type"]["textEdit"]["newText"] == 'type="$1"'
    span = found["type"]["textEdit"]["range"]
    assert span["end"]["character"] - span["start"]["character"] == 2
    assert "`fixed`" in found["type"]["detail"]
