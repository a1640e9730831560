"""An export of an SDF copies sensors, plugins and lights, and reports what it does not copy."""

import pytest

import urdftool as api
from measure.same_format.sdf import ADDITIONS, BASE, measure_sdf

SOME = ("<light", '<sensor name="s" type="imu', "<gripper", "<battery", "<self_collide", "<plugin")


def test_additions_are_kept(tmp_path):
    some = tuple((path, xml) for path, xml in ADDITIONS if xml.startswith(SOME))
    results = {r.what: r.verdict for r in measure_sdf(tmp_path, some) if "libv.so" not in r.what}
    assert len(results) >= 6
    assert set(results.values()) == {"kept"}


def test_what_is_not_read_is_reported(tmp_path):
    some = tuple((path, xml) for path, xml in ADDITIONS if "gearbox" in xml or "libv.so" in xml)
    codes = [code for result in measure_sdf(tmp_path, some) for code in result.codes]
    assert codes == ["unread-element", "unread-look"]


def test_an_element_keeps_its_pose_when_its_link_is_merged(tmp_path):
    text = BASE.replace('type="revolute"', 'type="fixed"').replace(
        '<link name="b"><pose>0 0 1 0 0 0</pose>',
        '<link name="b"><pose>0 0 1 0 0 0</pose><sensor name="s" type="imu">'
        "<pose>1 0 0 0 0 0</pose></sensor>",
    )
    (tmp_path / "a.sdf").write_text(text)
    out = tmp_path / "b.sdf"
    api.export_sdf(api.load(tmp_path / "a.sdf"), out, fixed_joints="lump", verify=True)
    (sensor,) = api.load(out).mounted_sensors
    assert (sensor.link, sensor.origin.xyz) == ("a", (1.0, 0.0, 1.0))


@pytest.mark.library("mujoco")
def test_other_formats_do_not_copy_them(tmp_path):
    xml = next(xml for _, xml in ADDITIONS if xml.startswith("<light"))
    (tmp_path / "a.sdf").write_text(BASE.replace("</inertial>", f"</inertial>{xml}", 1))
    robot = api.load(tmp_path / "a.sdf")
    written = api.export_mjcf(robot, tmp_path / "m", verify=True)
    assert "unread-light" in {loss.code for loss in written.losses}
    made = api.load(next((tmp_path / "m").glob("*.xml")))
    api.export_sdf(made, tmp_path / "b.sdf", verify=True)
