"""A finding names only the effects that hold in its case."""

import re
from pathlib import Path

import pytest

from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

ROBOTS = Path(__file__).parents[2] / "fixtures" / "effects" / "robots"
INERTIAL = """<inertial><mass value="{mass}"/>
  <inertia ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="{moment}"/></inertial>"""
HEAVY = INERTIAL.format(mass=1, moment=0.01)
NOTHING = INERTIAL.format(mass=0, moment=0)
BOX = '<geometry><box size="0.1 0.1 0.1"/></geometry>'
VISUAL, COLLISION = f"<visual>{BOX}</visual>", f"<collision>{BOX}</collision>"
MATERIAL = '<visual>{box}<material name="m"><color rgba="{rgba}"/></material></visual>'
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def _robot(arm="", *, base=HEAVY, mid=HEAVY, kind="revolute", limit=LIMIT, first=""):
    """Make a robot of three links: base, mid on a revolute joint, arm on a joint of ``kind``."""
    return f"""<?xml version="1.0"?>
<robot name="r">{first}
  <link name="base">{base}</link>
  <link name="mid">{mid}</link>
  <link name="arm">{arm}</link>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="mid"/><axis xyz="0 0 1"/>{LIMIT}
  </joint>
  <joint name="swing" type="{kind}">
    <parent link="mid"/><child link="arm"/><axis xyz="0 0 1"/>{limit}
  </joint>
</robot>
"""


def found(tmp_path, rule, text):
    """Give the only finding of a rule."""
    path = tmp_path / "r.urdf"
    path.write_text(text)
    (finding,) = check_file(path, Options(Settings(select=(rule,)))).findings
    return finding


def effects_of(tmp_path, rule, text):
    """Give the effects of the only finding of a rule."""
    return found(tmp_path, rule, text).effects


PLANAR = _robot(HEAVY, kind="planar", limit=f'{LIMIT}<dynamics damping="1"/>')
NEGATIVE, MASSLESS = (INERTIAL.format(mass=mass, moment=0.01) for mass in (-1, 0))
ROLLING = _robot(HEAVY, base="BASE").replace('"mid"', '"left_wheel"')
HELD = _robot(MASSLESS, kind="fixed").replace(
    "</robot>",
    '<link name="world"/><joint name="w" type="fixed"><parent link="world"/><child link="base"/>'
    "</joint></robot>",
)


@pytest.mark.parametrize(
    ("robot", "effects"),
    [
        (_robot(NEGATIVE), ["reject the model", "rejects the file"]),
        (_robot(NEGATIVE, kind="fixed"), [None, "ignores the mass"]),
        (_robot(HEAVY, mid=NEGATIVE, kind="fixed"), [None, "ignores the mass"]),
        (_robot(HEAVY, base=NEGATIVE), ["reject the model", "ignores the mass"]),
    ],
    ids=["moves", "fixed", "carries", "root"],
)
def test_a_negative_mass(tmp_path, robot, effects):
    given = effects_of(tmp_path, "negative-mass", robot)
    for reader, start in zip(("gz, gazebo-classic", "mujoco"), effects, strict=True):
        assert given[reader].startswith(start) if start else reader not in given


@pytest.mark.parametrize(
    ("robot", "severity", "readers"),
    [
        (_robot(HEAVY, mid=MASSLESS, kind="fixed"), "warning", ["gz, gazebo-classic, pinocchio"]),
        (_robot(MASSLESS, kind="fixed"), "warning", ["gz, gazebo-classic, pinocchio", "mujoco"]),
        (HELD.replace('"revolute"', '"fixed"'), "info", []),
    ],
    ids=["moves", "fixed", "world"],
)
def test_an_inertia_without_a_mass(tmp_path, robot, severity, readers):
    finding = found(tmp_path, "zero-mass", robot)
    assert finding.severity.label == severity
    assert list(finding.effects) == [*readers, "drake"]


