"""The sensors of a free base, and names that are fit for files."""

import pytest

from .robots import INERTIAL, export, find, joint, link, robot, tree

IMU = '<gazebo reference="{}"><sensor type="imu" name="own"></sensor></gazebo>'
ALL = [
    ("framelinvel", "base_linear_velocity"),
    ("gyro", "base_gyro"),
    ("accelerometer", "base_accelerometer"),
    ("framequat", "base_orientation"),
]


def text(*extra):
    return robot(
        link("base"), link("mount"), link("a"), joint("m", "base", "mount", "fixed", ""),
        joint("j", "base", "a"), *extra,
    )  # fmt: skip


def sensors(written):
    section = tree(written).find("sensor")
    return [] if section is None else [(e.tag, e.get("name")) for e in section]


def test_a_free_base_is_measured(write):
    path = write("r.urdf", text())
    written = export(path, base="free", base_sensors=True)
    assert sensors(written) == ALL
    site = find(tree(written), "site", "base_imu")
    assert site.getparent().get("name") == "base"
    assert sensors(export(path, base="free")) == []


def test_what_the_base_has_is_not_added(write):
    written = export(write("r.urdf", text(IMU.format("mount"))), base="free", base_sensors=True)
    assert sensors(written)[3:] == [("framelinvel", "base_linear_velocity")]
    elsewhere = export(write("r.urdf", text(IMU.format("a"))), base="free", base_sensors=True)
    assert sensors(elsewhere)[3:] == ALL


def test_a_fixed_base_is_not_measured(write):
    written = export(write("r.urdf", text()), base="fixed", base_sensors=True)
    assert sensors(written) == []
    assert "--base-sensors adds nothing: the base is fixed" in written.advice


def test_a_base_that_floats_below_the_world(write):
    floating = robot(link("world", ""), link("base"), joint("f", "world", "base", "floating", ""))
    assert sensors(export(write("r.urdf", floating), base_sensors=True)) == ALL


@pytest.mark.library("mujoco")
def test_mujoco_measures_it(write, tmp_path):
    import mujoco

    written = export(write("r.urdf", text()), base="free", base_sensors=True)
    model = mujoco.MjModel.from_xml_string(written.text)
    data = mujoco.MjData(model)
    data.qvel[:6] = [1, 2, 3, 0.1, 0.2, 0.3]
    mujoco.mj_forward(model, data)
    assert data.sensor("base_linear_velocity").data == pytest.approx([1, 2, 3])
    assert data.sensor("base_gyro").data == pytest.approx([0.1, 0.2, 0.3])
    assert data.sensor("base_orientation").data == pytest.approx([1, 0, 0, 0])


@pytest.mark.parametrize(
    ("name", "model"),
    [
        ("A LONG-NAME_URDF_V12", "A_LONG-NAME"),
        ("arm.v2.1", "arm"),
        ("my robot", "my_robot"),
        ("rover_v2_base", "rover_v2_base"),
        ("v2", "v2"),
        ("r2d2", "r2d2"),
    ],
)
def test_names_without_blanks_and_versions(write, name, model):
    written = export(write("r.urdf", robot(link("a", INERTIAL), name=name)))
    assert written.main == f"{model}.xml"
    made = tree(written)
    assert made.get("model") == model
    kept = [t.get("data") for t in made.iter("text") if t.get("name") == "robot_name"]
    assert kept == ([] if model == name else [name])
