"""Findings that depend on an SRDF in the folder next to it, and gravity of a link."""

import pytest

from urdftool.api.lint import check

LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
BODY = """<inertial><mass value="10"/>
<inertia ixx="0.25" ixy="0" ixz="0" iyy="0.25" iyz="0" izz="0.1"/></inertial>
<collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision>"""


def _write(folder, joints, root=""):
    links = [f'<link name="root">{root}</link>']
    previous = "root"
    for number, (kind, axis) in enumerate(joints):
        name = "body" if number == len(joints) - 1 else f"part{number}"
        inside = BODY if name == "body" else ""
        links.append(f'<link name="{name}">{inside}</link>')
        links.append(
            f'<joint name="j{number}" type="{kind}"><parent link="{previous}"/>'
            f'<child link="{name}"/><axis xyz="{axis}"/>{LIMIT}</joint>'
        )
        previous = name
    file = folder / "robot.urdf"
    file.write_text('<robot name="r">' + "\n".join(links) + "</robot>")
    return file


@pytest.mark.parametrize(("name", "count"), [("hand", 0), ("other", 1)])
def test_pair_that_the_srdf_in_the_folder_beside_disables(tmp_path, name, count):
    for folder in ("urdf", "srdf"):
        (tmp_path / folder).mkdir()
    (tmp_path / "package.xml").write_text("<package><name>hand</name></package>")
    finger = '<link name="{0}">' + BODY + "</link>"
    joint = (
        '<joint name="j{0}" type="prismatic"><parent link="palm"/><child link="{0}"/>'
        '<axis xyz="0 1 0"/>' + LIMIT + "</joint>"
    )
    parts = "\n".join(part.format(one) for one in ("left", "right") for part in (finger, joint))
    robot = tmp_path / "urdf" / "robot.urdf"
    robot.write_text(f'<robot name="hand"><link name="palm"/>\n{parts}\n</robot>')
    (tmp_path / "srdf" / "any.srdf").write_text(
        f'<robot name="{name}"><disable_collisions link1="left" link2="right" reason="Default"/>'
        "</robot>"
    )
    codes = [finding.code for finding in check(robot)]
    assert codes.count("self-collision-at-zero") == count


@pytest.mark.parametrize(("value", "count"), [("1", 0), ("0", 1), ("true", 1)])
def test_gravity_in_a_link_that_acts_anyway(tmp_path, value, count):
    file = _write(tmp_path, [("revolute", "0 0 1")])
    text = file.read_text().replace("<inertial>", f"<gravity>{value}</gravity><inertial>", 1)
    file.write_text(text)
    assert [finding.code for finding in check(file)].count("unknown-element") == count