@pytest.mark.parametrize(
    ("robot", "gazebo", "mujoco"),
    [
        (_robot(VISUAL + COLLISION), "omit", "density of water"),
        (_robot(VISUAL), "omit", "rejects"),
        (_robot(VISUAL, kind="fixed"), "", ""),
        (_robot(VISUAL + COLLISION, kind="fixed"), "", "density of water"),
        (_robot(HEAVY, base=VISUAL + COLLISION), "load nothing", ""),
    ],
    ids=["moves", "moves without collision", "fixed", "fixed with collision", "root"],
)
def test_missing_inertial(tmp_path, robot, gazebo, mujoco):
    effects = effects_of(tmp_path, "missing-inertial", robot)
    assert gazebo in effects.get("gz, gazebo-classic", "")
    assert ("gz, gazebo-classic" in effects) == bool(gazebo)
    assert mujoco in effects.get("mujoco", "")
    assert ("mujoco" in effects) == bool(mujoco)
    assert "1 kg" in effects["pybullet"]


@pytest.mark.parametrize(
    ("robot", "keys"),
    [
        (_robot(NOTHING + COLLISION), {"gz, gazebo-classic", "mujoco"}),
        (ROLLING.replace("BASE", NOTHING), {"gz, gazebo-classic", "pybullet"}),
        (
            _robot(INERTIAL.format(mass=0, moment=0.1), kind="fixed"),
            {"gz, gazebo-classic, pinocchio", "mujoco", "drake"},
        ),
    ],
    ids=["moves", "root", "fixed"],
)
def test_zero_mass(tmp_path, robot, keys):
    assert effects_of(tmp_path, "zero-mass", robot).keys() == keys


@pytest.mark.parametrize(
    ("inertial", "pybullet", "gazebo"),
    [
        (HEAVY.replace('ixy="0"', ""), {"pybullet, drake"}, "load the link without"),
        ('<inertial><mass value="1"/></inertial>', {"pybullet"}, "load the link without"),
        ("<inertial/>", {"pybullet"}, "take 0 kg"),
    ],
    ids=["a number", "the inertia", "both"],
)
def test_incomplete_inertial(tmp_path, inertial, pybullet, gazebo):
    effects = effects_of(tmp_path, "incomplete-inertial", _robot(inertial + COLLISION))
    assert {key for key in effects if "pybullet" in key} == pybullet
    assert effects["gz, gazebo-classic"].startswith(gazebo)


@pytest.mark.parametrize(("kind", "accepted"), [("revolute", False), ("fixed", True)])
def test_rounded_moments_of_a_part(tmp_path, kind, accepted):
    tensor = '<inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.00201"/>'
    robot = _robot(f'<inertial><mass value="1"/>{tensor}</inertial>', kind=kind)
    effects = effects_of(tmp_path, "inertia-triangle-inequality-rounding", robot)
    assert effects["gz, gazebo-classic"].startswith("accept it" if accepted else "reject")
    assert effects["mujoco"] == "rejects the file"


@pytest.mark.parametrize(("upper", "says"), [("90", "radians"), ("1e16", "never reached")])
def test_limit_in_degrees(tmp_path, upper, says):
    limit = LIMIT.replace('upper="1"', f'upper="{upper}"')
    effects = effects_of(tmp_path, "limit-in-degrees", _robot(HEAVY + COLLISION, limit=limit))
    (sentence,) = effects.values()
    assert says in sentence


@pytest.mark.parametrize(
    ("first", "base", "urdfdom", "pybullet"),
    [
        (
            '<material name="m"><color rgba="1 0 0 1"/></material>' * 2,
            "",
            "reject the robot",
            "accepts it",
        ),
        (
            '<material name="m"><color rgba="1 0 0 1"/></material>',
            MATERIAL.format(box=BOX, rgba="0 1 0 1"),
            "of the top level",
            "of the visual",
        ),
        (
            "",
            MATERIAL.format(box=BOX, rgba="0 1 0 1") + MATERIAL.format(box=BOX, rgba="1 0 0 1"),
            "first visual",
            "last visual",
        ),
    ],
    ids=["top level", "top level and visual", "visuals"],
)
def test_conflicting_material(tmp_path, first, base, urdfdom, pybullet):
    robot = _robot(HEAVY, base=HEAVY + base, first=first)
    effects = effects_of(tmp_path, "conflicting-material", robot)
    said = {word: says for key, says in effects.items() for word in key.split(", ")}
    assert re.search(urdfdom, said["urdfdom"])
    assert pybullet in said["pybullet"]
    assert said["drake"] == "rejects the file"


