"""Actuators, exclusions, base, materials, extensions: one section of the file after the other."""

import pytest

from urdftool.formats.mjcf.model import color_name
from urdftool.refusal import Refused

from .robots import BOX, INERTIAL, export, find, joint, link, robot, rules, tree

COLLIDES = f"{INERTIAL}<collision>{BOX}</collision>"
LIMIT = '<limit lower="-1" upper="2" effort="30" velocity="3"/>'


def chain(*extra, base="base", root=COLLIDES):
    return robot(
        link(base, root), link("a", COLLIDES), link("b", COLLIDES),
        joint("j", base, "a", inside=LIMIT), joint("k", "a", "b", inside=LIMIT), *extra,
    )  # fmt: skip


def actuators(write, text, **choices):
    """The actuators as a reader has them, with what their class says."""
    model = tree(export(write("r.urdf", text), **choices))
    section = model.find("actuator")
    found = []
    for element in section if section is not None else ():
        said = dict(element.attrib)
        name = said.pop("class", "")
        for default in model.iter("default"):
            if default.get("class") == name:
                said = {**default.find(element.tag).attrib, **said}
        found.append((element.tag, said))
    return found


def test_joints_that_nothing_drives_get_servos(write):
    assert [tag for tag, _ in actuators(write, chain())] == ["position", "position"]
    assert actuators(write, chain(), actuators="described") == []
    assert "lossy-added-servo" in rules(export(write("r.urdf", chain())))


def test_position_servos(write):
    (tag, first), _ = actuators(write, chain(), actuators="position")
    assert tag == "position"
    assert first == {
        "name": "j", "joint": "j", "kp": "1200", "dampratio": "1", "inheritrange": "1",
    }  # fmt: skip


def test_velocity_servos_and_motors(write):
    (_, velocity), _ = actuators(write, chain(), actuators="velocity")
    assert (velocity["kv"], velocity["ctrlrange"]) == ("100", "-3 3")
    (_, motor), _ = actuators(write, chain(), actuators="motor")
    assert motor["ctrlrange"] == "-30 30"


def test_transmissions(write):
    block = (
        "<transmission name='t'><type>transmission_interface/SimpleTransmission</type>"
        "<joint name='{}'><hardwareInterface>{}</hardwareInterface></joint>"
        "<actuator name='m'><mechanicalReduction>10</mechanicalReduction></actuator></transmission>"
    )
    text = chain(
        block.format("j", "hardware_interface/EffortJointInterface"),
        block.format("k", "hardware_interface/PositionJointInterface"),
    )
    (one, motor), (other, _) = actuators(write, text)
    assert (one, motor["gear"], motor["ctrlrange"], other) == ("motor", "10", "-3 3", "position")
    assert actuators(write, text, actuators="none") == []


def test_followers_and_locked_joints_have_no_actuator(write):
    text = robot(
        link("a"), link("b"), link("c"), link("d"),
        joint("lead", "a", "b"),
        joint("follow", "a", "c", inside='<limit lower="-1" upper="1"/><mimic joint="lead"/>'),
        joint("locked", "a", "d", inside='<limit lower="1" upper="1"/>'),
    )  # fmt: skip
    found = [attributes["name"] for _, attributes in actuators(write, text, actuators="motor")]
    assert found == ["lead"]


def excluded(written):
    section = tree(written).find("contact")
    return [] if section is None else [(e.get("body1"), e.get("body2")) for e in section]


def test_what_is_held_does_not_collide_with_its_neighbour(write):
    path = write("r.urdf", chain())
    assert excluded(export(path)) == [("base", "a")]
    assert excluded(export(path, base="free")) == []


def test_srdf(write, tmp_path):
    pairs = [("base", "b"), ("a", "b"), ("base", "ghost")]
    inside = "".join(f'<disable_collisions link1="{x}" link2="{y}"/>' for x, y in pairs)
    write("r.srdf", f'<robot name="r">{inside}</robot>')
    written = export(write("r.urdf", chain()), srdf=tmp_path / "r.srdf")
    assert excluded(written) == [("base", "a"), ("base", "b")]
    assert "lossy-srdf" in rules(written)


@pytest.mark.parametrize(
    ("extra", "base", "free"),
    [
        ("", "base", False),
        ("", "world", False),
        ("<gazebo><static>true</static></gazebo>", "base", False),
        (
            '<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"/></gazebo>',
            "base",
            True,
        ),
        ('<gazebo><plugin name="d" filename="gz-sim-diff-drive-system"/></gazebo>', "base", True),
    ],
)
def test_base_as_the_description_says(write, extra, base, free):
    model = tree(export(write("r.urdf", chain(extra, base=base))))
    assert (model.find(".//freejoint") is not None) == free


def test_a_root_called_world_is_the_world(write):
    model = tree(export(write("r.urdf", chain(base="world")), base="free"))
    assert model.find(".//freejoint") is None
    assert model.find("worldbody/geom") is not None
    assert find(model, "exclude", None).get("body1") == "world"


def test_a_link_called_world_that_is_not_the_root(write):
    text = robot(link("base"), link("world"), joint("j", "base", "world"))
    written = export(write("r.urdf", text))
    assert find(tree(written), "body", "world_link") is not None
    assert written.renamed == {("link", "world"): "world_link"}


def visual(material):
    return f"<visual>{BOX}{material}</visual>"


