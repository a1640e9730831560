"""Settings of links and joints that are physically impossible, by the table of the model."""

import math

import pytest

from urdftool.api.lint import check
from urdftool.model.settings import TABLES, UNBOUNDED
from urdftool.rules.gazebo.setting_values import get_range

ROBOT = """<robot name="r"><link name="base"><inertial><mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
<link name="arm">{contact}
  <inertial><mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
  <collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision>
</link>
<joint name="turn" type="continuous"><parent link="base"/><child link="arm"/></joint>
{block}</robot>
"""
ROWS = [
    (row, name) for rows, name in zip(TABLES, ("arm", "arm", "turn"), strict=True) for row in rows
]
BOUNDED = [(row, name) for row, name in ROWS if get_range(row) != (-math.inf, math.inf)]


def _find(tmp_path, *, contact="", block="", name="arm"):
    if contact:
        contact = f"<contact>{contact}</contact>"
    if block:
        block = f'<gazebo reference="{name}">{block}</gazebo>'
    path = tmp_path / "r.urdf"
    path.write_text(ROBOT.format(contact=contact, block=block))
    findings = check(path, select=["setting-out-of-range"])
    return [(f.severity.name.lower(), f.message) for f in findings]


def _write_path(row, name, value):
    *around, tag = row.path.split("/")
    if name == "arm" and around and around[0] == "surface":
        around = ["collision", *around]
    opened = "".join(f"<{each}>" for each in around)
    closed = "".join(f"</{each}>" for each in reversed(around))
    return f"{opened}<{tag}>{value}</{tag}>{closed}"


@pytest.mark.parametrize(("row", "name"), BOUNDED, ids=lambda value: getattr(value, "name", value))
def test_each_setting_with_a_range_is_reported_outside_of_it(tmp_path, row, name):
    least, most = get_range(row)
    is_bounded = row.bounds != UNBOUNDED
    values = [least - 1, most + 1] if math.isfinite(most) else [least - 1]
    ways = [_write_path(row, name, "{}"), *(f"<{tag}>{{}}</{tag}>" for tag in row.tags)]
    for way in ways:
        is_tag = any(way.startswith(f"<{tag}>") for tag in row.tags)
        expected = ["error" if is_bounded else "warning"] * (is_tag or not is_bounded)
        for value in values:
            found = _find(tmp_path, block=way.format(value), name=name)
            assert [one[0] for one in found] == expected, (way, found)
            if not expected:  # libsdformat rejects the element
                assert len(check(tmp_path / "r.urdf", select=["invalid-sdf-value"])) == 1
        assert _find(tmp_path, block=way.format(least), name=name) == []


@pytest.mark.parametrize(
    ("contact", "expected"),
    [
        (
            '<lateral_friction value="-3"/>',
            [
                (
                    "warning",
                    "link 'arm': lateral_friction is '-3', not a finite number of at least 0",
                )
            ],
        ),
        (
            '<restitution value="2"/>',
            [("warning", "link 'arm': restitution is '2', not a finite number from 0 to 1")],
        ),
        (
            '<stiffness value="high"/>',
            [("warning", "link 'arm': stiffness is 'high', not a finite number")],
        ),
        ("<damping/>", [("error", "link 'arm': damping has no attribute value; write it")]),
        ('<lateral_friction value="0"/><restitution value="1"/><stiffness value="0"/>', []),
        ('<rolling_friction value="-1"/>', []),  # no setting of the model
    ],
)
def test_what_pybullet_reads_in_contact_is_checked(tmp_path, contact, expected):
    assert _find(tmp_path, contact=contact) == expected


def test_a_bad_contact_is_reported_although_a_tag_replaces_it_in_the_model(tmp_path):
    found = _find(tmp_path, contact='<lateral_friction value="-3"/>', block="<mu1>0.5</mu1>")
    assert [message for _, message in found] == [
        "link 'arm': lateral_friction is '-3', not a finite number of at least 0"
    ]
