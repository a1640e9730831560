"""Whether the root is free, and what drives wheels: arms are held, legs are not."""

import pytest

from .robots import INERTIAL, export, joint, link, robot, tree


def solid(shape, at="0 0 0"):
    return f'{INERTIAL}<collision><origin xyz="{at}"/><geometry>{shape}</geometry></collision>'


TRUNK = solid('<box size="0.6 0.3 0.1"/>')
LEG = solid('<cylinder radius="0.02" length="0.4"/>', "0 0 -0.2")
FOOT = solid('<box size="0.2 0.1 0.02"/>', "0.03 0 -0.4")
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
LEVEL, UPRIGHT = '<axis xyz="0 1 0"/>', '<axis xyz="0 0 1"/>'


def limb(name, at, shape=LEG, parent="trunk"):
    place = f'<origin xyz="{at}"/>{LEVEL}{LIMIT}'
    return link(name, shape) + joint(f"{name}_joint", parent, name, inside=place)


CORNERS = {"fl": "0.3 0.1 0", "fr": "0.3 -0.1 0", "hl": "-0.3 0.1 0", "hr": "-0.3 -0.1 0"}


def quadruped(names=CORNERS, trunk=TRUNK):
    return robot(
        link("trunk", trunk), *(limb(n, at) for n, at in zip(names, CORNERS.values(), strict=True))
    )


def biped(word):
    sides = {f"left_{word}": "0 0.1 0", f"right_{word}": "0 -0.1 0"}
    return robot(link("trunk", TRUNK), *(limb(name, at, FOOT) for name, at in sides.items()))


def waist(*limbs):
    bare = INERTIAL.replace('value="1"', 'value="0.01"')
    return robot(link("trunk", TRUNK), limb("waist", "0 0 -0.1", bare), *limbs)


def biped_below_waist(upper, foot):
    sides = {"left": "0 0.1 0", "right": "0 -0.1 0"}
    uppers = [limb(f"{s}_{upper}", at, INERTIAL, "waist") for s, at in sides.items()]
    return waist(*uppers, *(limb(f"{s}_{foot}", "0 0 0", FOOT, f"{s}_{upper}") for s in sides))


PEDESTAL = solid('<box size="0.1 0.1 0.5"/>', "0 0 -0.25")

FREE = {
    "quadruped": quadruped(),
    "biped": biped("foot"),
    "biped without a telling name": biped("end"),
    "biped below a waist": biped_below_waist("knee", "end"),
    "quadruped with an arm": quadruped().replace(
        "</robot>", limb("arm", "0.2 0 0.1", solid('<sphere radius="0.1"/>')) + "</robot>"
    ),
}
ROTOR = solid('<cylinder radius="0.1" length="0.01"/>')
FLYING = {
    "rotors": quadruped(tuple(f"rotor_{n}" for n in range(4))),
    "a name": robot(link("trunk", TRUNK), limb("arm_1", "0 0 0.1", ROTOR)).replace(
        'name="r"', 'name="hextilt_flying_arm"'
    ),
}
HELD = {
    "torso with hanging arms": biped("hand"),
    "torso with grippers": biped("gripper_base"),
    "torso on a pedestal": quadruped(trunk=PEDESTAL),
    "legs that are not below the mass": quadruped(trunk=TRUNK.replace("<mass", "<x/><mass")
        .replace("<inertial>", '<inertial><origin xyz="2 0 0"/>')
        .replace('value="1"', 'value="100"')),
    "rotors of motors": robot(
        link("trunk", TRUNK), limb("joint1_rotor", "0 0 0.1"), limb("joint2_rotor", "0 0 1", LEG)
    ),
    "one leg": robot(link("trunk", TRUNK), limb("leg", "0 0 0")),
    "arms below a waist": biped_below_waist("upper", "end"),
    "one leg with two toes": waist(
        limb("left_toe", "0 0.1 0", FOOT, "waist"), limb("right_toe", "0 -0.1 0", FOOT, "waist")
    ),
    "hand of two named fingers": quadruped(("index", "ring", "pinky", "thumb")),
    "hand of three fingers": quadruped(("finger_1", "finger_2", "finger_3", "thumb")),
    "arm": robot(
        link("trunk", TRUNK), limb("upper", "0 0 0.1"), limb("lower", "0 0 1", LEG, "upper")
    ),
}  # fmt: skip


