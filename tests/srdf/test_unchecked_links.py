"""Links of which MoveIt checks no collisions by default."""

import pytest

from urdftool.model.semantic import read_semantic
from urdftool.source.description import read_description

URDF = """<robot name="r">
<link name="base"><collision><geometry><box size=".1 .1 .1"/></geometry></collision></link>
<link name="l"><collision><origin xyz=".3 0 0"/><geometry><box size=".6 .05 .05"/></geometry>
</collision></link>
<link name="r"><collision><origin xyz=".3 0 0"/><geometry><box size=".6 .05 .05"/></geometry>
</collision></link>
<joint name="jl" type="revolute"><parent link="base"/><child link="l"/><origin xyz="0 .3 .2"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="jr" type="revolute"><parent link="base"/><child link="r"/><origin xyz="0 -.3 .2"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""
UNCHECKED = '<disable_default_collisions link="l"/>'
ENABLED = '<enable_collisions link1="l" link2="r"/>'
DISABLED = '<disable_collisions link1="r" link2="l" reason="User"/>'


def _read(write, content):
    path = write("r.srdf", f'<robot name="r">{content}</robot>')
    return read_semantic(read_description(str(path)).document.root)


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("", []),
        (UNCHECKED, ["base l", "l r"]),
        (UNCHECKED + ENABLED, ["base l"]),
        (UNCHECKED + ENABLED + DISABLED, ["base l", "l r"]),
        (ENABLED, []),
        (UNCHECKED + UNCHECKED, ["base l", "l r"]),
    ],
)
def test_pairs_of_unchecked_links(write, content, expected):
    pairs = _read(write, content).list_disabled(["base", "l", "r"])
    assert sorted(" ".join(sorted(pair.links)) for pair in pairs) == expected


@pytest.mark.library("fcl")
@pytest.mark.parametrize(
    ("content", "code", "words"),
    [
        (UNCHECKED, 1, "'l' and 'r' are disabled, but touch"),
        (UNCHECKED + ENABLED, 0, "1 disabled pair: 1 proved"),
        (UNCHECKED + DISABLED, 0, "2 disabled pairs"),
    ],
)
def test_check_judges_them(urdftool, write, content, code, words):
    write("r.urdf", URDF)
    write("r.srdf", f'<robot name="r">{content}</robot>')
    result = urdftool("srdf", "r.urdf", "--check", "r.srdf", "-j", "1")
    assert result.code == code
    assert words in result.out + result.err


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(("content", "pairs"), [(UNCHECKED, 1), (UNCHECKED + ENABLED, 0)])
def test_an_export_leaves_them_out(urdftool, write, tmp_path, content, pairs):
    write("r.urdf", URDF)
    srdf = write("r.srdf", f'<robot name="r">{content}</robot>')
    result = urdftool("export", "mjcf", "r.urdf", "--srdf", srdf, "-o", tmp_path / "out")
    assert result.code == 0, result.err
    text = (tmp_path / "out" / "r.xml").read_text()
    excluded = [line for line in text.splitlines() if "<exclude" in line]
    assert sum('"l"' in line and '"r"' in line for line in excluded) == pairs
