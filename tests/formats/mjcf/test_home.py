"""The key home: where it comes from, that it holds, and where the floor is."""

import pytest
from lxml import etree

from urdftool.errors import ConfigError, ModelError

from .robots import INERTIAL, export, find, joint, link, robot, rules, tree

BALL = f'{INERTIAL}<collision><geometry><sphere radius="0.1"/></geometry></collision>'
KNEE = '<limit lower="-2.7" upper="-0.9" effort="10" velocity="1"/>'
CONTROL = (
    '<ros2_control name="h" type="system"><joint name="{}"><command_interface name="position"/>'
    '<state_interface name="position"><param name="initial_value">{}</param></state_interface>'
    "</joint></ros2_control>"
)
FOLLOW = '<limit lower="-9" upper="9"/><mimic joint="k" multiplier="2" offset="0.5"/>'


def arm(*extra):
    return robot(
        link("base"), link("a", BALL), link("b", BALL), link("c", BALL),
        joint("knee", "base", "a", inside=f'<origin xyz="0 0 -1"/>{KNEE}'),
        joint("k", "a", "b"), joint("follow", "a", "c", inside=FOLLOW), *extra,
    )  # fmt: skip


def key(written):
    return find(tree(written), "key", "home")


def qpos(written):
    return [float(word) for word in key(written).get("qpos").split()]


def test_every_model_has_a_home_within_its_limits(write):
    written = export(write("r.urdf", arm()))
    assert qpos(written) == [-0.9, 0, 0.5]
    assert key(written).get("ctrl") == "-0.9 0"  # of the servos; the third joint follows
    assert key(export(write("s.urdf", robot(link("a"))))).get("qpos") is None


def test_servos_hold_the_home_position(write):
    held = key(export(write("r.urdf", arm()), actuators="position", pose={"k": 0.25}))
    assert held.get("ctrl") == "-0.9 0.25"
    assert key(export(write("r.urdf", arm()), actuators="motor")).get("ctrl") == "0 0"


SRDF = """<robot name="r">
<group_state name="folded" group="g"><joint name="k" value="-0.7"/></group_state>
<group_state name="home" group="g"><joint name="k" value="0.3"/></group_state>
<group_state name="home" group="h"><joint name="knee" value="-2"/><joint name="x" value="0"/>
</group_state></robot>"""


def test_the_user_comes_before_the_srdf_and_this_before_ros2_control(write, tmp_path):
    path = write("r.urdf", arm(CONTROL.format("k", 0.9), CONTROL.format("knee", -1)))
    write("r.srdf", SRDF)
    srdf = tmp_path / "r.srdf"
    assert qpos(export(path)) == [-1, 0.9, 2.3]
    written = export(path, srdf=srdf)
    assert qpos(written) == pytest.approx([-2, 0.3, 1.1])
    assert rules(written).count("lossy-srdf") == 1
    assert qpos(export(path, srdf=srdf, state="folded")) == pytest.approx([-1, -0.7, -0.9])
    assert qpos(export(path, srdf=srdf, pose={"k": 0})) == pytest.approx([-2, 0, 0.5])


def test_positions_beyond_a_limit_are_said_and_moved(write):
    written = export(write("r.urdf", arm(CONTROL.format("knee", 0))), pose={"k": 5})
    assert qpos(written) == [-0.9, 1, 2.5]
    assert rules(written).count("lossy-home") == 2


@pytest.mark.parametrize(
    ("choice", "error", "said"),
    [
        ({"pose": {"nee": 1.0}}, ModelError, "did you mean 'knee'"),
        ({"pose": {"follow": 1.0}}, ModelError, "mimics 'k'; give a position of that joint"),
        ({"state": "home"}, ConfigError, "add --srdf"),
        ({"state": "up", "srdf": True}, ConfigError, "no group state 'up'; it has folded, home"),
    ],
)
def test_what_is_not_there_is_refused(write, tmp_path, choice, error, said):
    write("r.srdf", SRDF)
    if "srdf" in choice:
        choice = {**choice, "srdf": tmp_path / "r.srdf"}
    with pytest.raises(error, match=said):
        export(write("r.urdf", arm()), **choice)


def test_a_free_base_stands_on_the_floor(write):
    text = arm('<origin xyz="3 0 7" rpy="0 0 1"/>')
    written = export(write("r.urdf", text), base="free", pose={"knee": -2.0}, scene=True)
    assert qpos(written)[:3] == [3, 0, 1.1]
    assert find(tree(written), "body", "base").get("pos") == "3 0 1.1"
    floor = find(etree.fromstring(written.files["scene.xml"]), "geom", "floor")
    assert floor.get("pos") is None


def test_the_floor_of_a_held_robot_is_below_it(write):
    written = export(write("r.urdf", arm()), base="fixed", scene=True)
    floor = find(etree.fromstring(written.files["scene.xml"]), "geom", "floor")
    assert floor.get("pos") == "0 0 -1.1"
    assert "lossy-floor" in rules(written)


def test_a_floating_body_is_lifted_out_of_the_floor(write):
    text = robot(link("world", ""), link("a", BALL), joint("j", "world", "a", "floating", ""))
    assert qpos(export(write("r.urdf", text))) == [0, 0, 0.1, 1, 0, 0, 0]
    high = text.replace("</joint>", '<origin xyz="1 0 2"/></joint>')
    assert qpos(export(write("r.urdf", high)))[:3] == [1, 0, 2]