@pytest.mark.parametrize("controlled", [True, False])
def test_mimic_dof_mismatch(tmp_path, controlled):
    block = '<ros2_control name="c" type="system"><joint name="swing"/></ros2_control>'
    robot = _robot(
        HEAVY, kind="fixed", limit='<mimic joint="turn"/>', first=block if controlled else ""
    )
    finding = found(tmp_path, "mimic-dof-mismatch", robot)
    keys = {"moveit", "newton", *["ros2_control"] * controlled}
    assert finding.effects.keys() == keys
    assert finding.severity.label == ("error" if controlled else "info")


@pytest.mark.parametrize(
    ("more", "reader"),
    [
        ('<joint name="$(arg j)" type="fixed"/>', {"urdfdom"}),
        ('<gazebo reference="${x}"><mu1>1</mu1></gazebo>', {"gz, gazebo-classic"}),
        ('<transmission name="${x}_trans"/>', set()),
        (
            '<gazebo><plugin name="p" filename="f"><a>$(find p)</a></plugin></gazebo>',
            {"gz, gazebo-classic"},
        ),
    ],
    ids=["joint", "reference", "transmission", "plugin"],
)
def test_unexpanded_expression(tmp_path, more, reader):
    effects = effects_of(tmp_path, "unexpanded-expression", _robot(HEAVY, first=more))
    assert effects.keys() == reader
    assert ("plugin" in "".join(effects.values())) == ("plugin" in more)


def test_a_brace_without_dollar_in_a_plain_urdf(tmp_path):
    robot = _robot(HEAVY, first='<gazebo reference="wheel_{side}_link"><mu1>1</mu1></gazebo>')
    message = found(tmp_path, "unexpanded-expression", robot).message
    assert message.endswith("write the value of '{side}'")


RAISED = COLLISION.replace("<geometry>", '<origin xyz="0 0 0.1"/><geometry>').replace(
    "0.1 0.1 0.1", "0.05 0.05 0.2"
)
SMALL = COLLISION.replace("0.1 0.1 0.1", "0.01 0.01 0.01")


@pytest.mark.parametrize(
    ("base", "mid", "arm", "effect"),
    [
        (HEAVY, HEAVY + RAISED, HEAVY + RAISED, "no contact between parent and child"),
        (HEAVY + RAISED, HEAVY + SMALL, HEAVY + RAISED, "stops the joint"),
    ],
    ids=["parent and child", "a joint between"],
)
def test_self_collision_in_range(tmp_path, base, mid, arm, effect):
    robot = _robot(arm, base=base, mid=mid).replace(
        '<child link="arm"/><axis xyz="0 0 1"/>',
        '<child link="arm"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/>',
    )
    robot = robot.replace('upper="1" effort', 'upper="3.1" effort')
    assert effect in effects_of(tmp_path, "self-collision-in-range", robot)["mujoco"]


def test_links_far_apart_in_the_chain_do_not_say_that_limits_are_too_wide(tmp_path):
    robot = _robot(HEAVY + RAISED, base=HEAVY + RAISED, mid=HEAVY).replace(
        '<child link="arm"/><axis xyz="0 0 1"/>',
        '<child link="wrist"/><origin xyz="0 0 0.1"/><axis xyz="0 1 0"/>',
    )
    robot = robot.replace('upper="1" effort', 'upper="3.1" effort')
    wrist = f'<link name="wrist">{HEAVY}</link><joint name="w" type="revolute">{LIMIT}'
    ends = '<parent link="wrist"/><child link="arm"/><origin xyz="0 0 0.1"/>'
    path = tmp_path / "r.urdf"
    path.write_text(robot.replace("</robot>", f"{wrist}{ends}</joint></robot>"))
    settings = Settings(select=("self-collision-in-range",))
    assert check_file(path, Options(settings)).findings == []


def _finds(tmp_path, rule, text):
    path = tmp_path / "r.urdf"
    path.write_text(text)
    return len(check_file(path, Options(Settings(select=(rule,)))).findings)


