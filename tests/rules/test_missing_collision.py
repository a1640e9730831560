"""Links that are without collision: which are named, and which are there on purpose."""

import pytest

from urdftool.api.lint import check

HEAD = """<?xml version="1.0"?>
<robot name="head">
  <link name="base">
    <visual><geometry><sphere radius="0.1"/></geometry></visual>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <link name="motor">{comment}
    <visual><geometry><cylinder radius="0.02" length="0.04"/></geometry></visual>
  </link>
  <joint name="mount" type="fixed">
    <parent link="base"/>
    <child link="motor"/>
    <origin xyz="0 0 {height}"/>
  </joint>
</robot>
"""


def _lines(tmp_path, text, rules=("missing-collision", "lint"), **options):
    file = tmp_path / "head.urdf"
    file.write_text(text)
    found = check(file, select=rules, **options)
    return [(finding.code, finding.location.line) for finding in found]


def test_link_without_collision_is_found_at_its_line(tmp_path):
    assert _lines(tmp_path, HEAD.format(comment="", height=0.2)) == [("missing-collision", 7)]


def test_a_link_that_an_attached_one_covers_needs_none(tmp_path):
    assert _lines(tmp_path, HEAD.format(comment="", height=0.05)) == []
    assert _lines(tmp_path, HEAD.format(comment="", height=0.11)) == [("missing-collision", 7)]
    moved = HEAD.replace('type="fixed"', 'type="prismatic"')
    assert _lines(tmp_path, moved.format(comment="", height=0)) == [("missing-collision", 7)]


def test_comment_in_its_line_excuses_a_link(tmp_path):
    comment = " <!-- urdftool-ignore[missing-collision] a sticker -->"
    assert _lines(tmp_path, HEAD.format(comment=comment, height=0.2)) == []


def test_severity_depends_on_the_target(tmp_path):
    file = tmp_path / "head.urdf"
    file.write_text(HEAD.format(comment="", height=0.2))
    severities = {
        target: check(file, select=["missing-collision"], targets=[target])[0].severity.label
        for target in ("ros2", "gz", "gazebo-classic", "mujoco", "pybullet", "moveit")
    }
    assert severities.pop("ros2") == "info"
    assert set(severities.values()) == {"warning"}


def test_small_links_need_none(tmp_path):
    file = tmp_path / "head.urdf"
    file.write_text(
        HEAD.format(comment="", height=0.2).replace(
            'radius="0.02" length="0.04"', 'radius="0.01" length="0.005"'
        )
    )
    assert check(file, select=["missing-collision"], targets=["gz"]) == []


def test_what_is_tiny_or_marks_a_frame_needs_none(tmp_path):
    tiny = HEAD.format(comment="", height=0.2).replace(
        'radius="0.02" length="0.04"', 'radius="0.004" length="0.002"'
    )
    assert _lines(tmp_path, tiny) == []
    marker = HEAD.format(comment="", height=0.2).replace("motor", "camera_optical_frame")
    assert _lines(tmp_path, marker) == []


def test_each_link_is_named_where_none_collides(tmp_path):
    link = '<link name="l{}"><visual><geometry><sphere radius="1"/></geometry></visual></link>'
    links = "\n".join(link.format(number) for number in range(5))
    found = _lines(tmp_path, f'<robot name="ghost">\n{links}\n</robot>')
    assert found == [("missing-collision", line) for line in range(2, 7)]


def test_a_misspelt_collision_is_not_also_missing(tmp_path):
    text = HEAD.format(comment="<colision/>", height=0.2)
    assert _lines(tmp_path, text) == []


CARRIER = """<robot name="cart">
  <link name="base">
    <visual><geometry><box size="0.4 0.4 0.4"/></geometry></visual>
    <collision><geometry><box size="0.4 0.4 0.4"/></geometry></collision>
  </link>
  <link name="steering">
    <visual><geometry><box size="0.1 0.02 0.02"/></geometry></visual>
  </link>
  <link name="wheel">
    <visual><geometry><sphere radius="0.1"/></geometry></visual>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="turn" type="{kind}">
    <parent link="base"/>
    <child link="steering"/>
    <origin xyz="{x} 0 0"/>
  </joint>
  <joint name="roll" type="continuous">
    <parent link="steering"/>
    <child link="wheel"/>
    <origin xyz="0 0 -0.3"/>
  </joint>
</robot>
"""


