"""An export of an MJCF copies what only MuJoCo has, and reports what it does not copy."""

import pytest

pytest.importorskip("mujoco")

import mujoco
from lxml import etree

from measure.same_format import mjcf
from measure.same_format.run import export_text, list_differing_fields
from measure.same_format.states import compare_file
from urdftool.compare.compare import compare_robots
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.read import read
from urdftool.formats.mjcf.verify import verify, verify_copy
from urdftool.formats.mjcf.write import write

KEPT = (
    "spatial tendon with limit, spring and damping",
    "unnamed motor of a tendon",
    "motor of a site",
    "integrating servo",
    "group of an actuator",
    "weld with torque scale",
    "quadratic coupling",
    "contact pair",
    "clock",
    "gyro",
    "touch",
    "force limit of a joint",
    "frame sensor of a geom",
    "tuple",
    "velocities of a keyframe",
    "actuator groups",
    "statistic",
    "group of a joint",
    "size of a site",
    "sleep policy",
    "fluid shape",
    "user data of a geom",
)


def add(*names):
    """Return a model with additions."""
    root = etree.fromstring(mjcf.BASE)
    for planted in mjcf.CHANGES:
        if planted.what in names:
            planted.edit(root)
    return etree.tostring(root, encoding="unicode")


def test_additions_are_kept(tmp_path):
    plain, made = export_text(mjcf.BASE, tmp_path), export_text(add(*KEPT), tmp_path)
    assert list_differing_fields(plain, made) == []
    assert [check.name for check in made.checks if check.verdict == "differs"] == []
    assert made.losses == plain.losses


GLOSS = "<asset><material name='mt' specular='0.3' emission='0.1'/></asset></mujoco>"
CHECKED = (
    (add("armature of a tendon"), "mass matrix"),
    (add("motor beside one of a site"), "effort"),
    (
        add().replace('name="gd"', 'name="gd" material="mt"').replace("</mujoco>", GLOSS),
        "materials",
    ),
)


@pytest.mark.parametrize(("text", "row"), CHECKED, ids=[row for _, row in CHECKED])
def test_what_the_engine_compiles_is_proved(tmp_path, text, row):
    made = export_text(text, tmp_path)
    [check] = [check for check in made.checks if check.name == row]
    assert check.verdict == "equal"
    for field in ("dof_M0", "jnt_actfrclimited", "jnt_actfrcrange", "mat_specular", "site_type"):
        one, two = getattr(made.source, field), getattr(made.result, field)
        assert two[: len(one)] == pytest.approx(one), field


CLASSES = """<mujoco><default><position kp="7"/><default class="strong"><position kp="9"/>
<tendon stiffness="3"/></default></default>
<worldbody><body name="a"><joint name="j"/><geom size=".1"/>
<body name="b"><joint name="k" axis="1 0 0"/><geom size=".1"/></body></body></worldbody>
<tendon><fixed name="t" class="strong"><joint joint="j" coef="1"/></fixed></tendon>
<actuator><position joint="j"/><position joint="k" class="strong"/></actuator></mujoco>"""


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("", "", ""),
        ('kp="7"', 'kp="8"', "joint actuator 'j': gain is 8, not 7"),
        ('stiffness="3"', 'stiffness="4"', "<fixed> 't': tendon stiffness is"),
        ('coef="1"', 'coef="2"', "<fixed> 't': joint/@coef is 2, not 1"),
        ('<fixed name="t"', '<fixed name="u"', "<fixed> 't' is missing"),
    ],
)
def test_classes_and_what_the_proof_finds(tmp_path, old, new, text):
    (tmp_path / "a.xml").write_text(CLASSES)
    source = read(tmp_path / "a.xml").robot
    made = write(source, Options())
    assert old in made.text
    (tmp_path / "b.xml").write_text(made.text.replace(old, new, 1) if old else made.text)
    checks = verify(source, made, tmp_path / "b.xml", made)
    differing = [text for check in checks for text in check.differing]
    assert bool(differing) == bool(text)
    assert text in " ".join(differing)


@pytest.mark.parametrize(
    ("old", "new", "title"),
    [
        ('coef="1"', 'coef="2"', "<fixed> 't': joint/@coef"),
        ('name="t"', 'name="u"', "<fixed> 't': existence"),
        ('stiffness="3"', 'stiffness="4"', "<fixed> 't': tendon stiffness"),
    ],
)
def test_two_files_are_compared_with_their_copied_elements(tmp_path, old, new, title):
    (tmp_path / "a.xml").write_text(CLASSES)
    (tmp_path / "b.xml").write_text(CLASSES.replace(old, new))
    robots = [read(tmp_path / name).robot for name in ("a.xml", "b.xml")]
    assert title in [d.title for d in compare_robots(*robots).differences]
    assert compare_robots(robots[0], robots[0]).is_equal


def test_what_a_copied_element_names_must_be_there(tmp_path):
    text = add("held joint", "subtree sensor", "frame sensor of a geom", "energy sensor")
    (tmp_path / "a.xml").write_text(text)
    robot = read(tmp_path / "a.xml").robot
    robot.link["b"].collisions.clear()
    robot.link["b"].visuals.clear()
    written = write(robot, Options())
    lost = [loss for loss in written.losses if loss.code == "lossy-mujoco-element"]
    assert [loss.message.partition(":")[0] for loss in lost] == ["<framequat>"]
    assert lost[0].location.line
    assert "e_potential" in written.text


