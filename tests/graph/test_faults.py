import pytest

from tests.graph.robots import robot, tree
from urdftool.graph.detailed import create_detailed_figure
from urdftool.graph.faults import find_faults
from urdftool.graph.fold import fold_fixed
from urdftool.graph.marks import mark_faults
from urdftool.graph.ros import make_ros_figure
from urdftool.lint.validate import validate

CASES = {
    "two roots": (
        tree("abc", [("ab", "a", "b")]),
        {"a": ["root 1 of 2"], "c": ["root 2 of 2"]},
    ),
    "two parents": (
        tree("abc", [("ab", "a", "b"), ("ac", "a", "c"), ("bc", "b", "c")]),
        {"c": ["2 parents"]},
    ),
    "a loop beside the root": (
        tree("abcd", [("bc", "b", "c"), ("cb", "c", "b"), ("cd", "c", "d")]),
        {"b": ["in a loop"], "c": ["in a loop"], "d": ["detached"]},
    ),
    "a loop without a root": (
        tree("ab", [("ab", "a", "b"), ("ba", "b", "a")]),
        {"a": ["in a loop"], "b": ["in a loop"]},
    ),
    "an unknown parent": (
        tree("a", [("xa", "x", "a")]),
        {"a": ["detached"], "xa": ["unknown parent"], "x": ["missing link"]},
    ),
    "an unknown child": (
        tree("a", [("ax", "a", "x")]),
        {"ax": ["unknown child"], "x": ["missing link"]},
    ),
    "a joint to itself": (
        tree("a", [("aa", "a", "a")]),
        {"a": ["detached"], "aa": ["joins a link to itself"]},
    ),
    "twins": (
        tree("aab", [("j", "a", "b")]),
        {"a": ["2 with this name"]},
    ),
}


@pytest.mark.parametrize("style", [make_ros_figure, create_detailed_figure])
@pytest.mark.parametrize("case", CASES)
def test_what_is_wrong_stands_on_its_node(case, style):
    model, expected = CASES[case]
    figure = style(model)
    mark_faults(figure, find_faults(model))
    marked = {node.name: node.faults for node in figure.nodes.values() if node.faults}
    assert marked == expected


@pytest.mark.parametrize("case", CASES)
def test_everything_is_drawn(case):
    model, _ = CASES[case]
    figure = create_detailed_figure(model)
    assert {link.name for link in model.links} <= {n.name for n in figure.list_nodes("link")}
    assert sum(1 for _ in figure.list_nodes("joint")) == len(model.joints)
    assert all(edge.tail in figure.nodes and edge.head in figure.nodes for edge in figure.edges)


def test_a_sound_robot_has_no_fault():
    assert list(find_faults(tree("abc", [("ab", "a", "b"), ("bc", "b", "c")]))) == []


def test_a_fault_has_its_place():
    model = tree("abc", [("ab", "a", "b"), ("ac", "a", "c"), ("bc", "b", "c")])
    (fault,) = find_faults(model)
    assert str(fault.location) == "r.urdf:4:1"
    assert fault.code == "multiple-parents"


@pytest.mark.parametrize("case", CASES)
def test_lint_reports_what_keeps_a_robot_from_being_a_tree(case):
    model, _ = CASES[case]
    rules = {fault.code for fault in find_faults(model)} - {"detached"}
    assert rules
    assert rules <= {finding.code for finding in validate(model, "graph")}


def test_a_joint_without_links_is_drawn_apart():
    figure = create_detailed_figure(
        robot('<robot name="r"><link name="a"/><joint name="j"/></robot>')
    )
    assert [node.kind for node in figure.nodes.values()] == ["link", "joint", "missing", "missing"]


def test_what_a_joint_lacks_stands_on_the_joint():
    model = robot('<robot name="r"><link name="a"/><joint name="j"/></robot>')
    figure = create_detailed_figure(model)
    mark_faults(figure, find_faults(model))
    assert figure.nodes["joint:j"].faults == ["no parent", "no child"]


def test_fixed_joints_fold_and_faulty_ones_do_not():
    model = tree("abcd", [("ab", "a", "b"), ("bc", "b", "c"), ("bd", "b", "d"), ("cd", "c", "d")])
    figure = create_detailed_figure(model)
    mark_faults(figure, find_faults(model))
    folded = fold_fixed(figure)
    assert {node.name: node.members for node in folded.list_nodes("link")} == {
        "a": ["b", "c"],
        "d": [],
    }
    assert [node.name for node in folded.list_nodes("joint")] == ["cd", "bd"]
    assert {(edge.tail, edge.head) for edge in folded.edges} == {
        ("link:a", "joint:bd"),
        ("joint:bd", "link:d"),
        ("link:a", "joint:cd"),
        ("joint:cd", "link:d"),
    }