@pytest.mark.parametrize(("kind", "count"), [("fixed", 0), ("revolute", 1)])
def test_a_small_part_of_a_body_may_be_dense(tmp_path, kind, count):
    part = COLLISION.replace("0.1 0.1 0.1", "0.015 0.015 0.015")
    robot = _robot(INERTIAL.format(mass=0.05, moment=1e-6) + part, kind=kind)
    assert _finds(tmp_path, "implausible-density", robot) == count


@pytest.mark.parametrize(("shape", "count"), [("", 0), (COLLISION, 1)])
def test_a_frame_may_weigh_next_to_nothing(tmp_path, shape, count):
    robot = _robot(INERTIAL.format(mass=1e-9, moment=1e-15) + shape)
    found = _finds(tmp_path, "implausible-mass", robot)
    found += _finds(tmp_path, "implausible-density", robot)
    assert found == count


TRANSMISSION = """<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
  <joint name="swing">{interface}</joint></transmission>"""
INTERFACE = "<hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>"
PLUGIN = '<gazebo><plugin name="control" filename="libgazebo_ros_control.so"/></gazebo>'


@pytest.mark.parametrize(
    ("interface", "plugin", "severity"),
    [
        (INTERFACE, PLUGIN, "error"),
        (INTERFACE, "", "warning"),
        ("", PLUGIN, "warning"),
    ],
    ids=["loaded", "no plugin", "no interface"],
)
def test_transmission_on_immovable_joint(tmp_path, interface, plugin, severity):
    more = TRANSMISSION.format(interface=interface) + plugin
    finding = found(
        tmp_path, "transmission-on-immovable-joint", _robot(HEAVY, kind="fixed", first=more)
    )
    assert finding.severity.label == severity
    assert ("gazebo_ros_control" in finding.effects) == (severity == "error")
    assert "gz, gazebo-classic" in finding.effects


@pytest.mark.parametrize(("mass", "count"), [(0.01, 0), (0.5, 1)])
def test_a_light_part_of_a_body_may_have_a_small_inertia(tmp_path, mass, count):
    robot = _robot(INERTIAL.format(mass=mass, moment=mass * 1e-5) + COLLISION, kind="fixed")
    assert _finds(tmp_path, "inertia-below-geometry", robot) == count


@pytest.mark.parametrize(("blade", "count"), [(0.5, 0), (0.1, 1)])
def test_the_disc_of_a_rotor(tmp_path, blade, count):
    visual = VISUAL.replace("0.1 0.1 0.1", f"{blade} 0.03 0.01")
    disc = '<collision><geometry><cylinder radius="0.25" length="0.01"/></geometry></collision>'
    robot = _robot(HEAVY + visual + disc, kind="continuous")
    assert _finds(tmp_path, "collision-much-larger-than-visual", robot) == count


@pytest.mark.parametrize(("mesh", "loaded"), [("box.stl", True), ("box.dae", False)])
def test_overlaps_in_a_robot_that_mujoco_does_not_read(tmp_path, mesh, loaded):
    (tmp_path / mesh).write_bytes((ROBOTS / mesh).read_bytes())
    other = f'<collision><geometry><mesh filename="{mesh}"/></geometry></collision>'
    arm = COLLISION.replace("<geometry>", '<origin xyz="0.01 0 0"/><geometry>')
    robot = _robot(HEAVY + arm, base=HEAVY + COLLISION + other, mid=HEAVY + SMALL)
    assert _finds(tmp_path, "self-collision-at-zero", robot) == loaded
    if loaded:
        assert set(effects_of(tmp_path, "self-collision-at-zero", robot)) == {"mujoco"}


@pytest.mark.parametrize(
    ("joint", "keys"),
    [("zoom", set()), ("aim", {"gz, gazebo-classic"})],
    ids=["after one with mass", "before one with mass"],
)
def test_links_of_mass_zero_are_lumped_by_the_names_of_joints(tmp_path, joint, keys):
    fixed = '<joint name="{}" type="fixed"><parent link="{}"/><child link="{}"/></joint>'
    more = "".join(
        [
            f'<link name="eye">{NOTHING}</link><link name="lens">{HEAVY}</link>',
            fixed.format(joint, "arm", "eye"),
            fixed.format("focus", "arm", "lens"),
        ]
    )
    path = tmp_path / "r.urdf"
    path.write_text(_robot(NOTHING, kind="fixed", first=more))
    findings = check_file(path, Options(Settings(select=("zero-mass",)))).findings
    assert {key for finding in findings for key in finding.effects} == keys


