"""Two defects in one robot: fixes write only numbers that a message has, and none on a defect.

Each pair is planted in a small robot. A number in the fixed file stands in the file before, or in a
message of the first report: the user has seen it.
"""

import itertools
import os
import re

import pytest

from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.run import check_file

BODY = """<inertial><origin xyz="0 0 0.1"/><mass value="{mass}"/><inertia ixx="0.0042" ixy="0" \
ixz="0" iyy="0.0042" iyz="0" izz="0.0017"/></inertial>
    <visual><origin xyz="0 0 0.1"/><geometry><box size="0.1 0.1 0.2"/></geometry></visual>
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.1 0.1 0.2"/></geometry></collision>"""
ROBOT = f"""<robot name="r">
  <link name="base">
    {BODY.format(mass=1.0)}
  </link>
  <link name="arm">
    {BODY.format(mass=1.01)}
  </link>
  <link name="hand">
    {BODY.format(mass=1.02)}
  </link>
  <joint name="leader" type="revolute">
    <parent link="base"/><child link="arm"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/>
    <limit lower="-1.1" upper="1.2" effort="9" velocity="3"/>
  </joint>
  <joint name="follower" type="revolute">
    <parent link="arm"/><child link="hand"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/>
    <limit lower="-1.3" upper="1.4" effort="8" velocity="2"/><mimic joint="leader"/>
  </joint>
</robot>
"""
PLANTED = {
    "limits swapped": ('lower="-1.1" upper="1.2"', 'lower="1.2" upper="-1.1"'),
    "limits of the follower swapped": ('lower="-1.3" upper="1.4"', 'lower="1.4" upper="-1.3"'),
    "limits in degrees": ('lower="-1.1" upper="1.2"', 'lower="-63" upper="69"'),
    "follower in degrees": ('lower="-1.3" upper="1.4"', 'lower="-74" upper="80"'),
    "follower too narrow": ('lower="-1.3" upper="1.4"', 'lower="-0.5" upper="0.6"'),
    "mimics in a circle": ('velocity="3"/>', 'velocity="3"/><mimic joint="follower"/>'),
    "axis of length two": ('<axis xyz="0 1 0"/>\n    <limit lower="-1.1"',
                           '<axis xyz="0 2 0"/>\n    <limit lower="-1.1"'),
    "rpy in degrees": ('<origin xyz="0 0 0.2"/>', '<origin xyz="0 0 0.2" rpy="0 90 0"/>'),
    "mass in grams": ('<mass value="1.01"/>', '<mass value="1010"/>'),
    "mass negative": ('<mass value="1.01"/>', '<mass value="-1.01"/>'),
    "mass zero": ('<mass value="1.01"/>', '<mass value="0"/>'),
    "inertia of one": ('value="1.01"/><inertia ixx="0.0042" ixy="0" ixz="0" iyy="0.0042" iyz="0" '
                       'izz="0.0017"',
                       'value="1.01"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"'),
    "inertia zero": ('value="1.01"/><inertia ixx="0.0042" ixy="0" ixz="0" iyy="0.0042" iyz="0" '
                     'izz="0.0017"',
                     'value="1.01"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"'),
    "moment negative": ('value="1.01"/><inertia ixx="0.0042"',
                        'value="1.01"/><inertia ixx="-0.0042"'),
    "center far away": ('<inertial><origin xyz="0 0 0.1"/><mass value="1.01"/>',
                        '<inertial><origin xyz="0 0 3.7"/><mass value="1.01"/>'),
    "effort missing": ('effort="9" ', ""),
}  # fmt: skip
NUMBER = re.compile(r"(?<![\w.])-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def _numbers(text):
    return {f"{abs(float(number)):.4g}" for number in NUMBER.findall(text)}


@pytest.mark.parametrize("first", PLANTED)
def test_no_fix_of_a_pair_writes_a_number_that_no_message_has(first, tmp_path):
    others = [other for one, other in itertools.combinations(PLANTED, 2) if one == first]
    for second in others:
        text = ROBOT
        for name in (first, second):
            text = text.replace(*PLANTED[name], 1)
        path = tmp_path / "r.urdf"
        path.write_text(text, "utf-8")
        options = Options(fixes=True)
        report = check_file(path, options)
        fixed = fix_description(report, options, unsafe=True)
        after = fixed.after.get(os.fspath(path), text.encode()).decode()
        shown = [f"{f.message} {f.hint} {' '.join(x.message for x in f.fixes)}"
                 for f in report.findings]  # fmt: skip
        known = _numbers(text) | _numbers(" ".join(shown)) | {"0", "1"}
        assert _numbers(after) <= known, (first, second, dict(fixed.applied))


BOX = '<collision><geometry><box size="0.1 0.1 0.3"/></geometry></collision>'
SOLID = (
    '<inertial><mass value="{0}"/><inertia ixx="{1}" ixy="0" ixz="0" iyy="{1}" iyz="0" izz="{2}"/>'
    f"</inertial>{BOX}"
)
BOUND = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def _arm(name, side, body, parent="base"):
    return (
        f'<link name="{name}">{body}</link><joint name="{name}_joint" type="revolute"><parent '
        f'link="{parent}"/><child link="{name}"/><origin xyz="0 {side} 0"/>{BOUND}</joint>'
    )


def _fix(tmp_path, *parts):
    path = tmp_path / "r.urdf"
    base = f'<link name="base">{SOLID.format(1, 0.01, 0.002)}</link>'
    path.write_text(f'<robot name="r">{base}{"".join(parts)}</robot>', "utf-8")
    options = Options(fixes=True)
    return fix_description(check_file(path, options), options, unsafe=True)


@pytest.mark.parametrize(("other", "count"), [("right", 0), ("other", 1)])
def test_no_parent_is_suggested_while_two_links_have_one_name(tmp_path, other, count):
    body = SOLID.format(1, 0.01, 0.002)
    parts = [_arm("right", -0.5, body), _arm(other, 0.5, body).replace(f"{other}_joint", "x")]
    done = _fix(tmp_path, *parts, _arm("hand", 0.5, body, "rihgt"))
    assert done.applied["unknown-parent-link"] == count


@pytest.mark.parametrize(("mass", "count"), [(9, 0), (3, 1)])
def test_an_inertia_that_its_mirror_image_contradicts_is_not_written(tmp_path, mass, count):
    body = SOLID.format(mass, mass * 0.0083, mass * 0.00167)
    done = _fix(tmp_path, _arm("left_arm", 0.5, body), _arm("right_arm", -0.5, BOX))
    assert done.applied["missing-inertial"] == count


@pytest.mark.parametrize(("used", "name"), [("other_joint", "other_joint"), ("x", "x_joint_2")])
def test_the_second_joint_of_a_name_gets_the_name_that_a_transmission_uses(tmp_path, used, name):
    body = SOLID.format(1, 0.01, 0.002)
    parts = [_arm("x", -0.5, body), _arm("y", 0.5, body).replace("y_joint", "x_joint")]
    uses = "".join(
        f'<transmission name="t{n}"><type>transmission_interface/SimpleTransmission</type>'
        f'<joint name="{one}"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>'
        f'<actuator name="m{n}"/></transmission>'
        for n, one in enumerate(("x_joint", used.replace("x", "x_joint")))
    )
    done = _fix(tmp_path, *parts, uses)
    assert f'<joint name="{name}" type'.encode() in next(iter(done.after.values()))
