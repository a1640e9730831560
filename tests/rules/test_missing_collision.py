"""Links that are without collision: which are named, and which are there on purpose."""

from urdftool.lint.run import check

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


def _lines(tmp_path, text, **options):
    file = tmp_path / "head.urdf"
    file.write_text(text)
    found = check(file, select=["missing-collision", "lint"], **options)
    return [(finding.rule, finding.place.line) for finding in found]


def test_link_without_collision_is_found_at_its_line(tmp_path):
    assert _lines(tmp_path, HEAD.format(comment="", height=0.2)) == [("missing-collision", 7)]


def test_a_link_that_an_attached_one_covers_needs_none(tmp_path):
    assert _lines(tmp_path, HEAD.format(comment="", height=0.05)) == []
    assert _lines(tmp_path, HEAD.format(comment="", height=0.11)) == [("missing-collision", 7)]
    moved = HEAD.replace('type="fixed"', 'type="continuous"')
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


def test_small_links_are_no_more_than_info(tmp_path):
    file = tmp_path / "head.urdf"
    file.write_text(
        HEAD.format(comment="", height=0.2).replace(
            'radius="0.02" length="0.04"', 'radius="0.01" length="0.005"'
        )
    )
    found = check(file, select=["missing-collision"], targets=["gz"])
    assert [finding.severity.label for finding in found] == ["info"]


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
