"""The server as an editor sees it, over pipes."""

import subprocess
import sys
import time

import pytest

from tests.server.client import Client

pytest.importorskip("pygls")

MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="arm" params="prefix y">
    <link name="${prefix}arm"><inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1"
            ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="${prefix}swing" type="continuous">
      <parent link="base"/>
      <child link="${prefix}arm"/>
      <origin xyz="0 ${y} 0"/>
      <axis xyz="0 1 1"/>
    </joint>
  </xacro:macro>
</robot>
"""
MAIN = """<robot name="two" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="arm.xacro"/>
  <link name="base"/>
  <xacro:arm prefix="left_" y="0.5"/>
  <xacro:arm prefix="right_" y="-0.5"/>
</robot>
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("robot").resolve()
    (folder / "arm.xacro").write_text(MACRO)
    (folder / "two.urdf.xacro").write_text(MAIN)
    (folder / "package.xml").write_text("<package><name>two</name></package>")
    return folder


@pytest.fixture(scope="module")
def client(folder):
    with Client(folder) as client:
        yield client


@pytest.fixture
def macro(client, folder):
    """Open the file of macros; its robot is found in the workspace."""
    path = folder / "arm.xacro"
    client.open(path)
    client.wait_for(path, "axis-not-unit")
    yield path
    client.notify("textDocument/didClose", textDocument={"uri": path.as_uri()})
    client.wait_until(lambda: not client.diagnostics[path.as_uri()])


def place(line, character):
    return {"line": line, "character": character}


def test_a_macro_is_checked_through_its_robot(client, macro, folder):
    (found,) = client.list_found(macro, "axis-not-unit")
    assert found["range"] == {"start": place(8, 12), "end": place(8, 23)}
    assert "in 2 expansions" in found["message"]
    related = found["relatedInformation"]
    calls = [one["location"] for one in related if "macro 'arm'" in one["message"]]
    main = (folder / "two.urdf.xacro").as_uri()
    assert [(one["uri"], one["range"]["start"]["line"]) for one in calls] == [(main, 3), (main, 4)]
    assert any("mujoco" in one["message"] for one in related)


def test_findings_stay_and_move_while_a_tag_is_half_typed(client, macro):
    inserted = MACRO.replace('  <xacro:macro name="arm"', '  <lin\n  <xacro:macro name="arm"')
    client.change(
        macro,
        {"range": {"start": place(1, 0), "end": place(1, 0)}, "text": "  <lin\n"},
    )
    client.wait_for(macro, "not-well-formed")
    (found,) = client.list_found(macro, "axis-not-unit")
    assert found["range"]["start"] == place(9, 12)
    client.change(macro, text=inserted.replace("  <lin\n", ""))
    client.wait_until(lambda: not client.list_found(macro, "not-well-formed"))
    (found,) = client.list_found(macro, "axis-not-unit")
    assert found["range"]["start"] == place(8, 12)


def list_actions(client, path, diagnostic, only=None):
    context = {"diagnostics": [diagnostic], **({"only": only} if only else {})}
    return client.ask(
        "textDocument/codeAction",
        textDocument={"uri": path.as_uri()},
        range=diagnostic["range"],
        context=context,
    )


def test_actions_offer_the_fix_and_a_comment(client, macro):
    (found,) = client.list_found(macro, "axis-not-unit")
    fix, comment = list_actions(client, macro, found)
    assert fix["title"].endswith("(unsafe)")
    assert not fix.get("isPreferred")
    (edit,) = fix["edit"]["changes"][macro.as_uri()]
    assert edit["newText"] == "0 0.707106781 0.707106781"
    assert edit["range"] == {"start": place(8, 17), "end": place(8, 22)}
    (edit,) = comment["edit"]["changes"][macro.as_uri()]
    assert edit["newText"] == "<!-- urdftool-ignore[axis-not-unit] -->\n      "
    assert edit["range"] == {"start": place(8, 6), "end": place(8, 6)}
    assert list_actions(client, macro, found, only=["refactor"]) == []


