"""What URDF does not have: said once, at the first place, in words that nobody misreads."""

from urdftool.api.lint import check


def messages(tmp_path, inside, rule):
    file = tmp_path / "robot.urdf"
    joints = "".join(
        f'<link name="l{n}"/>\n<joint name="j{n}" type="continuous"><parent link="base"/>'
        f'<child link="l{n}"/>\n{inside}</joint>\n'
        for n in range(3)
    )
    file.write_text(f'<robot name="r">\n<link name="base"/>\n{joints}</robot>\n')
    found = check(file, select=[rule])
    return [(finding.location.line, finding.message) for finding in found]


def test_attributes_nobody_reads_are_one_finding_of_all_their_elements(tmp_path):
    inside = '<dynamics D="1" damping="0.1" K="7000" mu="2"/>'
    assert messages(tmp_path, inside, "unknown-attribute") == [
        (
            5,
            "<dynamics> of joint 'j0' (and 2 more) has the unknown attributes 'D', 'K', "
            "'mu'; URDF readers ignore them",
        )
    ]


def test_a_misspelt_attribute_is_told_at_each_place_for_each_is_mended(tmp_path):
    found = messages(tmp_path, '<dynamics dampng="0.1"/>', "unknown-attribute")
    assert [line for line, _ in found] == [5, 8, 11]
    assert (
        found[0][1] == "<dynamics> of joint 'j0' has the unknown attribute 'dampng'; write damping"
    )


def test_a_remark_is_told_apart_from_what_is_lost(tmp_path):
    found = messages(tmp_path, '<dynamics damping="0.1" note="x" K="1"/>', "unknown-attribute")
    assert [message.partition(" has ")[2] for _, message in found] == [
        "the unknown attribute 'note'; URDF readers ignore it",
        "the unknown attribute 'K'; URDF readers ignore it",
    ]


def test_elements_nobody_reads_are_one_finding(tmp_path):
    assert messages(tmp_path, "<gearbox/>", "unknown-element") == [
        (5, "<gearbox> does not belong in joint 'j0' (and 2 more); URDF readers ignore it")
    ]


def test_a_color_of_a_collision_is_not_reported(tmp_path):
    file = tmp_path / "robot.urdf"
    shape = '<collision><geometry><sphere radius="1"/></geometry><material name="m"/></collision>'
    links = "".join(f'<link name="l{n}">{shape}</link>\n' for n in range(2))
    file.write_text(f'<robot name="r">\n{links}</robot>')
    assert check(file, select=["unknown-element"]) == []