def is_free(written):
    return tree(written).find(".//freejoint") is not None


@pytest.mark.parametrize("name", FREE)
def test_what_stands_on_its_legs_is_free(write, name):
    written = export(write("r.urdf", FREE[name]))
    assert is_free(written)
    assert written.summary[0].startswith("free base (it stands on ")
    assert not is_free(export(write("r.urdf", FREE[name]), base="fixed"))


@pytest.mark.parametrize("name", FLYING)
def test_what_flies_is_free(write, name):
    written = export(write("r.urdf", FLYING[name]))
    assert is_free(written)
    assert not is_free(export(write("r.urdf", FLYING[name]), base="fixed"))


def test_a_file_says_that_its_robot_flies(write):
    one = robot(link("trunk", TRUNK))
    assert is_free(export(write("quadrotor_base.urdf", one)))
    assert not is_free(export(write("base.urdf", one)))


@pytest.mark.parametrize("name", HELD)
def test_what_does_not_is_held(write, name):
    written = export(write("r.urdf", HELD[name]))
    assert not is_free(written)
    assert written.summary[0] == "fixed base (the description has no sign of a mobile base)"


@pytest.mark.parametrize(
    ("shape", "why"),
    [
        ("", "no link has a collision, so a free one would fall through the ground"),
        ('<mesh filename="no.stl"/>', "no collision geometry can be read"),
    ],
)
def test_why_nothing_can_stand_is_said(write, shape, why):
    inside = solid(shape) if shape else INERTIAL
    legs = (limb(f"{side}_leg", "0 0 0", inside) for side in ("left", "right"))
    written = export(write("r.urdf", robot(link("trunk", inside), *legs)), force=True)
    assert written.summary[0] == f"fixed base ({why})"


WHEEL = solid('<sphere radius="0.1"/>')
VELOCITY = (
    '<ros2_control name="h" type="system"><joint name="{}">'
    '<command_interface name="velocity"/></joint></ros2_control>'
)


def cart(*extra, axis=LEVEL, kind="continuous", height=0.0, shape='<sphere radius="0.1"/>'):
    body = solid('<box size="0.6 0.3 0.2"/>')  # slides on its rear
    wheels = [
        link(f"{side}_w", solid(shape))
        + joint(side, "body", f"{side}_w", kind, f'<origin xyz="0.2 {y} {height}"/>{axis}{LIMIT}')
        for side, y in (("left", 0.2), ("right", -0.2))
    ]
    return robot(link("body", body), *wheels, *extra)


DRIVEN = [VELOCITY.format(name) for name in ("left", "right")]


def actuators(written):
    section = tree(written).find("actuator")
    return [] if section is None else [(e.tag, e.get("joint")) for e in section]


def test_driven_wheels_at_the_ground_make_the_base_free(write):
    written = export(write("r.urdf", cart(*DRIVEN)))
    assert is_free(written)
    assert written.summary == [
        "free base (it has driven wheels left, right)",
        "2 actuators with assumed gains",
    ]


def test_two_wheels_that_nothing_drives_do_so_too(write):
    written = export(write("r.urdf", cart()))
    assert written.summary[0] == "free base (it stands on wheels left, right)"
    assert not is_free(export(write("r.urdf", cart(kind="fixed"))))


@pytest.mark.parametrize(
    "text",
    [
        cart(*DRIVEN, axis=UPRIGHT),
        cart(*DRIVEN, shape='<box size="0.1 0.1 0.2"/>'),
        cart(*DRIVEN, kind="revolute"),
        cart(*DRIVEN, height=0.3),
    ],
)
def test_other_driven_joints_do_not(write, text):
    assert not is_free(export(write("r.urdf", text)))


def plugin(library, inside):
    return f'<gazebo><plugin name="p" filename="{library}">{inside}</plugin></gazebo>'