JOINT = '{}<mimic joint="{}"/>'
EMPTY, NO_FILE = "<geometry/>", "<geometry><mesh/></geometry>"
FLAT = '<geometry><mesh filename="b.stl" scale="0 1 1"/></geometry>'
TWO = BOX.replace("</geometry>", '<sphere radius="0.1"/></geometry>')


@pytest.mark.parametrize(
    ("rule", "robot", "reader", "effect"),
    [
        ("mimic-cycle", _robot(HEAVY, limit=JOINT.format(LIMIT, "swing")), "mujoco", "4.0 rejects"),
        ("mimic-unknown-joint", _robot(HEAVY, limit=JOINT.format(LIMIT, "x")), "mujoco", "drops"),
        ("mimic-unknown-joint", _robot(HEAVY, limit=f"{LIMIT}<mimic/>"), "mujoco", "4.0 rejects"),
        ("planar-or-floating", PLANAR, "pybullet", "gives it two prismatic"),
        ("planar-or-floating", PLANAR, "mujoco", "loads it"),
        ("planar-or-floating", _robot(HEAVY, kind="floating"), "pybullet", "treats it as fixed"),
        ("planar-or-floating", _robot(HEAVY, kind="floating"), "mujoco", "rejects the file"),
        ("unknown-joint-type", _robot(HEAVY, kind="hinge"), "mujoco, pybullet, drake", "reject it"),
        ("unknown-joint-type", _robot(HEAVY, kind="spherical"), "mujoco, pybullet", "load it"),
        ("empty-geometry", _robot(f"{HEAVY}<visual>{EMPTY}</visual>"), "mujoco", ""),
        ("empty-geometry", _robot(f"{HEAVY}<collision>{EMPTY}</collision>"), "mujoco", "rejects"),
        ("bad-scale", _robot(f"{HEAVY}<visual>{FLAT}</visual>"), "mujoco", ""),
        ("bad-scale", _robot(f"{HEAVY}<collision>{FLAT}</collision>"), "mujoco", "rejects it"),
        ("several-shapes-in-geometry", _robot(f"<visual>{TWO}</visual>"), "mujoco", ""),
        ("several-shapes-in-geometry", _robot(f"<collision>{TWO}</collision>"), "mujoco", "takes"),
        ("missing-name", _robot().replace('"swing"', '""'), "pinocchio", "accepts it"),
        ("missing-name", _robot().replace('name="swing"', ""), "mujoco", "rejects the file"),
    ],
)
def test_a_statement_about_a_reader_holds_for_this_element(tmp_path, rule, robot, reader, effect):
    given = effects_of(tmp_path, rule, robot).get(reader, "")
    assert given.startswith(effect) if effect else not given


@pytest.mark.parametrize("rule", ["empty-geometry", "mesh-without-filename"])
@pytest.mark.parametrize(("part", "lost"), [("visual", "its visuals and"), ("collision", "its")])
def test_urdfdom_keeps_the_visuals_before_a_broken_collision(tmp_path, rule, part, lost):
    geometry = EMPTY if rule == "empty-geometry" else NO_FILE
    given = effects_of(tmp_path, rule, _robot(f"{HEAVY}<{part}>{geometry}</{part}>"))
    text = given.get("pinocchio") or given["urdfdom, gz, gazebo-classic, pinocchio"]
    assert text.partition(" ")[2].startswith(f"the link without {lost} collisions")


@pytest.mark.parametrize(
    ("part", "name", "effect"),
    [("visual", "b.stl", ""), ("collision", "b.stl", "rejects"), ("collision", "b.obj", "uses")],
)
def test_a_file_without_a_mesh_in_mujoco(tmp_path, part, name, effect):
    (tmp_path / name).write_bytes(b"v 0 0 0\n")
    robot = _robot(f'{HEAVY}<{part}><geometry><mesh filename="{name}"/></geometry></{part}>')
    given = effects_of(tmp_path, "corrupt-mesh", robot).get("mujoco", "")
    assert given.startswith(effect) if effect else not given
