"""Renaming, as an editor asks for it: every reference, or a refusal with its reason and place."""

import pytest

from tests.server.client import Client
from tests.server.test_navigation import XMLNS, find

pytest.importorskip("pygls")

MAIN = f"""<robot name="two" {XMLNS}>
  <xacro:arg name="wide" default="1"/>
  <xacro:property name="mount" value="base"/>
  <xacro:include filename="wheel.xacro"/>
  <material name="red"><color rgba="1 0 0 1"/></material>
  <link name="base"><visual><geometry><box size="$(arg wide) 1 1"/></geometry>
    <material name="red"/></visual></link>
  <xacro:wheel prefix="left_" parent="base"/>
  <xacro:wheel prefix="right_" parent="${{mount}}"/>
  <link name="tip"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <xacro:property name="which" value="wheel"/>
  <transmission name="t"><joint name="lift"/></transmission>
  <gazebo reference="left_hub"><mu1>1</mu1></gazebo>
  <link name="link${{1 + 1}}"/>
  <joint name="odd" type="fixed"><parent link="base"/><child link="${{'link'}}2"/></joint>
</robot>
"""
WHEEL = f"""<robot {XMLNS}>
  <xacro:macro name="wheel" params="prefix parent radius:=0.1">
    <link name="${{prefix}}hub"/>
    <joint name="${{prefix}}turn" type="continuous">
      <parent link="${{parent}}"/><child link="${{prefix}}hub"/><axis xyz="0 ${{radius * 10}} 0"/>
    </joint>
  </xacro:macro>
</robot>
"""
SRDF = """<robot name="two">
  <group name="arm"><joint name="lift"/><link name="left_hub"/></group>
</robot>
"""
YAML = "controller:\n  joints: [lift, left_turn]\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("robot").resolve()
    (folder / "two.urdf.xacro").write_text(MAIN)
    (folder / "wheel.xacro").write_text(WHEEL)
    (folder / "two.srdf").write_text(SRDF)
    (folder / "config").mkdir()
    (folder / "config" / "controllers.yaml").write_text(YAML)
    (folder / "package.xml").write_text("<package><name>two</name></package>")
    return folder


@pytest.fixture(scope="module")
def client(folder):
    with Client(folder) as client:
        for name in ("two.urdf.xacro", "wheel.xacro"):
            client.open(folder / name)
        client.settle(folder / "wheel.xacro")
        yield client


def rename(client, path, marked, new):
    line, column = find(path.read_text(), marked)
    return client.request(
        "textDocument/rename",
        textDocument={"uri": path.as_uri()},
        position={"line": line, "character": column},
        newName=new,
    )


def apply(path, edits):
    """Return the text of a file with edits."""
    lines = path.read_text().splitlines(keepends=True)
    for edit in sorted(edits, key=lambda e: str(e["range"]["start"]), reverse=True):
        start, end = edit["range"]["start"], edit["range"]["end"]
        assert start["line"] == end["line"]
        line = lines[start["line"]]
        new = line[: start["character"]] + edit["newText"] + line[end["character"] :]
        lines[start["line"]] = new
    return "".join(lines)


def replace(text, *pairs):
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return text