@pytest.mark.parametrize(
    "drive",
    [
        plugin(
            "libgazebo_ros_diff_drive.so",
            "<leftJoint>left</leftJoint><rightJoint>right</rightJoint><robotBaseFrame>body"
            "</robotBaseFrame>",
        ),
        plugin(
            "gz-sim-diff-drive-system",
            "<left_joint> left </left_joint><right_joint>right</right_joint>",
        ),
        plugin(
            "libgazebo_ros_skid_steer_drive.so",
            "<leftFrontJoint>left</leftFrontJoint><rightFrontJoint>right</rightFrontJoint>",
        ),
    ],
)
def test_a_drive_plugin_gives_its_wheels_velocity_servos(write, drive):
    written = export(write("r.urdf", cart(drive)))
    assert is_free(written)
    assert actuators(written) == [("velocity", "left"), ("velocity", "right")]
    assert actuators(export(write("r.urdf", cart(drive)), actuators="none")) == []
    effort = VELOCITY.format("left").replace("velocity", "effort")
    assert actuators(export(write("r.urdf", cart(drive, effort))))[0] == ("motor", "left")


def test_a_tricycle_steers_by_position(write):
    front = link("front", WHEEL) + joint("steer", "body", "front", inside=UPRIGHT + LIMIT)
    drive = plugin(
        "libgazebo_ros_tricycle_drive.so",
        "<steeringJoint>steer</steeringJoint><actuatedWheelJoint>left</actuatedWheelJoint>",
    )
    written = export(write("r.urdf", cart(front, drive)))
    assert sorted(actuators(written)) == [("position", "steer"), ("velocity", "left")]


def test_no_actuator_is_said_once_it_matters(write, urdftool):
    def said(text, *options):
        result = urdftool("export", "mjcf", write("r.urdf", text), "-o", "out", *options)
        assert result.code == 0
        return "has no actuators" in result.err

    assert said(quadruped(), "--actuators", "described")
    assert not said(quadruped())  # servos hold it
    assert not said(quadruped(), "--actuators", "none")
    assert not said(quadruped(), "--actuators", "motor")
    assert not said(robot(link("trunk", TRUNK)))


def test_a_robot_with_folded_legs_is_free(write):
    text = quadruped(("leg_1", "leg_2", "leg_3", "leg_4"), trunk=PEDESTAL)
    assert export(write("r.urdf", text)).summary[0] == (
        "free base (it has legs: leg_1, leg_2, leg_3, leg_4)"
    )


def test_a_driven_pendulum_is_not_a_wheel(write):
    base = link("trunk", INERTIAL)
    swing = f'<origin xyz="0 0 1"/>{LEVEL}'
    text = robot(
        base, link("end", LEG), joint("left", "trunk", "end", "continuous", swing), DRIVEN[0]
    )
    assert not is_free(export(write("r.urdf", text)))


@pytest.mark.parametrize(("base", "cone"), [("free", "elliptic"), ("fixed", None)])
def test_contacts_of_a_free_base_have_elliptic_cones(write, base, cone):
    path = write("r.urdf", quadruped())
    assert tree(export(path, base=base)).find("option").get("cone") == cone
    own = '<mujoco><option cone="pyramidal"/></mujoco></robot>'
    path = write("s.urdf", quadruped().replace("</robot>", own))
    assert tree(export(path, base=base)).find("option").get("cone") == "pyramidal"


@pytest.mark.corpus
@pytest.mark.parametrize(
    ("path", "free"),
    [
        ("ROBOTIS-GIT__turtlebot3/turtlebot3_description/urdf/turtlebot3_burger.urdf", True),
        ("ros2__urdf/urdf/test/test_robot.urdf", True),
        ("TheRobotStudio__SO-ARM100/Simulation/SO100/so100.urdf", False),
        ("frankaemika__franka_description/robots/fr3/fr3.urdf.xacro", False),
        ("frankaemika__franka_description/robots/multi_arm/multi_arm.urdf.xacro", False),
    ],
)
def test_real_robots(path, free):
    from tests.conftest import CORPUS
    from urdftool.formats.common.base import decide_base
    from urdftool.formats.common.home_positions import choose_home_positions
    from urdftool.formats.common.shape_box import ShapeBoxes
    from urdftool.formats.mjcf.structure import create_structure
    from urdftool.formats.written import Written
    from urdftool.model.load import load

    made, written = load(CORPUS / path), Written("x")
    structure = create_structure(made)
    home = choose_home_positions(made, {}, "", None, written).values
    assert decide_base(structure, "auto", None, ShapeBoxes(made), home, written)[0] == free


def test_a_body_without_joints_that_is_named_like_a_foot_is_fixed(write):
    written = export(write("r.urdf", robot(link("left_foot", TRUNK))))
    assert tree(written).find(".//freejoint") is None