def test_other_formats_report_each(tmp_path):
    (tmp_path / "a.xml").write_text(add(*KEPT))
    losses = {loss.code: loss for loss in read(tmp_path / "a.xml").losses}
    assert {"unread-tendon", "unread-setting", "unread-display", "unread-custom"} <= losses.keys()
    assert "noise of <gyro> g" in losses["unread-setting"].data["names"]
    assert "sleep of <body> a" in losses["unread-setting"].data["names"]


MOVED = """<mujoco><compiler angle="radian"/><worldbody>
<body name="a" pos="0 0 1" euler="0.2 0.3 0"><joint name="j" pos="0.3 0 0.1" axis="0 1 0"/>
<geom size=".1" pos="0.1 0 0" mass="1"/><site name="s" pos="0 0.1 0"/>
<camera name="track" mode="track" pos="0 -1 0"/><camera name="com" mode="trackcom" pos="0 -1 0"/>
<camera name="aim" mode="targetbody" target="b" pos="1 1 1"/>
<light name="lamp" mode="track" pos="0 0 2" dir="0 1 -1"/>
<body name="b" pos="0 0.4 0"><joint name="k" pos="0 0.2 0.1" axis="1 0 0" ref="0.4" range="0 1"/>
<joint name="l" pos="0.2 0 0" axis="0 0 1" ref="-0.3"/><geom name="g" size=".1" mass="2"/>
<body name="c" pos="0.5 0 0"><joint name="n" type="slide" axis="0 0 1" ref="0.1"/>
<geom size=".1" mass="1"/></body></body></body></worldbody>
<tendon><spatial name="t" stiffness="10"><site site="s"/><geom geom="g"/><site site="s"/></spatial>
</tendon>
<equality><weld name="w" body1="c" body2="a"/><connect body1="b" body2="a" anchor="0 0.1 0"/>
<joint joint1="n" joint2="j" polycoef="0 0.5 0 0 0"/></equality>
<sensor><framepos name="f" objtype="xbody" objname="a" reftype="xbody" refname="b"/></sensor>
<keyframe><key name="home"/></keyframe></mujoco>"""


def test_frames_and_starts_stay_where_the_source_has_them(tmp_path):
    path = tmp_path / "a.xml"
    path.write_text(MOVED)
    result = compare_file(path)
    assert (result.moved, result.differing) == (6, {})
    assert result.compared["camera"] == 5 * 3 * 12
    assert result.compared["light"] == 5 * 6
    robot = read(path).robot
    written = write(robot, Options())
    checks = verify_copy(robot, Options(), written)
    assert [check.name for check in checks if check.verdict == "differs"] == []
    models = [mujoco.MjModel.from_xml_string(text) for text in (MOVED, written.text)]
    names = ("qpos0", "key_qpos", "eq_data", "tendon_length0", "jnt_range", "jnt_bodyid")
    for name in (*names, "body_mass", "body_inertia", "dof_invweight0"):
        one, other = (getattr(model, name) for model in models)
        assert one == pytest.approx(other, abs=1e-7), name


def test_joints_of_one_body_stay_in_it(tmp_path):
    """A body between them would let its parent and child collide, and need mass."""
    text = MOVED.replace('size=".1" mass="2"', 'size=".4" mass="2"')
    (tmp_path / "a.xml").write_text(text)
    written = write(read(tmp_path / "a.xml").robot, Options(exclude="none"))
    counts = []
    for one in (text, written.text):
        model = mujoco.MjModel.from_xml_string(one)
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        counts.append((model.nbody, model.nexclude, data.ncon))
    assert counts[0] == counts[1]
    assert {"lossy-massless", "lossy-overlap"}.isdisjoint(one.code for one in written.losses)


def test_couplings_of_a_generated_model_are_relative_to_the_start(tmp_path):
    """An export of a model with ``<replicate>`` builds couplings itself."""
    extra = '<replicate count="2" offset="0 0 1"><geom size="0.1"/></replicate>'
    text = MOVED.replace("</worldbody>", extra + "</worldbody>")
    (tmp_path / "a.xml").write_text(text)
    model = mujoco.MjModel.from_xml_string(write(read(tmp_path / "a.xml").robot, Options()).text)
    coupling = list(model.eq_type).index(int(mujoco.mjtEq.mjEQ_JOINT))
    assert model.eq_data[coupling][:2] == pytest.approx((0.0, 0.5))
    connect = list(model.eq_type).index(int(mujoco.mjtEq.mjEQ_CONNECT))
    assert model.eq_data[connect][:3] == pytest.approx((0.0, 0.1, 0.0))


