import re
import time
import xml.etree.ElementTree as ElementTree

import pytest

from tests.graph.robots import HOSTILE, hostile_text, robot, tree
from urdftool.errors import UrdftoolError
from urdftool.graph import graphviz as drawing
from urdftool.graph.detailed import create_detailed_figure
from urdftool.graph.dot import to_dot
from urdftool.graph.faults import find_faults
from urdftool.graph.formatting import escape_controls
from urdftool.graph.graphviz import FORMATS, DrawError, draw
from urdftool.graph.marks import mark_faults
from urdftool.graph.ros import make_ros_figure

STARTS = {"pdf": b"%PDF", "svg": b"<?xml", "png": b"\x89PNG"}
SMALL = tree("ab", [("the joint", "a", "b")])


def texts(svg):
    root = ElementTree.fromstring(svg)
    return ["".join(e.itertext()) for e in root.iter("{http://www.w3.org/2000/svg}text")]


def links(svg):
    root = ElementTree.fromstring(svg)
    found = list(root.iter("{http://www.w3.org/2000/svg}a"))
    return {
        link.get("{http://www.w3.org/1999/xlink}title"): link.get(
            "{http://www.w3.org/1999/xlink}href"
        )
        for link in found
    }


@pytest.mark.parametrize("format", FORMATS)
@pytest.mark.parametrize("style", [make_ros_figure, create_detailed_figure])
def test_pictures_are_drawn(format, style, capfd):
    assert draw(to_dot(style(SMALL)), format).startswith(STARTS[format])
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("style", [make_ros_figure, create_detailed_figure])
def test_every_name_is_in_the_picture(style):
    shown = texts(draw(to_dot(style(SMALL)), "svg"))
    assert {"a", "b", "the joint"} <= set(shown)


@pytest.mark.parametrize("style", [make_ros_figure, create_detailed_figure])
def test_hostile_names_are_drawn_as_they_are(style):
    svg = draw(to_dot(style(robot(hostile_text(HOSTILE))), "."), "svg")
    shown = [text.replace("\xa0", " ") for text in texts(svg)]
    for name in HOSTILE:
        assert escape_controls(name) in shown
    for name in HOSTILE[1:]:
        assert escape_controls(f"j {name}") in shown


def test_hostile_names_are_in_tooltips_as_they_are():
    svg = draw(to_dot(create_detailed_figure(robot(hostile_text(HOSTILE))), "."), "svg")
    titles = [title.split("\n")[0] for title in links(svg)]
    assert {f"link {escape_controls(name)}" for name in HOSTILE} <= set(titles)


def test_nodes_link_to_their_lines():
    svg = draw(to_dot(create_detailed_figure(SMALL), "pictures"), "svg")
    assert set(links(svg).values()) == {"../r.urdf#L2", "../r.urdf#L3", "../r.urdf#L4"}


def test_no_name_of_a_file_becomes_another_link():
    model = robot('<robot name="r"><link name="a"/></robot>', 'javascript:alert(1)"x.urdf')
    (target,) = links(draw(to_dot(create_detailed_figure(model), "."), "svg")).values()
    assert target == "javascript%3Aalert%281%29%22x.urdf#L1"


@pytest.mark.parametrize("style", [make_ros_figure, create_detailed_figure])
def test_empty_names_do_not_break_graphviz(style):
    model = robot('<robot><link/><joint/><link name="a"/><joint name="n"/><link/></robot>')
    figure = style(model)
    mark_faults(figure, find_faults(model))
    text = to_dot(figure, ".")
    assert not re.search(r'"\\n|\\n\\n', text)
    for _ in range(4):
        assert draw(text, "svg").startswith(b"<?xml")


def test_what_takes_too_long_is_stopped(monkeypatch):
    monkeypatch.setattr(drawing, "MAX_SECONDS", 0.05)
    names = [f"l{i}" for i in range(3000)]
    text = to_dot(make_ros_figure(tree(names, [(f"j{b}", "l0", b) for b in names[1:]])))
    begin = time.monotonic()
    with pytest.raises(DrawError, match=r"edges in 0.05 s; .*--fold-fixed"):
        draw(text, "svg")
    assert time.monotonic() - begin < 30  # without the limit: minutes


def test_a_graphviz_that_crashes_is_one_message(tmp_path, monkeypatch):
    stand_in = "import os, signal\nAGraph = lambda **_: os.kill(os.getpid(), signal.SIGSEGV)\n"
    (tmp_path / "pygraphviz.py").write_text(stand_in)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(DrawError, match=r"Graphviz crashed on this graph \(SIGSEGV\)"):
        draw("digraph {\n}", "svg")


def test_text_that_is_no_graph_is_an_error():
    with pytest.raises(UrdftoolError):
        draw("digraph {\n a -> \n", "svg")


@pytest.mark.slow
@pytest.mark.parametrize(
    "parent",
    [lambda i: i - 1, lambda i: 0, lambda i: (i - 1) // 2, lambda i: (i * 7919) % i],
    ids=["chain", "star", "binary", "scattered"],
)
@pytest.mark.parametrize("style", [make_ros_figure, create_detailed_figure])
def test_two_thousand_links_are_drawn_or_refused_in_a_minute(parent, style):
    names = [f"link_{i}" for i in range(2000)]
    model = tree(names, [(f"joint_{i}", names[parent(i)], names[i]) for i in range(1, 2000)])
    begin = time.monotonic()
    try:
        assert draw(to_dot(style(model)), "pdf").startswith(b"%PDF")
    except DrawError as error:
        assert "stopped" in str(error)  # noqa: PT017
    assert time.monotonic() - begin < 60
