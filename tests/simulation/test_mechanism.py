"""Parts that overlap by design in a mechanism, and parts that do not."""

import pytest

from tests.simulation.robots import inertial, kinds, simulated


def _link(name, size, xyz="0 0 0", rpy="0 0 0"):
    shape = size if size.startswith("<") else f'<box size="{size}"/>'
    return (
        f'<link name="{name}">{inertial(0.2, 4e-4, 5e-4, 6e-4, xyz)}<collision>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><geometry>{shape}</geometry></collision></link>'
    )


def _joint(parent, child, xyz, more="", kind="revolute", axis="0 1 0"):
    return (
        f'<joint name="to_{child}" type="{kind}"><origin xyz="{xyz}"/><parent link="{parent}"/>'
        f'<child link="{child}"/><axis xyz="{axis}"/>'
        f'<limit lower="0" upper="0.6" effort="50" velocity="1"/>{more}</joint>'
    )


def _follows(leader, multiplier):
    return f'<mimic joint="to_{leader}" multiplier="{multiplier}"/>'


# a parallelogram: the inner knuckle is pinned to the finger, 40 mm above the outer one
GRIPPER = (
    '<robot name="gripper">'
    + _link("palm", "0.1 0.1 0.06", "-0.08 0 0.02")
    + _link("outer", "0.1 0.01 0.01", "0.05 0 0")
    + _link("inner", "0.1 0.01 0.01", "0.05 0 0")
    + _link("finger", "0.02 0.02 0.1", "0 0 0.04")
    + _joint("palm", "outer", "0 0 0")
    + _joint("palm", "inner", "0 0 0.04", "{inner}")
    + _joint("outer", "finger", "0.1 0 0", _follows("outer", -1))
    + "</robot>"
)
FINGERS = (
    '<robot name="fingers">'
    + _link("palm", "0.1 0.1 0.06")
    + _link("left", "0.1 0.04 0.02", "0.1 -0.05 0")
    + _link("right", "0.1 0.04 0.02", "0.1 0.05 0")
    + _joint("palm", "left", "0.05 0.06 0", kind="prismatic", axis="0 1 0")
    + _joint("palm", "right", "0.05 -0.06 0", _follows("left", 1), kind="prismatic", axis="0 -1 0")
    + "</robot>"
)
MAST = (
    '<robot name="mast">'
    + _link("foot", "0.1 0.1 0.5", "0 0 0.25")
    + _link("middle", "0.08 0.08 0.5", "0 0 0.25")
    + _link("top", "0.06 0.06 0.5", "0 0 0.25")
    + _joint("foot", "middle", "0 0 0.05", kind="prismatic", axis="0 0 1")
    + _joint("middle", "top", "0 0 0.39", kind="prismatic", axis="0 0 1")
    + "</robot>"
)
ROD = '<cylinder radius="{}" length="{}"/>'
PISTON = (
    '<robot name="piston">'
    + _link("base", "0.4 0.3 0.1")
    + _link("arm", "0.1 0.1 0.4", "0 0 0.3")
    + _link("cylinder", ROD.format(0.03, 0.3), "0 0 0.25")
    + _link("rod", ROD.format(0.02, 0.3), "0 0 -0.15")
    + _joint("base", "arm", "0 0 0.05")
    + _joint("base", "cylinder", "0.15 0 0.05")
    + _joint("arm", "rod", "{x} 0 0.5")
    + "</robot>"
)


def _inside(write, text, one, other):
    """The fault of a pair that overlaps."""
    verdict = simulated(write("robot.urdf", text), fixed_base=True)
    (fault,) = [
        fault
        for fault in verdict.faults
        if fault.code == "interpenetration" and one in fault.message and other in fault.message
    ]
    return fault


@pytest.mark.parametrize(
    ("text", "one", "other", "why"),
    [
        (GRIPPER.format(inner=_follows("outer", 1)), "'finger'", "'inner'", "pin"),
        (MAST, "'top'", "'foot'", "telescope"),
        (PISTON.format(x=0.15), "'rod'", "'cylinder'", "piston"),
    ],
    ids=["four-bar", "telescope", "piston"],
)
def test_a_mechanism_overlaps_by_design(write, text, one, other, why):
    fault = _inside(write, text, one, other)
    assert not fault.fails
    assert why in fault.cause


@pytest.mark.parametrize(
    ("text", "one", "other"),
    [
        (GRIPPER.format(inner=""), "'finger'", "'inner'"),
        (GRIPPER.format(inner=_follows("outer", -0.5)), "'finger'", "'inner'"),
        (FINGERS, "'left'", "'right'"),
        (PISTON.format(x=0.175), "'rod'", "'cylinder'"),
    ],
    ids=["not pinned", "moves apart", "fingers", "off the axis"],
)
def test_other_parts_do_not(write, text, one, other):
    assert _inside(write, text, one, other).fails


def test_a_gripper_of_a_mechanism_stands(write):
    text = GRIPPER.format(inner=_follows("outer", 1))
    assert "interpenetration" not in kinds(simulated(write("robot.urdf", text), fixed_base=True))
