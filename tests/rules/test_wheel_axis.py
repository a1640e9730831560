"""A wheel whose cylinder and joint disagree: the odd one is named, by what else is known."""

import pytest

from urdftool.api.lint import check

HEAD = '<?xml version="1.0"?>\n<robot name="r"><link name="base_link"/>\n'
INERTIA = {
    "x": 'ixx="0.0006" iyy="0.0003" izz="0.0003"',
    "y": 'ixx="0.0003" iyy="0.0006" izz="0.0003"',
    "z": 'ixx="0.0003" iyy="0.0003" izz="0.0006"',
    "": 'ixx="0.0003" iyy="0.0003" izz="0.0003"',
}
RPY = {"x": "0 1.5707963 0", "y": "1.5707963 0 0", "z": "0 0 0"}
XYZ = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}


def shape(tag, along):
    return (
        f'<{tag}><origin rpy="{RPY[along]}"/><geometry><cylinder radius="0.05" length="0.02"/>'
        f"</geometry></{tag}>"
    )


def wheel(
    axis,
    collision,
    *,
    name="left_wheel",
    at="0 0.1 0.05",
    rpy="0 0 0",
    inertia="",
    visual="",
    kind="continuous",
    limit="",
):
    """A wheel; ``axis`` and the others are x, y or z in the frame of its link."""
    seen = shape("visual", visual) if visual else ""
    touches = shape("collision", collision) if collision else ""
    axis = f'<axis xyz="{XYZ.get(axis, axis)}"/>' if axis else ""
    return f"""<link name="{name}"><inertial><mass value="0.5"/>
  <inertia {INERTIA[inertia]} ixy="0" ixz="0" iyz="0"/></inertial>
  {seen}{touches}</link>
<joint name="{name}_joint" type="{kind}"><parent link="base_link"/><child link="{name}"/>
  <origin xyz="{at}" rpy="{rpy}"/>{axis}{limit}</joint>
"""


def found(tmp_path, *wheels):
    path = tmp_path / "r.urdf"
    path.write_text(HEAD + "".join(wheels) + "</robot>\n")
    return check(path, select=["wheel-cylinder-axis"])


def odd(findings):
    """Which one the first of several findings names as odd: the axis, the cylinder, or nothing."""
    return (findings[0].data["odd"] or "either") if findings else ""


CASES = {
    # what is above the ground decides, whatever else was forgotten in the same way
    "axis up": ("axis", wheel("z", "y")),
    "cylinder up": ("cylinder", wheel("y", "z")),
    "all but the axis up": ("cylinder", wheel("y", "z", visual="z", inertia="z")),
    # both level: visual and inertia
    "inertia for the cylinder": ("axis", wheel("x", "y", inertia="y")),
    "visual and inertia for the axis": ("cylinder", wheel("x", "y", visual="x", inertia="x")),
    "visual against inertia": ("either", wheel("x", "y", visual="x", inertia="y")),
    "nothing": ("either", wheel("x", "y")),
    "turned by its joint": ("axis", wheel("y", "z", rpy="-1.5707963 0 0")),
    "no axis": ("axis", wheel("", "y", inertia="y")),
    # right
    "right": ("", wheel("y", "y")),
    "ball of the same": ("", wheel("y", "")),
    # a revolute joint without limits, and one that steers
    "revolute": ("axis", wheel("z", "y", kind="revolute")),
    "steers": (
        "",
        wheel("z", "y", kind="revolute", limit='<limit lower="-0.5" upper="0.5" effort="1"/>'),
    ),
    "swivel": ("", wheel("z", "y", name="caster_swivel")),
    # an axis that cannot be read is another matter
    "commas": ("", wheel("0,1,0", "z")),
}


@pytest.mark.parametrize("case", CASES)
def test_the_odd_one_is_named(tmp_path, case):
    expected, one = CASES[case]
    assert odd(found(tmp_path, one)) == expected


def test_the_place_of_the_twin_decides_first(tmp_path):
    twins = {"left": "0.1", "right": "-0.1"}
    for axis, cylinder, expected in (("x", "y", "axis"), ("y", "x", "cylinder")):
        wheels = [
            wheel(axis, cylinder, name=f"{side}_wheel", at=f"0 {y} 0.05", inertia="x", visual="x")
            for side, y in twins.items()
        ]
        findings = found(tmp_path, *wheels)
        assert len(findings) == 2
        assert odd(findings) == expected
        assert "position of its twin" in findings[0].message


def test_the_cylinder_may_be_that_of_a_tire_on_the_hub(tmp_path):
    hub = wheel("z", "", name="left_wheel", inertia="y")
    tire = f"""<link name="tire">{shape("collision", "y")}</link>
<joint name="mount" type="fixed"><parent link="left_wheel"/><child link="tire"/></joint>"""
    (finding,) = found(tmp_path, hub, tire)
    assert "cylinder of wheel 'tire', which agrees with its inertia" in finding.message
    assert finding.message.endswith('write <axis xyz="0 1 0"/>')


def test_a_mesh_says_where_it_is_round(tmp_path):
    path = tmp_path / "tire.obj"
    ring = [(0.05, 0.0), (0.0, 0.05), (-0.05, 0.0), (0.0, -0.05)]
    points = [f"v {x} {y} {z}" for y in (-0.01, 0.01) for x, z in ring]
    faces = ["f 1 2 3 4", "f 5 6 7 8", "f 1 2 6 5", "f 2 3 7 6"]
    path.write_text("\n".join([*points, *faces]))
    mesh = '<visual><geometry><mesh filename="tire.obj"/></geometry></visual></link>'
    one = wheel("x", "y").replace("</link>", mesh, 1)
    (finding,) = found(tmp_path, one)
    assert odd([finding]) == "axis"
    assert "agrees with its visual" in finding.message