def test_a_suppression_comment_removes_the_finding(client, macro):
    (found,) = client.list_found(macro, "axis-not-unit")
    comment = list_actions(client, macro, found)[-1]
    (edit,) = comment["edit"]["changes"][macro.as_uri()]
    client.change(macro, {"range": edit["range"], "text": edit["newText"]})
    client.wait_until(lambda: not client.list_found(macro, "axis-not-unit"))


def test_fix_all_applies_safe_fixes_only(client, folder):
    path = folder / "limits.urdf"
    text = """<robot name="limits">
  <link name="a"/><link name="b"/><link name="c"/>
  <joint name="one" type="fixed"><parent link="a"/><child link="b"/></joint>
  <joint name="two" type="continuous">
    <parent link="b"/><child link="c"/><axis xyz="0 1 1"/><limit effort="1" velocity="1"/>
  </joint>
  <gazebo reference="a"><mu1> 0.2 </mu1><material>Gazebo/Grey</material></gazebo>
  <joint name=" three" type="fixed"><parent link="a"/><child link="c"/></joint>
</robot>
"""
    path.write_text(text)
    client.open(path)
    client.wait_for(path, "axis-not-unit")
    (unsafe,) = client.list_found(path, "axis-not-unit")
    for action in list_actions(client, path, unsafe, only=["source.fixAll"]):
        assert action["kind"] == "source.fixAll.urdftool"
        edits = action["edit"]["changes"][path.as_uri()]
        assert not any("0.7071" in edit["newText"] for edit in edits)
    client.notify("textDocument/didClose", textDocument={"uri": path.as_uri()})
    path.unlink()


@pytest.mark.parametrize(
    ("line", "character", "expected"),
    [
        (2, 18, ["`left_arm`", "`right_arm`", "prefix=left_", "mass: 1 kg"]),
        (7, 24, ["`0 0.5 0`", "`0 -0.5 0`", "position [m]"]),
        (6, 24, ["link **left_arm**", "by joint `left_swing`"]),
        (4, 40, ["`revolute`"]),
        (8, 8, ["<axis>", "`xyz`"]),
    ],
)
def test_hover(client, macro, line, character, expected):
    found = client.ask_at("textDocument/hover", macro, line, character)
    for text in expected:
        assert text in found["contents"]["value"]


def test_hover_on_an_argument_of_a_call(client, folder):
    path = folder / "three.urdf.xacro"
    text = MAIN.replace('"two"', '"three"').replace('y="0.5"', 'y="${2 * gap}"')
    text = text.replace("  <link", '  <xacro:property name="gap" value="${1 / 4}"/><link')
    path.write_text(text)
    client.open(path)
    for _ in range(600):  # until it is checked
        found = client.ask_at("textDocument/hover", path, 3, 35)
        if found:
            break
        time.sleep(0.1)
    assert "`y`:\n\n- `0.5`" in found["contents"]["value"]
    assert "no robot" not in str(client.ask_at("textDocument/hover", path, 2, 40))
    client.notify("textDocument/didClose", textDocument={"uri": path.as_uri()})
    path.unlink()


def test_outline_is_the_kinematic_tree(client, macro, folder):
    path = folder / "two.urdf.xacro"
    client.open(path)
    (base,) = client.ask("textDocument/documentSymbol", textDocument={"uri": path.as_uri()})
    assert base["name"] == "base"
    assert [(c["name"], c["range"]["start"]["line"]) for c in base["children"]] == [
        ("left_arm", 3),
        ("right_arm", 4),
    ]
    (arm,) = client.ask("textDocument/documentSymbol", textDocument={"uri": macro.as_uri()})
    assert arm["name"] == "arm"
    assert [child["name"] for child in arm["children"]] == ["${prefix}arm", "${prefix}swing"]
    client.notify("textDocument/didClose", textDocument={"uri": path.as_uri()})


def test_formatting_is_that_of_fmt(client, macro):
    text = MACRO.replace("  <xacro:macro", "      <xacro:macro")
    client.change(macro, text=text)
    (edit,) = client.ask(
        "textDocument/formatting",
        textDocument={"uri": macro.as_uri()},
        options={"tabSize": 2, "insertSpaces": True},
    )
    assert edit["range"]["start"]["line"] == 1
    client.change(macro, text=MACRO)
    assert not client.ask(
        "textDocument/formatting",
        textDocument={"uri": macro.as_uri()},
        options={"tabSize": 2, "insertSpaces": True},
    )


