import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from html import unescape
from pathlib import Path

import jsonschema
import pytest

from tests.conftest import FIXTURES, ROOT
from tests.graph.robots import HOSTILE, hostile_text, tree_text

MIRA = FIXTURES / "robots" / "mira_description" / "urdf" / "mira.urdf"
ARM = FIXTURES / "robots" / "demo_arm" / "urdf" / "arm.urdf.xacro"
SCHEMA = json.loads((ROOT / "docs" / "schemas" / "graph.json").read_text())
SOUND = tree_text("abc", [("ab", "a", "b"), ("bc", "b", "c")], "sound")
LOOP = tree_text("abc", [("bc", "b", "c"), ("cb", "c", "b")], "loop")


def test_without_an_output_it_does_what_urdf_to_graphiz_does(urdftool, write, tmp_path):
    result = urdftool("graph", write("x.urdf", SOUND))
    assert result.code == 0
    assert result.out == "Created file sound.gv\nCreated file sound.pdf\n"
    assert result.err == ""
    assert sorted(p.name for p in tmp_path.iterdir()) == ["sound.gv", "sound.pdf", "x.urdf"]
    assert (tmp_path / "sound.gv").read_text().startswith("digraph G {\nnode [shape=box];\n")
    assert (tmp_path / "sound.pdf").read_bytes().startswith(b"%PDF")


def test_the_pair_takes_another_name(urdftool, write, tmp_path):
    assert urdftool("graph", write("x.urdf", SOUND), "-o", "out").code == 0
    assert {"out.gv", "out.pdf"} < {p.name for p in tmp_path.iterdir()}


@pytest.mark.parametrize(
    ("suffix", "start"),
    [
        (".gv", b"digraph G {"),
        (".dot", b"digraph G {"),
        (".pdf", b"%PDF"),
        (".svg", b"<?xml"),
        (".PNG", b"\x89PNG"),
        (".mmd", b"flowchart TB"),
        (".json", b"{"),
    ],
)
def test_the_suffix_says_what_is_written(urdftool, write, tmp_path, suffix, start):
    result = urdftool("graph", write("x.urdf", SOUND), "-o", f"out{suffix}")
    assert (result.code, result.out, result.err) == (0, "", f"Created file out{suffix}\n")
    assert (tmp_path / f"out{suffix}").read_bytes().startswith(start)


def test_a_tree_at_the_terminal(urdftool, write):
    result = urdftool("graph", write("x.urdf", SOUND), "-o", "-")
    assert result.out == "sound\na  frame\n└── ab  fixed → b  frame\n    └── bc  fixed → c  frame\n"


def test_a_tree_has_colours_where_they_are_wanted(urdftool, write):
    result = urdftool("--color", "always", "graph", write("x.urdf", SOUND), "-o", "-")
    assert result.out.splitlines() == [
        "\x1b[1msound\x1b[0m",
        "\x1b[1ma\x1b[0m\x1b[2m  frame\x1b[0m",
        "\x1b[2m└── \x1b[0m\x1b[36mab\x1b[0m\x1b[2m  fixed\x1b[0m\x1b[2m → \x1b[0m\x1b[1mb\x1b[0m"
        "\x1b[2m  frame\x1b[0m",
        "\x1b[2m    └── \x1b[0m\x1b[36mbc\x1b[0m\x1b[2m  fixed\x1b[0m\x1b[2m → \x1b[0m\x1b[1mc"
        "\x1b[0m\x1b[2m  frame\x1b[0m",
    ]


def test_nothing_in_a_name_is_markup_at_the_terminal(urdftool, write):
    result = urdftool(
        "graph", write("x.urdf", tree_text(["[bold]a[/] :smile:\x85"], [])), "-o", "-"
    )
    assert "[bold]a[/] :smile:\\x85" in result.out


def test_branches_next_to_each_other_have_guides(urdftool, write):
    joints = [("ab", "a", "b"), ("bc", "b", "c"), ("ad", "a", "d")]
    result = urdftool("graph", write("x.urdf", tree_text("abcd", joints)), "-o", "-")
    assert result.out.splitlines()[1:] == [
        "a  frame",
        "├── ab  fixed → b  frame",
        "│   └── bc  fixed → c  frame",
        "└── ad  fixed → d  frame",
    ]


def test_a_deep_tree_goes_on_below(urdftool, write):
    names = [f"l{i}" for i in range(300)]
    joints = [(f"j{i}", names[i], names[i + 1]) for i in range(299)]
    result = urdftool("graph", write("x.urdf", tree_text(names, joints)), "-o", "-")
    lines = result.out.splitlines()
    assert result.code == 0
    assert max(map(len, lines)) < 250
    assert sum("j298 " in line for line in lines) == 1


@pytest.mark.parametrize("output", ["out.svg", "out.mmd", "out.json", "-", None])
@pytest.mark.parametrize("style", ["ros", "detailed"])
def test_what_is_no_tree_is_drawn_and_marked_and_exit_1(urdftool, write, output, style):
    words = ["-o", output] if output else []
    result = urdftool("graph", write("x.urdf", LOOP), "--style", style, *words)
    assert result.code == 1
    assert (
        "x.urdf:3:1: links form a cycle without a connection to the root: 'b' → 'c'" in result.err
    )
    text = result.out if output == "-" else Path(output or "loop.gv").read_text("utf-8")
    assert "in a loop" in text


