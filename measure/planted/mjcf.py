"""Changes of the MJCF of the robot with everything."""

from __future__ import annotations

from .change import Edit, Planted, Root, add, both, drop, move, put, section

JOINT = "//worldbody//joint[@name='{}']"
BODY = "//body[@name='{}']"
SOLID = "//body[@name='{}']/geom[@class='collision']"
SEEN = "//body[@name='{}']/geom[@class='visual']"
ACTUATOR = "//actuator/*[@joint='{}']"
COUPLING = "//equality/joint[@joint1='right_finger_joint']"
PAIR = "//exclude[@body1='base_link' and @body2='forearm']"
OPTION = "/mujoco/option"

TETRAHEDRON = "0.5 0.5 0.5  0.5 -0.5 -0.5  -0.5 0.5 -0.5  -0.5 -0.5 0.5"
"""Corners of a tetrahedron in the box of the cube."""


def _in(path: str, name: str) -> str:
    return path.format(name)


def _home(place: int, value: str) -> Edit:
    """Set one number of the positions of the key."""

    def edit(root: Root) -> None:
        key = root.find("keyframe/key")
        words = key.get("qpos").split()
        assert words[place] != value
        words[place] = value
        key.set("qpos", " ".join(words))

    return edit


def _control(joint: str, value: str) -> Edit:
    """Set the control of a joint in the key."""

    def edit(root: Root) -> None:
        key = root.find("keyframe/key")
        words = key.get("ctrl").split()
        place = [element.get("joint") for element in root.find("actuator")].index(joint)
        assert words[place] != value
        words[place] = value
        key.set("ctrl", " ".join(words))

    return edit