def test_what_turns_inside_the_body_it_is_mounted_on_needs_none(tmp_path):
    for kind, x, count in (
        ("continuous", 0.1, 0),
        ("revolute", 0.1, 0),
        ("continuous", 0.19, 1),
        ("prismatic", 0.1, 1),
    ):
        rules = ("missing-collision", "odd-link-without-collision")
        found = _lines(tmp_path, CARRIER.format(kind=kind, x=x), rules)
        assert len(found) == count, (kind, x)


def test_a_link_in_the_midst_of_its_body_needs_none(tmp_path):
    above = (
        HEAD.replace("</robot>", "")
        + """
  <link name="hat">
    <visual><geometry><sphere radius="0.1"/></geometry></visual>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="stand" type="fixed">
    <parent link="base"/>
    <child link="hat"/>
    <origin xyz="0 0 0.4"/>
  </joint>
</robot>
"""
    )
    file = tmp_path / "head.urdf"
    for text, severities in ((HEAD + "", ["warning"]), (above, [])):
        file.write_text(text.format(comment="", height=0.2))
        found = check(file, select=["missing-collision"], targets=["gz"])
        assert [finding.severity.label for finding in found] == severities


def test_a_marker_of_a_centimeter_needs_none(tmp_path):
    marker = HEAD.format(comment="", height=0.2).replace(
        '<cylinder radius="0.02" length="0.04"/>', '<box size="0.01 0.01 0.01"/>'
    )
    assert _lines(tmp_path, marker) == []


@pytest.mark.parametrize(("opacity", "count"), [("0", 0), ("0.1", 1)])
def test_what_cannot_be_seen_needs_none(tmp_path, opacity, count):
    color = f'<material name="glass"><color rgba="1 1 1 {opacity}"/></material>'
    motor = '<cylinder radius="0.02" length="0.04"/></geometry>'
    text = HEAD.format(comment="", height=0.2)
    assert len(_lines(tmp_path, text.replace(motor, motor + color))) == count
    named = text.replace(motor, motor + '<material name="glass"/>')
    assert len(_lines(tmp_path, named.replace("</robot>", color + "</robot>"))) == count
    assert _lines(tmp_path, text.replace('"motor"', '"virtual_motor"')) == []


@pytest.mark.parametrize(
    ("kind", "place", "ghosts"),
    [
        ("prismatic", "0 0 0", []),
        ("prismatic", "0 0 0.5", ["cart"]),
        ("continuous", "0 0 0", ["cart"]),
    ],
)
def test_a_cart_that_its_rail_goes_through_cannot_collide_with_it(write, kind, place, ghosts):
    box = '<visual><geometry><box size="{}"/></geometry></visual>'
    long = box.format("30 0.05 0.05")
    body = '<inertial><mass value="1"/></inertial>'
    joint = '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{0}"/>{3}</joint>'
    parts = (
        '<link name="world"/>',
        f'<link name="rail">{body}{long}{long.replace("visual", "collision")}</link>',
        f'<link name="cart">{body}{box.format("0.5 0.5 0.2")}</link>',
        joint.format("rail", "fixed", "world", ""),
        joint.format("cart", kind, "rail", f'<origin xyz="{place}"/><axis xyz="1 0 0"/>'),
    )
    path = write("r.urdf", f'<robot name="r">{"".join(parts)}</robot>')
    rules = ["missing-collision", "odd-link-without-collision"]
    assert sorted(f.name for f in check(path, select=rules)) == sorted(ghosts)


@pytest.mark.parametrize(("extra", "fixes"), [("", 1), ('<sphere radius="0"/>', 0)])
def test_a_visual_without_a_size_is_not_copied(write, extra, fixes):
    """Readers reject a collision of no size, so the fix would add a defect."""
    text = HEAD.format(comment="", height=0.2)
    if extra:
        visual = f"<visual><geometry>{extra}</geometry></visual>"
        text = text.replace('name="motor">', f'name="motor">{visual}')
    (found,) = check(
        write("r.urdf", text), select=["missing-collision"], targets=["gz"], fixes=True
    )
    assert len(found.fixes) == fixes