@pytest.mark.parametrize(
    "output", ["a.svg", "a.png", "a.pdf", "a.gv", "a.mmd", "a.json", "-", None]
)
@pytest.mark.parametrize("style", ["ros", "detailed"])
def test_hostile_names_run_nothing(urdftool, write, tmp_path, output, style):
    path = write("x.urdf", hostile_text(HOSTILE))
    result = urdftool("graph", path, "--style", style, *(["-o", output] if output else []))
    assert result.code == 0
    written = {p.name for p in tmp_path.iterdir()} - {"x.urdf"}
    name = 'we "$(touch pwned)" _.._x'
    assert written == ({output} - {"-"} if output else {f"{name}.gv", f"{name}.pdf"})


@pytest.mark.parametrize(
    ("name", "stem"), [("", "x"), ("..", "x"), ("a/b", "a_b"), ("\n", "_"), ("é" * 200, "é" * 100)]
)
def test_the_name_of_a_file_is_one(urdftool, write, tmp_path, name, stem):
    assert urdftool("graph", write("x.urdf", tree_text("a", [], name))).code == 0
    assert {p.name for p in tmp_path.iterdir()} == {"x.urdf", f"{stem}.gv", f"{stem}.pdf"}


def node_texts(svg):
    """All text of each node of an SVG, by the node's key."""
    name = "{http://www.w3.org/2000/svg}"
    nodes = [g for g in ElementTree.parse(svg).iter(f"{name}g") if g.get("class") == "node"]
    return {
        node.find(f"{name}title").text: ["".join(t.itertext()) for t in node.iter(f"{name}text")]
        for node in nodes
    }


def test_findings_are_marked_where_they_are_and_exit_1(urdftool, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = urdftool("graph", ARM, "--lint", "--style", "detailed", "-o", "arm.svg")
    assert result.code == 1
    marks = {
        key: {text for text in texts if text.startswith(("error", "warning", "info"))}
        for key, texts in node_texts("arm.svg").items()
    }
    assert {key: found for key, found in marks.items() if found} == {
        "link:shoulder": {"error: inertia-triangle-inequality"},
        "link:upper_arm": {"error: inertia-triangle-inequality"},
        "link:forearm": {"error: inertia-triangle-inequality"},
        "joint:elbow": {"error: unknown-attribute"},
        "link:tool": {"error: mesh-not-found"},
    }
    svg = unescape(Path("arm.svg").read_text("utf-8"))
    for finding in json.loads(urdftool("lint", ARM, "--format", "json").out)["findings"]:
        assert finding["rule"] in svg


def test_json_follows_its_schema(urdftool, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    urdftool("graph", MIRA, "--lint", "--fold-fixed", "-o", "mira.json")
    graph = json.loads(Path("mira.json").read_text("utf-8"))
    jsonschema.validate(graph, SCHEMA)
    keys = {node["key"] for node in graph["nodes"]}
    assert all({edge["from"], edge["to"]} <= keys for edge in graph["edges"])


def test_what_lax_readers_pass_over_is_said_and_passed_over(urdftool, write):
    path = write("x.urdf", SOUND.replace("<robot", '<?xml verison="1.0"?>\n<robot', 1))
    result = urdftool("graph", path, "-o", "x.gv")
    assert result.code == 0
    assert result.err.startswith("x.urdf:1:7: warning: the XML declaration is")


def test_a_graph_too_large_for_mermaid_is_said(urdftool, write):
    names = [f"l{i}" for i in range(300)]
    joints = [(f"j{i}", "l0", names[i]) for i in range(1, 300)]
    result = urdftool("graph", write("x.urdf", tree_text(names, joints)), "-o", "x.mmd")
    assert result.code == 0
    assert all(word in result.err for word in ("598 edges", "500", "--fold-fixed"))


@pytest.mark.parametrize(
    ("text", "words", "said"),
    [
        (SOUND, ["-o", "x.xyz"], "'x.xyz'"),
        (SOUND, ["-o", "x.urdf/x.svg"], "x.urdf/x.svg: "),
        ("<robot name='r'/>", [], "x.urdf:1:1: "),
        ("<scene/>", [], "x.urdf:1:1: the root element is <scene>"),
        ("<robot", [], "x.urdf:1:1: "),
    ],
)
def test_what_cannot_be_done_is_one_message(urdftool, write, tmp_path, text, words, said):
    result = urdftool("graph", write("x.urdf", text), *words)
    assert result.code == 2
    assert said in result.err
    assert {p.name for p in tmp_path.iterdir()} == {"x.urdf"}


@pytest.mark.library("pygraphviz")
def test_from_standard_input(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "urdftool", "graph", "-", "-o", "x.svg"],
        input=SOUND,
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0
    assert "href" not in (tmp_path / "x.svg").read_text().replace("xmlns:xlink", "")


@pytest.mark.parametrize(
    "words", [["--help"], [str(MIRA), "-o", "x.gv"], [str(MIRA), "-o", "x.json"]]
)
def test_text_imports_nothing_heavy(words, tmp_path):
    code = (
        "import sys; from urdftool import cli; cli.call(['graph', *sys.argv[1:]])\n"
        "print('LOADED', *{'numpy', 'rich', 'pygraphviz', 'trimesh', 'lxml'} & set(sys.modules))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.stdout.splitlines()[-1] == "LOADED"
