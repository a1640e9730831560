"""Sensors and drives of files of different formats."""

import pytest

import urdftool as api
from urdftool.compare.compare import compare_robots
from urdftool.model.drives import list_drives
from urdftool.model.remarks import list_remarks

URDF = """<robot name="r"><link name="a"><inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<link name="b"><inertial>
<mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="5" velocity="2"/></joint>
<transmission name="t"><type>transmission_interface/SimpleTransmission</type><joint name="j">
<hardwareInterface>EffortJointInterface</hardwareInterface></joint>
<actuator name="m"><mechanicalReduction>20</mechanicalReduction></actuator></transmission>
<gazebo reference="b"><sensor name="imu" type="imu"><pose>0.1 0 0 0 0 0</pose>
<update_rate>100</update_rate><imu><noise><type>gaussian</type><rate><stddev>0.1</stddev></rate>
</noise></imu></sensor>
<sensor name="eye" type="depth"><camera><horizontal_fov>1</horizontal_fov><image><width>64</width>
<height>48</height></image></camera><plugin name="p" filename="libgazebo_ros_depth_camera.so">
<updateRate>7</updateRate></plugin></sensor></gazebo></robot>"""
CHANGES = {
    ("sdf", "sensor 'imu': rate"): ("<update_rate>100", "<update_rate>99"),
    ("sdf", "sensor 'imu': pose"): ("<pose>0.1 0 0", "<pose>0.2 0 0"),
    ("sdf", "sensor 'imu': imu angular_velocity y noise stddev"): ("<stddev>0.1", "<stddev>0.2"),
    ("sdf", "camera 'eye': field of view"): ("<horizontal_fov>1<", "<horizontal_fov>2<"),
    ("mjcf", "sensor 'imu_gyro': type"): ("<gyro ", "<velocimeter "),
    ("mjcf", "joint 'j': gear of actuator"): ('gear="20"', 'gear="21"'),
}


def _export(tmp_path, form):
    source = tmp_path / "r.urdf"
    source.write_text(URDF)
    robot = api.load(source)
    export = api.export_sdf if form == "sdf" else api.export_mjcf
    made = tmp_path / ("r.sdf" if form == "sdf" else "r.xml")
    export(robot, made)
    return robot, made


@pytest.mark.parametrize("form", ["sdf", pytest.param("mjcf", marks=pytest.mark.library("mujoco"))])
def test_an_untouched_export_has_no_difference(tmp_path, form):
    robot, made = _export(tmp_path, form)
    found = compare_robots(robot, api.load(made)).differences
    assert [d.title for d in found if not d.is_convention] == []


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(("form", "title"), CHANGES)
def test_a_change_is_named_at_its_part(tmp_path, form, title):
    old, new = CHANGES[form, title]
    robot, made = _export(tmp_path, form)
    text = made.read_text()
    assert old in text
    made.write_text(text.replace(old, new))
    found = {d.title for d in compare_robots(robot, api.load(made)).differences}
    if "velocimeter" in new:  # MuJoCo's own, which no sensor of URDF means
        title = "sensor 'imu_gyro': existence"
    assert title in found


def test_drives_of_a_urdf(tmp_path):
    robot, _ = _export(tmp_path, "sdf")
    (drive,) = list_drives(robot)
    assert (drive.joint, drive.mode, drive.gear, drive.source) == ("j", "motor", 20, "transmission")


def test_a_plugin_sets_type_and_rate_of_its_sensor(tmp_path):
    robot, _ = _export(tmp_path, "sdf")
    (camera,) = robot.cameras
    assert (camera.type, camera.settings["rate"].content) == ("rgbd_camera", 7)
    assert camera.settings["rate"].place.file.path.endswith("r.urdf")


def test_what_cannot_be_read_has_its_place(tmp_path):
    text = URDF.replace(">100<", ">fast<").replace('reference="b"', 'reference="b "')
    path = tmp_path / "r.urdf"
    path.write_text(
        text.replace(
            "</robot>",
            '<gazebo reference="b"><sensor name="s" type="imu">'
            "<update_rate>fast</update_rate></sensor></gazebo></robot>",
        )
    )
    read = api.load(path)
    (rejected,) = read.rejected_settings
    assert (rejected.kind, rejected.name, rejected.text) == ("sensor", "s", "fast")
    dangling = [one for one in list_remarks(read) if one.code == "dangling-reference"]
    assert {one.name for one in dangling} == {"b "}
    assert all(one.place.line > 1 for one in (rejected, *dangling))