def test_a_document_that_is_open_through_a_link_too(client, macro, folder):
    alias = folder / "alias.xacro"
    alias.symlink_to(macro.name)
    client.open(alias)
    client.wait_for(alias, "axis-not-unit")
    client.notify("textDocument/didClose", textDocument={"uri": alias.as_uri()})
    client.wait_until(lambda: not client.diagnostics[alias.as_uri()])
    client.change(macro, text=MACRO.replace("0 1 1", "0 1 0"))
    client.settle(macro)
    assert not client.list_found(macro, "axis-not-unit")
    client.change(macro, text=MACRO)
    client.wait_for(macro, "axis-not-unit")
    alias.unlink()


@pytest.mark.parametrize("position", [place(10**6, 3), place(0, 10**6), place(3, 10**6)])
def test_positions_beyond_the_end(client, macro, position):
    document = {"uri": macro.as_uri()}
    for method in ("hover", "definition", "completion", "prepareRename"):
        client.ask(f"textDocument/{method}", textDocument=document, position=position)
    context = {"includeDeclaration": True}
    client.ask("textDocument/references", textDocument=document, position=position, context=context)
    client.request("textDocument/rename", textDocument=document, position=position, newName="x")
    client.ask(
        "textDocument/codeAction",
        textDocument=document,
        range={"start": position, "end": position},
        context={"diagnostics": []},
    )


def test_what_xacro_prints_is_not_part_of_the_protocol(client, folder):
    path = folder / "prints.urdf.xacro"
    text = MAIN.replace("<link", "${xacro.message('Content-Length: 3')}${print('x')}<link", 1)
    path.write_text(text)
    client.open(path)
    client.settle(path)
    client.notify("textDocument/didClose", textDocument={"uri": path.as_uri()})
    path.unlink()


@pytest.mark.slow  # waits until the server looks again
def test_the_server_ends_when_its_editor_was_killed(folder):
    editor = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    client = Client(folder, process=editor.pid)
    client.open(folder / "two.urdf.xacro")
    client.settle(folder / "two.urdf.xacro")
    editor.kill()
    editor.wait()
    assert client.process.wait(120) == 0


@pytest.mark.parametrize(
    ("encoding", "column"), [("utf-8", 23), ("utf-32", 20)]
)  # others use utf-16
def test_columns_are_in_the_units_of_the_editor(folder, encoding, column):
    path = folder / "units.urdf"
    text = """<robot name="units">
  <link name="a"/><link name="b"/>
  <joint name="j" type="continuous"><parent link="a"/><child link="b"/>
    <!-- 🤖 --><axis xyz="0 1 1"/>
  </joint>
</robot>
"""
    path.write_text(text, "utf-8")
    with Client(folder, encoding=encoding) as client:
        assert client.capabilities["positionEncoding"] == encoding
        client.open(path)
        client.wait_for(path, "axis-not-unit")
        (found,) = client.list_found(path, "axis-not-unit")
        assert found["range"]["start"] == place(3, column)
    path.unlink()


def test_files_are_watched_where_the_editor_does_so_on_request(folder):
    registered = []

    class Editor(Client):
        def wait(self, until):
            def look(message):
                if message.get("method") == "client/registerCapability":
                    registered.extend(message["params"]["registrations"])
                return until(message)

            super().wait(look)

    watched = {"didChangeWatchedFiles": {"dynamicRegistration": True}}
    with Editor(folder, capabilities={"workspace": watched}) as client:
        client.open(folder / "two.urdf.xacro")
        client.wait_for(folder / "arm.xacro", "axis-not-unit")
        client.wait_until(lambda: bool(registered))
    (one,) = registered
    assert one["method"] == "workspace/didChangeWatchedFiles"
    (watcher,) = one["registerOptions"]["watchers"]
    assert "xacro" in watcher["globPattern"]


def test_the_server_ends_with_its_editor(folder):
    client = Client(folder)
    client.process.stdin.close()
    assert client.process.wait(120) == 0