def test_materials(write):
    text = robot(
        '<material name="blue"><color rgba="0 0 1 1"/></material>',
        link("a", visual('<material name="blue"/>') + visual('<material name="ghost"/>')),
        link("b", visual('<material name="blue"><color rgba="0 0 0.5 1"/></material>')),
        link("c", visual('<material name=""><color rgba="0.5 0.5 0.5 1"/></material>') * 2),
        link("d", visual('<material name=""><color rgba="0.1 0.2 0.3 1"/></material>')),
        *(joint(f"to_{x}", "a", x, "fixed", "") for x in "bcd"),
    )
    written = export(write("r.urdf", text))
    model = tree(written)
    assert [(m.get("name"), m.get("rgba")) for m in model.iter("material")] == [
        ("blue", "0 0 1 1"), ("gray50", "0.5 0.5 0.5 1"),
    ]  # fmt: skip
    looks = [(g.get("material"), g.get("rgba")) for g in model.find("worldbody").iter("geom")]
    assert looks == [
        ("blue", None), (None, None), ("blue", None), ("gray50", None), ("gray50", None),
        (None, "0.1 0.2 0.3 1"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("rgba", "name"),
    [("0 0 0 1", "black"), ("0.25 0.25 0.25 1", "gray25"), ("0 0.5 1 0.5", "color_0080ff_alpha50")],
)
def test_names_of_colours(rgba, name):
    assert color_name(rgba) == name


def test_names_of_geoms_are_unique(write):
    named = f'<visual name="x">{BOX}</visual><collision name="x">{BOX}</collision>'
    text = robot(link("a", named), link("b", named), joint("j", "a", "b"))
    names = [
        g.get("name") for g in tree(export(write("r.urdf", text))).find("worldbody").iter("geom")
    ]
    assert names == ["x", "a_x", "b_x", "b_x_collision"]


@pytest.mark.parametrize(
    "inside",
    [
        '<option timestep="fast"/>',
        '<option timestep="nan"/>',
        '<option gravity="0 0"/>',
        '<option iterations="1.5"/>',
        '<option o_solref="1 2 3"/>',
        '<option integrator="euler"/>',
        '<option><flag contact="off"/></option>',
        '<compiler alignfree="maybe"/>',
        '<size nkey="few"/>',
        '<statistic center="0 0"/>',
        '<visual><map znear="${near}"/></visual>',
        '<visual><rgba fog="1 1 1"/></visual>',
    ],
)
def test_mujoco_values_that_are_none(write, inside):
    path = write("r.urdf", robot("", link("a"), f"<mujoco>{inside}</mujoco>"))
    with pytest.raises(Refused) as caught:
        export(path)
    (finding,) = caught.value.findings
    assert finding.code == "bad-mujoco-value"
    assert finding.location.line == 3
    written = export(path, force=True)
    assert rules(written) == ["bad-mujoco-value"]
    value = inside.partition('="')[2].partition('"')[0]
    assert f'"{value}"' not in written.files[written.main].decode()


@pytest.mark.parametrize(
    "inside",
    [
        '<option timestep="1e-3" gravity="0 0 -9.81" iterations="20" o_solref="0.02"/>',
        '<option solver="CG" cone="elliptic"><flag contact="disable"/></option>',
        '<option something_new="yes"/>',
        '<size memory="10M"/>',
    ],
)
def test_mujoco_values_that_are_good(write, inside):
    written = export(write("r.urdf", robot(link("a"), f"<mujoco>{inside}</mujoco>")))
    assert rules(written) == []


def test_mujoco_extension(write):
    extension = (
        '<mujoco><compiler balanceinertia="true" alignfree="false"/><option timestep="0.005">'
        '<flag contact="disable"/></option><worldbody/></mujoco>'
    )
    written = export(write("r.urdf", chain(extension)))
    model = tree(written)
    assert model.find("compiler").get("alignfree") == "false"
    assert model.find("compiler").get("balanceinertia") is None
    assert model.find("option").get("timestep") == "0.005"
    assert model.find("option/flag").get("contact") == "disable"
    assert rules(written).count("lossy-mujoco") == 2


@pytest.mark.parametrize(
    ("shape", "size"),
    [
        ('<cylinder radius="1" length="0"/>', None),
        ('<box size="1 0 1"/>', None),
        ('<capsule radius="0.1" length="0.4"/>', "0.1 0.2"),
        ('<capsule radius="0.1" length="0"/>', "0.1"),
        ('<drake:ellipsoid a="1" b="2" c="3"/>', "1 2 3"),
    ],
)
def test_shapes_at_the_edge(write, shape, size):
    text = robot(link("a", f"<collision><geometry>{shape}</geometry></collision>"))
    geom = tree(export(write("r.urdf", text))).find(".//worldbody//geom")
    assert (None if geom is None else geom.get("size")) == size


def test_the_pose_of_the_whole_robot(write):
    text = robot('<origin xyz="1 2 3"/>', link("a"))
    assert find(tree(export(write("r.urdf", text))), "body", "a").get("pos") == "1 2 3"


def test_the_floor_is_below_what_collides(write):
    written = export(write("r.urdf", robot(link("a", COLLIDES))), scene=True)
    from lxml import etree

    floor = find(etree.fromstring(written.files["scene.xml"]), "geom", "floor")
    assert floor.get("pos") == "0 0 -1.5"