def test_a_body_that_a_camera_follows_is_not_merged(tmp_path):
    inner = '<body name="d" pos="0.1 0 0"><camera name="on" {}pos="0 0 1"/></body>'
    found = []
    for mode in ("", 'mode="track" '):
        text = MOVED.replace('<geom size=".1" pos', inner.format(mode) + '<geom size=".1" pos')
        (tmp_path / "a.xml").write_text(text)
        text = write(read(tmp_path / "a.xml").robot, Options(fuse=True)).text
        found.append('<body name="d"' in text)
    assert found == [False, True]


DRIVEN = """<mujoco model="k"><compiler angle="radian"/>{asset}<worldbody><site name="w"/>
<body name="b" pos="0 0 1"><geom name="g" type="box" size=".1 .1 .1"/>
<body name="l" pos="0 0 .2"><joint name="j" axis="0 1 0" range="-1 1"/>
<geom type="capsule" size=".02" fromto="0 0 0 0 0 .2"/>
<body name="m" pos="0 0 .2"><joint name="k" axis="0 1 0" range="-1 1"/>
<geom type="capsule" size=".02" fromto="0 0 0 0 0 .2"/></body></body>{body}</body></worldbody>
<equality><joint joint1="k" joint2="j" polycoef="0.1 0.5 0 0 0"/></equality>
<actuator>{first}<position name="p" joint="j" kp="10"/><velocity joint="j" kv="1"/></actuator>
<keyframe><key name="home" qpos="{qpos}" ctrl="{ctrl}"/></keyframe></mujoco>"""
"""Two actuators at a joint, a coupling and a key."""

FIRST = '<motor name="m" site="w" gear="1 0 0 0 0 0"/>'


@pytest.mark.parametrize(
    ("options", "ctrl", "first"),
    [
        (Options(), "0.2 0.1", ""),
        (Options(), "0.2 0.1", FIRST),  # which is not copied: the site is scenery
        (Options(actuators="position"), "0.5", ""),
        (Options(actuators="none"), "", ""),
    ],
)
def test_a_key_has_the_controls_of_the_actuators_of_the_export(tmp_path, options, ctrl, first):
    own = "0.3 0.2 0.1" if first else "0.2 0.1"
    text = DRIVEN.format(asset="", body="", first=first, qpos="0.5 0.35", ctrl=own)
    (tmp_path / "a.xml").write_text(text)
    robot = read(tmp_path / "a.xml").robot
    written = write(robot, options)
    model = mujoco.MjModel.from_xml_string(written.text)
    assert model.key_qpos[0] == pytest.approx((0.5, 0.35))
    assert model.key_ctrl[0][: len(ctrl.split())] == pytest.approx([*map(float, ctrl.split())])
    rows = {check.name: check.differing for check in verify_copy(robot, options, written)}
    assert rows["other elements"] == []
    changed = [
        one for one in written.losses if one.message.startswith("<key> 'home': ctrl changed")
    ]
    assert bool(changed) is (ctrl != own)


@pytest.mark.parametrize("key", ["", '<keyframe><key name="low" qpos="0.1 0.2"/></keyframe>'])
def test_what_a_model_says_that_attaches_another_is_kept(tmp_path, key):
    """Sections are copied, but those that the other model adds to, which are made anew."""
    part = DRIVEN.format(asset="", body="", first="", qpos="0 0", ctrl="0 0")
    part = part.partition("<equality>")[0].replace('name="w"', 'name="v"') + f"{key}</mujoco>"
    (tmp_path / "part.xml").write_text(part)
    text = DRIVEN.format(
        asset='<asset><model name="part" file="part.xml"/></asset>',
        body='<attach model="part" body="b" prefix="A_"/>',
        first="",
        qpos="0.5 0.35 0.3 0.2",
        ctrl="0.2 0.1",
    )
    (tmp_path / "a.xml").write_text(text)
    robot = read(tmp_path / "a.xml").robot
    written = write(robot, Options())
    model = mujoco.MjModel.from_xml_string(written.text)
    assert model.key_qpos[0] == pytest.approx((0.5, 0.35, 0.3, 0.2))
    assert model.eq_solref[0] == pytest.approx((0.02, 1))
    rows = {check.name: check for check in verify_copy(robot, Options(), written)}
    assert [check.name for check in rows.values() if check.verdict == "differs"] == []
    assert rows["configurations"].verdict == ("announced" if key else "equal")
    if not key:
        assert model.key_ctrl[0] == pytest.approx((0.2, 0.1))


def test_the_range_of_a_joint_that_an_equality_holds_is_kept(tmp_path):
    """The limits of the robot are where the equality holds it."""
    held = DRIVEN.format(asset="", body="", first="", qpos="0 0.1", ctrl="0 0")
    held = held.replace('joint1="k" joint2="j" polycoef="0.1 0.5', 'joint1="k" polycoef="0.3 0')
    (tmp_path / "a.xml").write_text(held)
    robot = read(tmp_path / "a.xml").robot
    written = write(robot, Options())
    model = mujoco.MjModel.from_xml_string(written.text)
    assert model.jnt_range[1] == pytest.approx((-1, 1))
    (tmp_path / "b.xml").write_text(held.replace('"k" axis="0 1 0" range="-1', '"k" range="-2'))
    differences = compare_robots(robot, read(tmp_path / "b.xml").robot).differences
    assert "@range" in {one.what for one in differences}
