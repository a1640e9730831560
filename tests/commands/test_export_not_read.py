"""``--verify`` says what was not read of the source, and thus was not compared."""

import json

WORLD = """<sdf version="1.6"><world name="w">{}<model name="arm"><link name="a"/><link name="b"/>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>
</joint></model></world></sdf>"""
TREE = "<include><uri>model://oak_tree</uri></include>"
LINE = "not read, so not compared: "


def test_what_was_not_read_is_named_below_the_table(urdftool, write):
    write("w.sdf", WORLD.format(TREE))
    done = urdftool("export", "urdf", "w.sdf", "-o", "out", "--verify", "--force")
    (line,) = [one for one in done.out.splitlines() if one.startswith(LINE)]
    assert "models that the world includes are not found, and not read: 1" in line
    assert "model://oak_tree" in line


def test_json_has_it_too(urdftool, write):
    write("w.sdf", WORLD.format(TREE))
    words = ("export", "urdf", "w.sdf", "-o", "out", "--force", "--format", "json")
    (message,) = json.loads(urdftool(*words, "--verify").out)["not_read"]
    assert "oak_tree" in message
    assert json.loads(urdftool(*words, "--overwrite").out)["not_read"] == []


def test_nothing_is_said_of_a_file_that_was_read(urdftool, write):
    write("w.sdf", WORLD.format(""))
    done = urdftool("export", "urdf", "w.sdf", "-o", "out", "--verify", "--force")
    assert "check" in done.out
    assert LINE not in done.out
