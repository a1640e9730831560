"""Links whose shapes, friction or inertia differ from others on purpose, and overlaps in one."""

import pytest

from urdftool.api.lint import check


def _found(path, rule, *targets):
    return check(path, select=[rule], targets=targets)


WHEEL = """<robot name="cart">
  <link name="base">
    <visual><geometry><box size="0.4 0.3 0.1"/></geometry></visual>
    <collision><geometry><box size="0.4 0.3 0.1"/></geometry></collision>
  </link>
  <link name="wheel">
    <visual><geometry><cylinder radius="0.1" length="0.04"/></geometry></visual>
    <collision><geometry><sphere radius="{radius}"/></geometry></collision>
  </link>
  <joint name="roll" type="continuous">
    <parent link="base"/>
    <child link="wheel"/>
    <origin xyz="0 0.2 0"/>
    <axis xyz="0 0 1"/>
  </joint>
</robot>
"""


@pytest.mark.parametrize(("radius", "count"), [(0.1, 0), (0.095, 0), (0.13, 1), (0.2, 1)])
def test_a_wheel_may_be_a_sphere_of_its_radius(tmp_path, radius, count):
    file = tmp_path / "cart.urdf"
    file.write_text(WHEEL.format(radius=radius))
    assert len(_found(file, "collision-much-larger-than-visual")) == count


GRIPPER = """<robot name="arm">
  <link name="base"/>
  <link name="wrist">{box}</link>
  <link name="hand">{box}</link>
  <link name="left_finger">{box}</link>
  <link name="right_finger">{box}</link>
  <joint name="wrist_roll" type="continuous"><parent link="base"/><child link="wrist"/></joint>
  <joint name="mount" type="fixed"><parent link="wrist"/><child link="hand"/></joint>
  <joint name="left_slide" type="{left}"><parent link="hand"/><child link="left_finger"/>
    <limit lower="0" upper="0.04" effort="1" velocity="1"/></joint>
  <joint name="right_slide" type="{right}"><parent link="hand"/><child link="right_finger"/>
    <limit lower="0" upper="0.04" effort="1" velocity="1"/></joint>
  <gazebo reference="left_finger"><maxContacts>4</maxContacts></gazebo>
  <gazebo reference="right_finger"><maxContacts>4</maxContacts></gazebo>
</robot>
"""


@pytest.mark.parametrize(
    ("left", "right", "names"),
    [
        ("prismatic", "prismatic", ["left_finger", "right_finger"]),
        ("prismatic", "fixed", ["left_finger", "right_finger"]),
        ("fixed", "fixed", []),
    ],
)
def test_fingers_of_a_fixed_gripper_need_no_friction(tmp_path, left, right, names):
    file = tmp_path / "arm.urdf"
    box = '<collision><geometry><box size="0.02 0.02 0.1"/></geometry></collision>'
    file.write_text(GRIPPER.format(left=left, right=right, box=box))
    assert [f.name for f in _found(file, "missing-friction", "gz")] == names


SENSOR = """<robot name="arm">
  <link name="base"/>
  <link name="arm">
    <inertial><mass value="2"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial>
  </link>
  <link name="camera">
    <inertial><mass value="0.01"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial>
    {shape}
  </link>
  <joint name="swing" type="continuous"><parent link="base"/><child link="arm"/></joint>
  <joint name="mount" type="{kind}"><parent link="arm"/><child link="camera"/></joint>
</robot>
"""


@pytest.mark.parametrize(
    ("kind", "size", "count"),
    [
        ("fixed", None, 0),
        ("continuous", None, 0),
        ("fixed", 0.01, 0),
        ("fixed", 0.05, 1),
        ("continuous", 0.01, 1),
    ],
)
def test_frames_may_have_a_placeholder(tmp_path, kind, size, count):
    file = tmp_path / "arm.urdf"
    box = f'<visual><geometry><box size="{size} {size} {size}"/></geometry></visual>'
    robot = SENSOR.format(kind=kind, shape=box if size else "")
    file.write_text(robot)
    assert len(_found(file, "placeholder-inertia")) == count
    file.write_text(robot.replace('"0.001"', '"1"'))
    (flywheel,) = _found(file, "placeholder-inertia")
    assert flywheel.severity.label == "warning"


def test_overlaps_of_a_robot_are_one_finding_with_the_deepest_first(tmp_path):
    ball = '<collision><geometry><sphere radius="0.1"/></geometry></collision>'
    links = "".join(f'<link name="{name}">{ball}</link>' for name in ("base", "a", "b", "c"))
    joints = "".join(
        f'<joint name="j{name}" type="continuous"><parent link="base"/><child link="{name}"/>'
        f'<origin xyz="{x} 0 0.15"/></joint>'
        for name, x in (("a", 0), ("b", 0.18), ("c", 0.3))
    )
    file = tmp_path / "balls.urdf"
    file.write_text(f'<robot name="balls">{links}{joints}</robot>')
    assert _found(file, "self-collision-at-zero") == []  # nobody who reads it is known
    (finding,) = _found(file, "self-collision-at-zero", "moveit")
    assert finding.message == (
        "2 pairs of links overlap with all joints at zero, by up to 80 mm: 'b' and 'c', 'a' and 'b'"
    )
