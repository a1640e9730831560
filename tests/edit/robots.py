"""An arm and a gripper, with the files around them."""

import re

ARM = """<?xml version="1.0"?>
<!-- an arm -->
<robot name="arm">
  <material name="gray"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="base">
    <inertial>
      <origin xyz="0.01 0.02 0.03" rpy="0.1 0.2 0.3"/>
      <mass value="4.0"/>
      <inertia ixx="0.02" ixy="0.002" ixz="0.003" iyy="0.03" iyz="0.004" izz="0.04"/>
    </inertial>
    <visual><geometry><box size="0.2 0.1 0.1"/></geometry><material name="gray"/></visual>
    <collision><origin xyz="0.1 0.02 0"/><geometry><box size="0.1 0.2 0.3"/></geometry></collision>
  </link>
  <!-- the shoulder -->
  <joint name="shoulder" type="revolute">
    <parent link="base"/>
    <child link="upper"/>
    <origin xyz="0.10 0 0.02" rpy="0.3 -0.2 0.5"/> <!-- measured -->
    <axis xyz="0 1 0"/>
    <limit lower="-1.0" upper="2" effort="30" velocity="3"/>
    <calibration rising="0.1"/>
    <safety_controller soft_lower_limit="-0.9" soft_upper_limit="1.9" k_velocity="1"/>
  </joint>
  <link name="upper">
    <inertial>
      <origin xyz="0 0.02 0.2"/>
      <mass value="2"/>
      <inertia ixx="0.02" ixy="0.001" ixz="0.002" iyy="0.03" iyz="-0.001" izz="0.01"/>
    </inertial>
    <collision><origin xyz="0 0.01 0.2" rpy="0 0.4 0"/>
      <geometry><cylinder radius="0.05" length="0.4"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic">
    <parent link="upper"/><child link="tool"/>
    <origin xyz="0 0 0.4" rpy="0 1.5707963267948966 0"/>
    <axis xyz="0.6 0 0.8"/>
    <limit lower="0" upper="0.2" effort="9" velocity="1"/>
  </joint>
  <link name="tool">
    <inertial><mass value="1"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.0025"/></inertial>
  </link>
  <joint name="follower" type="continuous">
    <parent link="tool"/><child link="wheel"/>
    <origin xyz="0.05 0 0"/>
    <mimic joint="slide" multiplier="2" offset="0.1"/>
  </joint>
  <link name="wheel">
    <inertial><mass value="0.3"/>
      <inertia ixx="0.001" ixy="0.0001" ixz="0" iyy="0.002" iyz="0" izz="0.0025"/></inertial>
  </link>
  <joint name="camera_mount" type="fixed">
    <parent link="tool"/><child link="camera"/><origin xyz="0 0.1 0" rpy="0 0 0.7"/>
  </joint>
  <link name="camera">
    <inertial><origin xyz="0.01 0 0"/><mass value="0.2"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial>
    <visual><geometry><sphere radius="0.02"/></geometry></visual>
  </link>
  <joint name="tip_mount" type="fixed">
    <parent link="tool"/><child link="tip"/><origin xyz="0 0 0.05"/>
  </joint>
  <link name="tip"/>
  <gazebo reference="upper"><mu1>0.9</mu1></gazebo>
  <gazebo><plugin name="log" filename="liblog.so"><text>base, tool</text>
    <parameters>/share/controllers.yaml</parameters></plugin></gazebo>
  <transmission name="shoulder_trans">
    <type>transmission_interface/SimpleTransmission</type>
    <joint name="shoulder"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>
    <actuator name="shoulder_motor"><mechanicalReduction>1</mechanicalReduction></actuator>
  </transmission>
  <ros2_control name="arm_system" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="shoulder">
      <command_interface name="position">
        <param name="min">-1</param>
        <param name="max">2</param>
      </command_interface>
      <state_interface name="position"><param name="initial_value">0.5</param></state_interface>
      <state_interface name="velocity"/>
    </joint>
  </ros2_control>
</robot>
"""

ARM_SRDF = """<robot name="arm">
  <virtual_joint name="fix" type="fixed" parent_frame="map" child_link="base"/>
  <group name="all"><chain base_link="base" tip_link="tip"/></group>
  <group name="one"><joint name="shoulder"/></group>
  <group_state name="home" group="all"><joint name="shoulder" value="0.5"/></group_state>
  <disable_collisions link1="base" link2="upper" reason="Adjacent"/>
</robot>
"""

CONTROLLERS = """# of the arm
controller_manager:
  ros__parameters:
    arm_controller:
      type: joint_trajectory_controller/JointTrajectoryController
arm_controller:
  ros__parameters:
    joints: [shoulder, 'slide']  # both
    gains:
      shoulder: {p: 1.0}
"""

LIMITS = """joint_limits:
  shoulder:
    has_position_limits: true
    min_position: -1.0
    max_position: 2.0
initial_positions:
  shoulder: 0.5
"""

GRIPPER = """<robot name="gripper">
  <material name="gray"><color rgba="0.2 0.2 0.2 1"/></material>
  <link name="world"/>
  <joint name="stand" type="fixed"><parent link="world"/><child link="base"/></joint>
  <!-- the palm -->
  <link name="base">
    <inertial><mass value="0.5"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial>
    <visual><geometry><box size="0.1 0.1 0.05"/></geometry><material name="gray"/></visual>
  </link>
  <joint name="left" type="prismatic">
    <parent link="base"/><child link="left_finger"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.04" effort="5" velocity="1"/>
  </joint>
  <link name="left_finger">
    <inertial><mass value="0.1"/>
      <inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial>
  </link>
  <joint name="right" type="prismatic">
    <parent link="base"/><child link="right_finger"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.04" effort="5" velocity="1"/>
    <mimic joint="left"/>
  </joint>
  <link name="right_finger">
    <inertial><mass value="0.1"/>
      <inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial>
  </link>
</robot>
"""

GRIPPER_SRDF = """<robot name="gripper">
  <group name="hand"><joint name="left"/></group>
  <group_state name="open" group="hand"><joint name="left" value="0.04"/></group_state>
  <disable_collisions link1="left_finger" link2="right_finger" reason="Adjacent"/>
</robot>
"""


def list_numbers(text, pattern):
    """Return the numbers that a pattern with groups finds."""
    match = re.search(pattern, text, re.DOTALL)
    assert match is not None, pattern
    return [float(group) for group in match.groups()]
