"""An export of an SDF copies sensors, plugins and lights, and reports what it does not copy."""

import pytest

import urdftool as api
from measure.same_format.sdf import ADDITIONS, BASE, INERTIAL, measure_sdf
from urdftool.compare.compare import compare_robots

SOME = ("<light", '<sensor name="s" type="imu', "<gripper", "<battery", "<self_collide", "<plugin")


def test_additions_are_kept(tmp_path):
    some = tuple((path, xml) for path, xml in ADDITIONS if xml.startswith(SOME))
    results = {r.what: r.verdict for r in measure_sdf(tmp_path, some) if "libv.so" not in r.what}
    assert len(results) >= 6
    assert set(results.values()) == {"kept"}


def test_what_the_robot_does_not_hold_of_shapes_and_joints_is_kept(tmp_path):
    words = ("gearbox", "libv.so", "soft_contact", "shader", "<density")
    some = tuple((path, xml) for path, xml in ADDITIONS if any(word in xml for word in words))
    results = {(r.what, r.verdict) for r in measure_sdf(tmp_path, some)}
    assert len(results) >= 5
    assert {what for what, verdict in results if verdict != "kept"} == {"<density>300</density>"}


def test_what_is_not_read_is_reported(tmp_path):
    some = tuple((path, xml) for path, xml in ADDITIONS if "auto_inertia_params" in xml)
    assert [r.codes for r in measure_sdf(tmp_path, some)] == [["unread-inertial"]]


LOOP = """<joint name="k" type="{kind}"><parent>a</parent><child>c</child>
<axis><xyz>1 0 0</xyz></axis></joint>
<joint name="loop" type="revolute"><parent>b</parent><child>c</child>
<pose>0 0 1 0 0 0.5</pose><axis><xyz>0 1 0</xyz><limit><lower>-1</lower><upper>1</upper></limit>
<dynamics><damping>0.3</damping></dynamics></axis></joint></model>"""


def write_loop(path, kind, old="", new=""):
    link = f'<link name="c"><pose>1 0 0 0 0.2 0</pose>{INERTIAL}</link>'
    loop = LOOP.replace("{kind}", kind).replace(old, new, 1)
    path.write_text(BASE.replace("</model>", link + loop))
    return api.load(path)


@pytest.mark.parametrize("kind", ["revolute", "fixed"])
def test_a_loop_is_copied(tmp_path, kind):
    source = write_loop(tmp_path / "a.sdf", kind)
    written = api.export_sdf(source, tmp_path / "b.sdf", fixed_joints="lump", verify=True)
    assert [c.name for c in written.checks if c.verdict == "differs"] == []
    (loop,) = api.load(tmp_path / "b.sdf").closures
    assert (loop.name, loop.child) == ("loop", "a" if kind == "fixed" else "c")


@pytest.mark.parametrize(
    ("old", "new", "row"),
    [("0.3<", "0.4<", "other elements"), ("0 0 1 0 0 0.5", "0 0 2 0 0 0.5", "loops")],
)
def test_a_loop_is_compared(tmp_path, old, new, row):
    one = write_loop(tmp_path / "a.sdf", "fixed")
    other = write_loop(tmp_path / "b.sdf", "fixed", old, new)
    assert {d.row for d in compare_robots(one, other).differences} == {row}


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


def test_values_of_a_second_axis_are_those_of_the_second_joint(tmp_path):
    """A universal joint is two joints in the robot, so no element of it is left."""
    joint = '<joint name="u" type="universal"><parent>a</parent><child>b</child><axis/><axis2>'
    joint += "<xyz>0 1 0</xyz><limit><lower>-1</lower><upper>1</upper></limit>{}</axis2></joint>"
    native = []
    for more in ("", "<shade>1</shade>"):
        path = tmp_path / "m.sdf"
        links = f'<link name="a">{INERTIAL}</link><link name="b">{INERTIAL}</link>'
        path.write_text(
            f'<sdf version="1.9"><model name="m">{links}{joint}</model></sdf>'.format(more)
        )
        robot = api.load(path)
        native.append([one.section for one in robot.native if one.section.startswith("joint")])
        assert "axis2" not in api.export_sdf(robot).text or more
    assert native == [[], ["joint u"]]
