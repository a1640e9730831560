"""Shapes written in millimeters, and large ones that are meant."""

import pytest

from urdftool import check

ROBOT = """<robot name="cart">
  <link name="base">
    <inertial><mass value="{mass}"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
    <visual><geometry>{visual}</geometry></visual>
    <collision><geometry>{collision}</geometry></collision>
  </link>
</robot>
"""
OTHERS = ("implausible-density", "inertia-below-geometry", "collision-much-smaller-than-visual")


@pytest.mark.parametrize(
    ("visual", "right"),
    [
        ('<box size="300 200 80"/>', 'size="0.3 0.2 0.08"'),
        ('<cylinder radius="100.5" length="60"/>', 'radius="0.1005" length="0.06"'),
        ('<sphere radius="90"/>', 'radius="0.09"'),
    ],
)
def test_the_mass_tells_that_a_shape_is_in_millimeters(write, visual, right):
    path = write("r.urdf", ROBOT.format(mass=2, visual=visual, collision=visual))
    seen, touches = check(path, select=("shape-in-millimeters", *OTHERS))
    assert seen.message.endswith(f"; write {right}")
    assert touches.message.endswith(right)


def test_the_other_shape_tells_that_a_shape_of_a_link_without_mass_is_in_millimeters(write):
    shapes = {"visual": '<box size="300 200 80"/>', "collision": '<box size="0.2 0.3 0.08"/>'}
    path = write("r.urdf", ROBOT.format(mass=0, **shapes))
    (finding,) = check(path, select=("shape-in-millimeters", *OTHERS))
    assert finding.name == "base"
    assert "visual" in finding.message


@pytest.mark.parametrize(
    ("mass", "shape"),
    [
        (1, '<box size="100 100 0.1"/>'),
        (2000, '<box size="30 3 3"/>'),
        (0, '<box size="300 200 80"/>'),
        (1, '<box size="20 20 2"/>'),
    ],
)
def test_a_large_shape_may_be_meant(write, mass, shape):
    path = write("r.urdf", ROBOT.format(mass=mass, visual=shape, collision=shape))
    assert check(path, select=("shape-in-millimeters",)) == []


@pytest.mark.parametrize(("off", "found"), [(0.03, True), (0.01, False)])
def test_a_sphere_that_is_shown_beside_the_one_that_touches_is_found(write, off, found):
    sphere = '<geometry><sphere radius="0.025"/></geometry>'
    text = f"""<robot name="cart"><link name="caster">
      <visual><origin xyz="0 0 {off}"/>{sphere}</visual>
      <collision>{sphere}</collision></link></robot>"""
    assert bool(check(write("r.urdf", text), select=("collision-off-visual",))) is found
