"""Which links one joint connects."""

import pytest

from urdftool.api.load import load
from urdftool.srdf.adjacent import find_adjacent_pairs
from urdftool.srdf.content import make_semantic
from urdftool.srdf.verdicts import decide, list_shaped_links
from urdftool.srdf.write import format_srdf

BOX = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'


def make_urdf(links, joints):
    """Return the text of a robot; a link with a ``*`` is bare; joints are (name, type, A, B)."""
    parts = [
        f'<link name="{name.strip("*")}">{"" if name.endswith("*") else BOX}</link>'
        for name in links.split()
    ]
    for type_, parent, child, xyz, axis in joints:
        parts.append(
            f'<joint name="{parent}_{child}" type="{type_}"><parent link="{parent}"/>'
            f'<child link="{child}"/><origin xyz="{xyz}"/><axis xyz="{axis}"/>'
            '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        )
    return f'<robot name="r">{"".join(parts)}</robot>'


def revolute(parent, child, xyz="0 0 0", axis="0 0 1"):
    return "revolute", parent, child, xyz, axis


def fixed(parent, child):
    return "fixed", parent, child, "0 0 0", "1 0 0"


@pytest.mark.parametrize(
    ("links", "joints", "expected"),
    [
        ("a b c", [revolute("a", "b"), revolute("b", "c")], ["ab", "bc"]),
        ("a x* b", [revolute("a", "x"), fixed("x", "b")], ["ab"]),
        ("x* a b", [revolute("x", "a"), revolute("x", "b")], []),  # two arms on a bare torso
        ("a x* b", [revolute("a", "x"), revolute("x", "b", axis="0 1 0")], ["ab"]),  # universal
        ("a x* b", [revolute("a", "x"), revolute("x", "b", "0.1 0 0", "0 1 0")], []),
        ("a x* b", [revolute("a", "x"), ("prismatic", "x", "b", "0 0 0", "0 0 1")], []),
    ],
    ids=["chain", "frame", "torso", "universal", "apart", "prismatic"],
)
def test_pairs_that_one_joint_connects(write, links, joints, expected):
    robot = load(write("r.urdf", make_urdf(links, joints)))
    found = find_adjacent_pairs(robot, list_shaped_links(robot))
    assert sorted("".join(sorted(pair)) for pair in found) == expected


def test_srdf_is_read_as_it_was_written(write):
    from urdftool.model.semantic import read_semantic
    from urdftool.source.description import read_description

    robot = load(write("r.urdf", make_urdf("a b&amp; c", [revolute("a", "b&amp;")])))
    content = make_semantic(robot, decide(robot))
    content.disabled[0].comment = "two -- hyphens"
    text = format_srdf(content, ("urdftool",))
    root = read_description(write("r.srdf", text)).document.root
    again = read_semantic(root)
    assert [(p.link1, p.link2, p.reason) for p in again.disabled] == [("a", "b&", "Adjacent")]
    assert again.name == "r"