CHANGES = (
    Planted("root held instead of free", "base", both(drop("//freejoint"), drop("//keyframe"))),
    Planted("root 5 m higher", "home", put(_in(BODY, "base_link"), "pos", "0 0 5")),
    Planted("root turned", "home", put(_in(BODY, "base_link"), "quat", "1 0 0 0.1")),
    Planted("body added", "base", add("//worldbody", "<body name='x'><geom size='1'/></body>")),
    Planted(
        "link lost", "mass", both(drop(_in(BODY, "camera_link")), drop("//sensor/rangefinder"))
    ),
    Planted(
        "joint lost",
        "tree",
        both(
            drop(_in(JOINT, "left_wheel_joint")),
            drop("//numeric[@name='left_wheel_joint_velocity_limit']"),
            drop(_in(ACTUATOR, "left_wheel_joint")),
            drop("//keyframe"),
        ),
    ),
    Planted("hinge for a slide", "tree", drop(_in(JOINT, "left_finger_joint"), "type")),
    Planted("link on another parent", "mass", move(_in(BODY, "caster"), _in(BODY, "upper_arm"))),
    Planted("mimic lost", "tree", drop(COUPLING)),
    Planted("mimic inactive", "tree", put(COUPLING, "active", "false")),
    Planted("mimic made soft", "defaults", put(COUPLING, "solref", "0.5 1")),
    Planted("multiplier of mimic", "tree", put(COUPLING, "polycoef", "-0.001 -1 0 0 0")),
    Planted(
        "mimic the other way round",
        "tree",
        both(
            put(COUPLING, "joint2", "right_finger_joint"),
            put("//equality/joint[@joint2='right_finger_joint']", "joint1", "left_finger_joint"),
        ),
    ),
    Planted(
        "joint held by an equality",
        "limits",
        add("//equality", "<joint joint1='shoulder' polycoef='0 0 0 0 0'/>"),
    ),
    Planted(
        "two links welded",
        "defaults",
        add("//equality", "<weld body1='left_finger' body2='base_link'/>"),
    ),
    Planted("link moved by 1 µm", "frames", put(_in(BODY, "imu_link"), "pos", "0.050001 0.02 0.1")),
    Planted("link turned", "frames", put(_in(BODY, "camera_link"), "quat", "1 0 0.1 0")),
    Planted(
        "axis the other way round", "frames", put(_in(JOINT, "left_wheel_joint"), "axis", "0 0 -1")
    ),
    Planted(
        "mass by 0.01 %", "centroid", put(_in(BODY, "upper_arm") + "/inertial", "mass", "2.50025")
    ),
    Planted(
        "center of mass by 1 µm",
        "centroid",
        put(_in(BODY, "forearm") + "/inertial", "pos", "0 0 0.150001"),
    ),
    Planted(
        "moment of inertia of a wheel",
        "mass matrix",
        put(_in(BODY, "left_wheel") + "/inertial", "diaginertia", "0.0022 0.0022 0.00401"),
    ),
    Planted("upper limit by 1e-6", "limits", put(_in(JOINT, "elbow"), "range", "-2 2.100001")),
    Planted("limits lost", "limits", drop(_in(JOINT, "shoulder"), "range")),
    Planted("effort bound lost", "effort", drop(_in(JOINT, "shoulder"), "actuatorfrcrange")),
    Planted("lower effort bound", "limits", put(_in(JOINT, "elbow"), "actuatorfrcrange", "-5 25")),
    Planted("damping lost", "joint physics", drop(_in(JOINT, "elbow"), "damping")),
    Planted(
        "friction of a joint", "joint physics", put(_in(JOINT, "elbow"), "frictionloss", "0.2")
    ),
    Planted("velocity number lost", "limits", drop("//numeric[@name='elbow_velocity_limit']")),
    Planted("spring lost", "joint physics", drop(_in(JOINT, "elbow"), "stiffness")),
    Planted(
        "spring reference reversed", "joint physics", put(_in(JOINT, "elbow"), "springref", "-0.4")
    ),
    Planted("armature added", "joint physics", put(_in(JOINT, "shoulder"), "armature", "0.1")),
    Planted("limit made soft", "joint physics", put(_in(JOINT, "elbow"), "solreflimit", "0.5 1")),
    Planted("margin of a limit", "joint physics", put(_in(JOINT, "elbow"), "margin", "0.2")),
    Planted("gravity of the moon", "world", put(OPTION, "gravity", "0 0 -1.62")),
    Planted("wind", "world", put(OPTION, "wind", "3 0 0")),
    Planted("water for air", "world", put(OPTION, "density", "1000")),
    Planted("time step", "world", put(OPTION, "timestep", "0.01")),
    Planted("limits switched off", "world", add(OPTION, "<flag limit='disable'/>")),
    Planted("gravity switched off", "world", add(OPTION, "<flag gravity='disable'/>")),
    Planted("gravity flag lost", "link flags", drop(_in(BODY, "upper_arm"), "gravcomp")),
    Planted(
        "gravity flag of another link",
        "link flags",
        put(_in(BODY, "left_wheel"), "gravcomp", "1"),
    ),
    Planted(
        "box for a cylinder",
        "collisions",
        both(
            put(_in(SOLID, "forearm"), "type", "box"),
            put(_in(SOLID, "forearm"), "size", "0.03 0.03 0.14"),
        ),
    ),
    Planted(
        "size of a collision by 1 %", "collisions", put(_in(SOLID, "caster"), "size", "0.0303")
    ),
    Planted("collision moved", "collisions", put(_in(SOLID, "forearm"), "pos", "0 0 0.16")),
    Planted("collision lost", "collisions", drop(_in(SOLID, "left_wheel"))),
    Planted("scale of a mesh", "collisions", put("//asset/mesh", "scale", "0.06 0.05 0.36")),
    Planted(
        "another mesh in the same box",
        "collisions",
        both(
            drop("//asset/mesh", "file"),
            put("//asset/mesh", "name", "cube"),
            put("//asset/mesh", "vertex", TETRAHEDRON),
        ),
    ),
    Planted("contact switched off", "world", add(OPTION, "<flag contact='disable'/>")),
    Planted(
        "no collision touches",
        "collisions",
        both(
            put("//default[@class='collision']/geom", "contype", "0"),
            put("//default[@class='collision']/geom", "conaffinity", "0"),
        ),
    ),
    Planted(
        "one collision touches nothing",
        "collisions",
        both(
            put(_in(SOLID, "caster"), "contype", "0"), put(_in(SOLID, "caster"), "conaffinity", "0")
        ),
    ),
    Planted(
        "mask of a collision",
        "surface",
        both(
            put(_in(SOLID, "caster"), "contype", "2"), put(_in(SOLID, "caster"), "conaffinity", "2")
        ),
    ),
    Planted("exclusion lost", "contact pairs", drop(PAIR)),
    Planted(
        "exclusion added",
        "contact pairs",
        add("//contact", "<exclude body1='left_wheel' body2='forearm'/>"),
    ),
    Planted(
        "visual touches",
        "collisions",
        both(
            put(_in(SEEN, "forearm"), "contype", "1"), put(_in(SEEN, "forearm"), "conaffinity", "1")
        ),
    ),
    Planted(
        "colliding geom added",
        "collisions",
        add(_in(BODY, "forearm"), "<geom size='0.2'/>", first=True),
    ),
    Planted("parents touch their children", "world", add(OPTION, "<flag filterparent='disable'/>")),
    Planted("friction lost", "surface", drop(_in(SOLID, "left_wheel"), "friction")),
    Planted(
        "friction by 1 %",
        "surface",
        put(_in(SOLID, "left_wheel"), "friction", "0.909 0.005 0.0001"),
    ),
    Planted("contact made soft", "surface", put(_in(SOLID, "caster"), "solref", "0.5 1")),
    Planted("contact without friction", "surface", put(_in(SOLID, "caster"), "condim", "1")),
    Planted("margin of a contact", "surface", put(_in(SOLID, "caster"), "margin", "0.01")),
    Planted(
        "actuator lost", "actuators", both(drop(_in(ACTUATOR, "shoulder")), drop("//keyframe"))
    ),
    Planted(
        "actuator on another joint",
        "actuators",
        put(_in(ACTUATOR, "shoulder"), "joint", "right_wheel_joint"),
    ),
    Planted("gear 1 for 50", "actuators", put(_in(ACTUATOR, "shoulder"), "gear", "1")),
    Planted("gain lost", "actuators", drop(_in(ACTUATOR, "elbow"), "kp")),
    Planted("damping of a servo", "actuators", put(_in(ACTUATOR, "elbow"), "dampratio", "0.5")),
    Planted(
        "range of control lost", "actuators", drop(_in(ACTUATOR, "left_finger_joint"), "ctrlrange")
    ),
    Planted(
        "lower bound of control",
        "actuators",
        put(_in(ACTUATOR, "left_finger_joint"), "ctrlrange", "-0.1 0.2"),
    ),
    Planted("bound of force added", "actuators", put(_in(ACTUATOR, "elbow"), "forcerange", "-1 1")),
    Planted(
        "actuator added",
        "actuators",
        both(
            section("actuator"),
            drop("//keyframe"),
            add("//actuator", "<motor joint='right_finger_joint'/>"),
        ),
    ),
    Planted("sensor lost", "sensors", drop("//sensor/gyro")),
    Planted("IMU 0.5 m off", "sensors", put("//site[@name='imu']", "pos", "0.5 0 0.01")),
    Planted("IMU on another link", "sensors", move("//site[@name='imu']", _in(BODY, "forearm"))),
    Planted("noise of a sensor", "defaults", put("//sensor/accelerometer", "noise", "0.1")),
    Planted("ray turned", "sensors", put("//site[@name='scan_2']", "quat", "1 0 1.1 0")),
    Planted("contact sensor lost", "sensors", drop("//sensor/touch")),
    Planted("camera moved", "sensors", put("//camera[@name='camera']", "pos", "0.1 0 0")),
    Planted("camera turned", "sensors", put("//camera[@name='camera']", "quat", "1 1 -1 -0.9")),
    Planted("field of view", "sensors", put("//camera[@name='camera']", "fovy", "45")),
    Planted(
        "resolution of a camera",
        "sensors",
        put("//camera[@name='camera']", "resolution", "320 240"),
    ),
    Planted("camera lost", "sensors", drop("//camera[@name='camera']")),
    Planted("light lost", "sensors", drop("//light")),
    Planted("light turned", "sensors", put("//light", "dir", "0 0 -1")),
    Planted("key lost", "home", drop("//key")),
    Planted("initial value lost", "home", _home(10, "0")),
    Planted("start beyond a limit", "configurations", _home(9, "1.5")),
    Planted("start above the floor", "home", _home(2, "1")),
    Planted("follower that does not follow", "configurations", _home(12, "-0.01")),
    Planted("control of the home position", "home", _control("elbow", "0")),
    Planted("visual lost", "visuals", drop(_in(SEEN, "caster"))),
    Planted("visual moved", "visuals", put(_in(SEEN, "forearm"), "pos", "0 0 0.16")),
    Planted(
        "texture lost",
        "materials",
        both(drop("//material[@name='checker']", "texture"), drop("//texture")),
    ),
    Planted(
        "color by 1 %", "materials", put("//material[@name='steel']", "rgba", "0.606 0.62 0.65 1")
    ),
    Planted("opacity lost", "materials", put("//material[@name='glass']", "rgba", "0.1 0.3 0.8 1")),
    Planted("color of Gazebo lost", "materials", drop(_in(SEEN, "forearm"), "rgba")),
    Planted(
        "mirror for steel", "materials", put("//material[@name='steel']", "reflectance", "0.9")
    ),
)
"""What is changed, and where it has to be named."""