SHAPES = {
    "box": ('<box size="0.2 0.4 0.6"/>', 0.1 * 0.5 + 0.3 * 3**0.5 / 2),
    "cylinder": ('<cylinder radius="0.1" length="0.6"/>', 0.1 * 0.5 + 0.3 * 3**0.5 / 2),
    "capsule": ('<capsule radius="0.1" length="0.6"/>', 0.1 + 0.3 * 3**0.5 / 2),
    "ellipsoid": (
        '<drake:ellipsoid a="0.1" b="0.2" c="0.3"/>',
        ((0.1 * 0.5) ** 2 + (0.3 * 3**0.5 / 2) ** 2) ** 0.5,
    ),
}


@pytest.mark.parametrize("name", SHAPES)
def test_the_lowest_point_is_exact(write, name):
    shape, low = SHAPES[name]
    inside = (
        f'{INERTIAL}<collision><origin rpy="0 {3.141592653589793 / 6} 0"/><geometry>{shape}'
        "</geometry></collision>"
    )
    written = export(write("r.urdf", robot(link("a", inside))), base="free")
    assert qpos(written)[2] == pytest.approx(low, abs=1.1e-6)


@pytest.mark.library("mujoco")
def test_the_key_touches_the_floor_in_mujoco(urdftool, write, tmp_path):
    import mujoco

    path = write("r.urdf", arm())
    target = tmp_path / "out"
    done = urdftool(
        *("export", "mjcf", path, "-o", target, "--base", "free", "--scene", "--pose", "knee=-1.3")
    )
    assert done.code == 0
    assert "free base (--base free), 2 actuators" in done.err
    model = mujoco.MjModel.from_xml_path(str(target / "scene.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    spheres = model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE
    lowest = data.geom_xpos[spheres, 2] - model.geom_size[spheres, 0]
    assert lowest == pytest.approx([0, 0, 0], abs=2e-6)
    mujoco.mj_step(model, data, 2)
    floor = model.geom("floor").id
    assert any(floor in contact.geom for contact in data.contact)


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(
    ("old", "new", "failing"),
    [
        ('name="home" qpos="0 0 1.1', 'name="home" qpos="0 0 1.2', "home"),
        ('pos="0 0 1.1', 'pos="0 0 1.2', "home"),
        (" -0.9 0 0.5", " -0.8 0 0.5", "configurations"),
        (" -0.9 0 0.5", " -0.9 0 0.6", "configurations"),
        ('ctrl="-0.9 0"', 'ctrl="0 0"', "home"),
        ('name="home"', 'name="start"', "home"),
        ("<freejoint", '<joint type="ball"', "base"),
    ],
)
def test_a_change_of_home_is_found(write, tmp_path, old, new, failing):
    from urdftool.formats.mjcf.options import Options
    from urdftool.formats.mjcf.verify import verify
    from urdftool.formats.mjcf.write import write as write_mjcf
    from urdftool.model.load import load

    options = Options(base="free", actuators="position")
    made = load(write("r.urdf", arm()))
    written = write_mjcf(made, options)
    assert old in written.text
    if failing == "base":
        before, _, rest = written.text.partition("<keyframe>")
        changed = (before + rest.partition("</keyframe>")[2]).replace(old, new)
    else:
        changed = written.text.replace(old, new)
    written.files[written.main] = changed.encode()
    model = tmp_path / "r.xml"
    model.write_text(changed)
    checks = verify(made, written, model, write_mjcf(made, options), options)
    assert failing in [check.name for check in checks if check.verdict == "differs"]


@pytest.mark.library("mujoco")
def test_a_scene_around_a_robot_with_a_floor_of_its_own(write, urdftool):
    shape = '<visual name="floor"><geometry><box size="1 1 1"/></geometry>{}</visual>'
    paint = '<material name="groundplane"><color rgba="1 0 0 1"/></material>'
    path = write("r.urdf", robot(link("a", shape.format(paint))))
    assert urdftool("export", "mjcf", path, "-o", "out", "--scene").code == 0


def test_a_scene_around_a_long_chain(write):
    links = [link(f"l{i}") for i in range(400)]
    joints = [joint(f"j{i}", f"l{i}", f"l{i + 1}", "continuous", "") for i in range(399)]
    assert "scene.xml" in export(write("r.urdf", robot(*links, *joints)), scene=True).files


@pytest.mark.library("mujoco")
def test_an_object_of_an_mjcf_stays_where_its_author_put_it(write):
    """Beside an arm whose own shapes reach below the height of the floor."""
    from urdftool.api.load import load
    from urdftool.formats.mjcf.write import write as write_mjcf

    path = write(
        "r.xml",
        """<mujoco><worldbody><body name="arm"><geom type="box" size=".1 .1 .1" mass="1"/></body>
<body name="ball" pos="1 0 0.1"><freejoint/><geom size="0.1" mass="1"/></body></worldbody>
</mujoco>""",
    )
    assert qpos(write_mjcf(load(path))) == [1, 0, 0.1, 1, 0, 0, 0]


def test_a_free_body_is_lifted_by_its_own_depth(write):
    """A ball of a URDF, beside a ball that is fixed to the world and reaches deeper."""
    path = write("r.urdf", robot(
        link("world"), link("post", BALL), link("ball", BALL),
        joint("fix", "world", "post", "fixed", '<origin xyz="0 0 -1"/>'),
        joint("free", "world", "ball", "floating", '<origin xyz="1 0 0.05"/>'),
    ))  # fmt: skip
    assert qpos(export(path)) == [1, 0, 0.1, 1, 0, 0, 0]
