"""A finding has those effects of its rule that hold in its case."""

import pytest

from urdftool import check
from urdftool.rules import get_rule

KEPT = '<mujoco><compiler discardvisual="false"/></mujoco>'


def box(tag, text="0.1 0 0.1"):
    return f'<{tag}><geometry><box size="{text}"/></geometry></{tag}>'


def readers(path, rule):
    return [list(finding.effects) for finding in check(path, select=[rule])]


@pytest.mark.parametrize(
    ("inside", "has"),
    [
        (box("collision"), {"mujoco", "drake"}),
        (box("visual"), {"drake"}),
        (f"{box('visual')}</link>{KEPT}<link name='b'>", {"mujoco", "drake"}),
        ('<visual><geometry><sphere radius="0"/></geometry></visual>', set()),
    ],
)
def test_a_reader_is_named_where_it_does_what_is_said(write, inside, has):
    path = write("r.urdf", f'<robot name="r"><link name="a">{inside}</link></robot>')
    (found,) = readers(path, "non-positive-dimension")
    silent = "urdfdom, gz, gazebo-classic, pybullet, pinocchio"
    assert set(found) == {silent, *has}
    assert found == [key for key in get_rule("non-positive-dimension").effects if key in found]


def test_findings_with_other_effects_are_not_one(write):
    links = "".join(
        f'<link name="{name}">{box("collision" if name in "ab" else "visual")}</link>'
        for name in "abcd"
    )
    path = write("r.urdf", f'<robot name="r">{links}</robot>')
    found = check(path, select=["non-positive-dimension"], grouped=True)
    assert [(f.count, "mujoco" in f.effects) for f in found] == [(2, True), (2, False)]