CASES = {
    "a link that calls and a property name": (
        "two.urdf.xacro",
        'link name="ba|se"',
        "body",
        {"two.urdf.xacro": (('"base"', '"body"'),)},
    ),
    "a joint, in SRDF, controllers and a transmission": (
        "two.urdf.xacro",
        '<joint name="li|ft" type',
        "raise_",
        {
            "two.urdf.xacro": (('"lift"', '"raise_"'),),
            "two.srdf": (('"lift"', '"raise_"'),),
            "config/controllers.yaml": (("lift", "raise_"),),
        },
    ),
    "the literal part of a link": (
        "wheel.xacro",
        '<link name="${prefix}h|ub"',
        "rim",
        {
            "wheel.xacro": (("}hub", "}rim"),),
            "two.urdf.xacro": (("left_hub", "left_rim"),),
            "two.srdf": (("left_hub", "left_rim"),),
        },
    ),
    "a macro": (
        "two.urdf.xacro",
        '<xacro:wh|eel prefix="left',
        "roll",
        {
            "two.urdf.xacro": (("xacro:wheel", "xacro:roll"),),
            "wheel.xacro": (('name="wheel"', 'name="roll"'),),
        },
    ),
    "a parameter": (
        "wheel.xacro",
        "{par|ent}",
        "above",
        {
            "two.urdf.xacro": ((" parent=", " above="),),
            "wheel.xacro": (("x parent", "x above"), ("{parent}", "{above}")),
        },
    ),
    "a property": (
        "two.urdf.xacro",
        "{mou|nt}",
        "holder",
        {"two.urdf.xacro": (("mount", "holder"),)},
    ),
    "an argument": (
        "two.urdf.xacro",
        '"$(arg wi|de)',
        "broad",
        {"two.urdf.xacro": (('"wide"', '"broad"'), ("arg wide", "arg broad"))},
    ),
    "a material": (
        "two.urdf.xacro",
        '<material name="r|ed"/>',
        "blue",
        {"two.urdf.xacro": (('"red"', '"blue"'),)},
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_rename(client, folder, case):
    file, marked, new, expected = CASES[case]
    answer = rename(client, folder / file, marked, new)
    assert "error" not in answer, answer
    changes = answer["result"]["changes"]
    assert set(changes) == {(folder / name).as_uri() for name in expected}
    for name, pairs in expected.items():
        path = folder / name
        after = apply(path, changes[path.as_uri()])
        assert after == replace(path.read_text(), *pairs)


@pytest.mark.parametrize(
    ("file", "marked", "new", "reason"),
    [
        ("two.urdf.xacro", 'link name="ba|se"', "tip", "the robot has 'tip' already"),
        ("two.urdf.xacro", 'link name="ba|se"', "a b", "cannot be a name"),
        (
            "two.urdf.xacro",
            'link name="li|nk${1',
            "part",
            "name '${'link'}2' is computed, and would have to change",
        ),
        ("wheel.xacro", "{par|ent}", "radius", "'radius' is defined already"),
        ("wheel.xacro", "{par|ent}", "pi", "'pi' is a name of xacro or Python"),
        ("wheel.xacro", "{par|ent}", "1", "'1' is not a name that expressions can use"),
        ("two.urdf.xacro", '<xacro:wh|eel prefix="left', "a b", "name of an element"),
        ("two.urdf.xacro", 'filename="wh|eel', "x", "no name that can be changed"),
    ],
)
def test_refusal(client, folder, file, marked, new, reason):
    answer = rename(client, folder / file, marked, new)
    assert reason in answer["error"]["message"]


def test_a_computed_call_is_refused_with_its_place(client, folder):
    path = folder / "two.urdf.xacro"
    text = MAIN.replace(
        '<xacro:wheel prefix="left_"', '<xacro:call macro="${which}" prefix="left_"'
    )
    text = text.replace('  <xacro:property name="which" value="wheel"/>\n', "")
    text = text.replace(
        "  <xacro:include", '  <xacro:property name="which" value="wheel"/>\n  <xacro:include'
    )
    client.change(path, text=text)
    answer = rename(client, folder / "wheel.xacro", 'macro name="wh|eel', "roll")
    client.change(path, text=MAIN)
    message = answer["error"]["message"]
    assert "the name of the macro is computed here" in message
    assert "two.urdf.xacro:9:22" in message


def test_prepare(client, folder):
    path = folder / "wheel.xacro"
    line, column = find(WHEEL, '<link name="${prefix}h|ub"')
    found = client.ask_at("textDocument/prepareRename", path, line, column)
    assert found["placeholder"] == "hub"
    assert found["range"]["start"]["character"] == column - 1
    assert client.ask_at("textDocument/prepareRename", path, 0, 2) is None
