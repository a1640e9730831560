"""Names in the SRDF and YAML files of a robot: definitions, references, completion, renaming."""

from pathlib import Path

import pytest

from tests.server.test_half_typed import Editor
from urdftool.server.knowledge import make_path

URDF = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="finger" params="side">
    <link name="${side}_finger"/>
    <joint name="${side}_joint" type="revolute"><parent link="base"/><child link="${side}_finger"/>
      <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  </xacro:macro>
  <link name="base"/>
  <xacro:finger side="left"/>
  <xacro:finger side="right"/>
</robot>
"""
SRDF = """<robot name="arm">
  <group name="hand"><joint name="left_joint"/><joint name="right_joint"/></group>
  <disable_collisions link1="left_finger" link2="right_finger" reason="Never"/>
</robot>
"""
YAML = """hand_controller:
  joints: [left_joint, 'right_joint']
  constraints: {left_joint/goal: 0.1}
"""


@pytest.fixture
def folder(tmp_path):
    folder = tmp_path.resolve()
    (folder / "arm.urdf.xacro").write_text(URDF)
    (folder / "arm.srdf").write_text(SRDF)
    (folder / "controllers.yaml").write_text(YAML)
    (folder / "package.xml").write_text("<package><name>arm</name></package>")
    return folder


def open_file(folder, name):
    """Return an editor with a file, and a function that finds the position of a mark ``|``."""
    text = (folder / name).read_text()

    def find(marked):
        offset = text.index(marked.replace("|", "")) + marked.index("|")
        line = text.count("\n", 0, offset)
        return {"line": line, "character": offset - text.rfind("\n", 0, offset) - 1}

    return Editor(folder / name, text), find


def show(folder, locations):
    """Return the text of each location, with the name of its file."""
    found = []
    for one in locations:
        path, span = one["path"], one["range"]
        line = Path(path).read_text().splitlines()[span["start"]["line"]]
        text = line[span["start"]["character"] : span["end"]["character"]]
        found.append((path.rpartition("/")[2], text))
    return sorted(found)


@pytest.mark.parametrize(
    ("name", "marked", "expected"),
    [
        ("arm.srdf", 'joint name="left|_joint"', "${side}_joint"),
        ("arm.srdf", 'link2="right|_finger"', "${side}_finger"),
        ("controllers.yaml", "[left_|joint", "${side}_joint"),
        ("controllers.yaml", "'right_|joint'", "${side}_joint"),
        ("controllers.yaml", "{left_j|oint/goal", "${side}_joint"),
        ("controllers.yaml", "left_joint/go|al", None),
    ],
)
def test_definition(folder, name, marked, expected):
    editor, find = open_file(folder, name)
    found = show(folder, editor.ask("definition", position=find(marked)))
    assert found == ([("arm.urdf.xacro", expected)] if expected else [])


@pytest.mark.parametrize(
    ("name", "marked"),
    [
        ("arm.urdf.xacro", 'joint name="${side}|_joint"'),
        ("arm.srdf", 'joint name="left|_joint"'),
        ("controllers.yaml", "[left_|joint"),
    ],
)
def test_references(folder, name, marked):
    editor, find = open_file(folder, name)
    found = show(folder, editor.ask("references", position=find(marked)))
    both = name == "arm.urdf.xacro"  # the macro is both joints
    expected = [
        ("arm.srdf", "left_joint"),
        ("arm.urdf.xacro", "${side}_joint"),
        ("controllers.yaml", "left_joint"),
        ("controllers.yaml", "left_joint"),
    ]
    expected += [("arm.srdf", "right_joint"), ("controllers.yaml", "right_joint")] * both
    assert found == sorted(expected)


def test_completion_in_an_srdf(folder):
    editor, find = open_file(folder, "arm.srdf")
    found = editor.ask("completion", position=find('link2="|'))
    assert {"base", "left_finger", "right_finger"} <= {one["label"] for one in found}
    found = editor.ask("completion", position=find('<joint name="|'))
    assert {"left_joint", "right_joint"} <= {one["label"] for one in found}
    assert "base" not in {one["label"] for one in found}


@pytest.mark.parametrize(
    ("name", "marked"),
    [("arm.srdf", 'name="arm"|'), ("controllers.yaml", "hand_con|troller")],
)
def test_a_word_that_is_no_part_has_no_definition(folder, name, marked):
    editor, find = open_file(folder, name)
    assert editor.ask("definition", position=find(marked)) == []


@pytest.mark.parametrize(
    ("name", "marked"), [("arm.srdf", 'link1="left|_finger"'), ("controllers.yaml", "[left|_joint")]
)
def test_rename(folder, name, marked):
    urdf = URDF.replace("${side}_", "left_").replace('<xacro:finger side="right"/>', "")
    (folder / "arm.urdf.xacro").write_text(urdf)
    editor, find = open_file(folder, name)
    found = editor.ask("rename", position=find(marked), name="new")
    assert make_path(folder / "arm.urdf.xacro") in found["edits"], found
    assert make_path(folder / name) in found["edits"]


def test_a_broken_yaml_file_has_no_names(folder):
    (folder / "controllers.yaml").write_text('a: "b')
    editor, _ = open_file(folder, "controllers.yaml")
    for method in ("definition", "references", "completion"):
        assert editor.ask(method, position={"line": 0, "character": 4}) == []


def test_an_expanded_srdf_is_not_renamed_and_the_place_is_named(folder):
    (folder / "arm.srdf").rename(folder / "arm.srdf.xacro")
    text = SRDF.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')
    (folder / "arm.srdf.xacro").write_text(text)
    editor, find = open_file(folder, "arm.urdf.xacro")
    found = editor.ask("rename", position=find('link name="${side}_fin|ger"'), name="_tip")
    assert "an SRDF of xacro has this name" in found["refused"]
    assert "arm.srdf.xacro:3:30" in found["refused"]
