"""Changes of the SDF of the robot with everything."""

from __future__ import annotations

from .change import Edit, Planted, add, both, drop, move, put, say

MODEL = "/sdf/model"
LINK = "/sdf/model/link[@name='{}']"
JOINT = "/sdf/model/joint[@name='{}']"
SOLID = LINK + "/collision"
SEEN = LINK + "/visual"
DRIVE = "//plugin[contains(@filename, 'diff-drive')]"
POSES = "//plugin[contains(@filename, 'pose-publisher')]"
SENSOR = "//sensor[@name='{}']"


def _in(path: str, name: str) -> str:
    return path.format(name)


def _place(link: str, pose: str) -> Edit:
    """Place a link in the model's frame."""
    return both(
        drop(_in(LINK, link) + "/pose", "relative_to"), say(_in(LINK, link) + "/pose", pose)
    )


CHANGES = (
    Planted("model static", "base", add(MODEL, "<static>true</static>")),
    Planted("model 5 m higher", "base", add(MODEL, "<pose>0 0 5 0 0 0</pose>")),
    Planted(
        "root held by the world",
        "base",
        add(
            MODEL,
            "<joint name='a' type='fixed'><parent>world</parent><child>base_link</child></joint>",
        ),
    ),
    Planted(
        "fixed joint lost",
        "tree",
        both(drop(_in(JOINT, "caster_mount")), _place("caster", "0.25 0 -0.12 0 0 0")),
    ),
    Planted(
        "link kinematic", "link flags", add(_in(LINK, "upper_arm"), "<kinematic>true</kinematic>")
    ),
    Planted("model with wind", "link flags", add(MODEL, "<enable_wind>true</enable_wind>")),
    Planted(
        "joint lost",
        "tree",
        both(drop(_in(JOINT, "left_wheel_joint")), _place("left_wheel", "0 0.25 -0.05 -1.57 0 0")),
    ),
    Planted("prismatic for revolute", "tree", put(_in(JOINT, "elbow"), "type", "prismatic")),
    Planted("parent of a joint", "tree", say(_in(JOINT, "elbow") + "/parent", "base_link")),
    Planted("mimic lost", "tree", drop("//mimic")),
    Planted("multiplier of mimic", "tree", say("//mimic/multiplier", "-1")),
    Planted("leader of mimic", "tree", put("//mimic", "joint", "elbow")),
    Planted(
        "joint added",
        "loops",
        add(
            MODEL,
            "<joint name='more' type='revolute'><parent>caster</parent><child>forearm</child>"
            "<axis><xyz>0 0 1</xyz></axis></joint>",
        ),
    ),
    Planted(
        "link moved by 1 µm",
        "frames",
        say(_in(JOINT, "camera_joint") + "/pose", "0.310001 0 0.05 0 0.2 0"),
    ),
    Planted(
        "frame turned", "frames", say("//frame[@name='imu_joint']/pose", "0.05 0.02 0.1 0 0 1.3")
    ),
    Planted(
        "frame lost",
        "frames",
        both(
            drop("//frame[@name='imu_link']"),
            drop("//pose[@relative_to='imu_link']", "relative_to"),
        ),
    ),
    Planted(
        "axis the other way round",
        "axes",
        say(_in(JOINT, "left_wheel_joint") + "/axis/xyz", "0 0 -1"),
    ),
    Planted("mass by 0.01 %", "mass", say(_in(LINK, "upper_arm") + "/inertial/mass", "2.50025")),
    Planted(
        "center of mass by 1 µm",
        "center of mass",
        say(_in(LINK, "forearm") + "/inertial/pose", "0 0 0.150001 0 0 0"),
    ),
    Planted(
        "product of inertia lost",
        "inertia",
        say(_in(LINK, "base_link") + "/inertial/inertia/ixy", "0"),
    ),
    Planted(
        "moment of inertia of a wheel",
        "inertia",
        say(_in(LINK, "left_wheel") + "/inertial/inertia/izz", "0.00401"),
    ),
    Planted(
        "upper limit by 1e-6", "limits", say(_in(JOINT, "elbow") + "/axis/limit/upper", "2.100001")
    ),
    Planted(
        "limits lost",
        "limits",
        both(
            drop(_in(JOINT, "shoulder") + "/axis/limit/lower"),
            drop(_in(JOINT, "shoulder") + "/axis/limit/upper"),
        ),
    ),
    Planted(
        "effort without bound", "limits", say(_in(JOINT, "elbow") + "/axis/limit/effort", "-1")
    ),
    Planted("velocity by 1 %", "limits", say(_in(JOINT, "elbow") + "/axis/limit/velocity", "4.04")),
    Planted("damping lost", "joint physics", drop(_in(JOINT, "elbow") + "/axis/dynamics/damping")),
    Planted(
        "friction of a joint",
        "joint physics",
        say(_in(JOINT, "elbow") + "/axis/dynamics/friction", "0.2"),
    ),
    Planted(
        "spring lost",
        "joint physics",
        drop(_in(JOINT, "elbow") + "/axis/dynamics/spring_stiffness"),
    ),
    Planted(
        "spring reference reversed",
        "joint physics",
        say(_in(JOINT, "elbow") + "/axis/dynamics/spring_reference", "-0.4"),
    ),
    Planted(
        "stiffness of a limit",
        "joint physics",
        add(_in(JOINT, "elbow") + "/axis/limit", "<stiffness>1000</stiffness>"),
    ),
    Planted(
        "dissipation of a limit",
        "joint physics",
        add(_in(JOINT, "elbow") + "/axis/limit", "<dissipation>10</dissipation>"),
    ),
    Planted(
        "erp of a stop", "joint physics", say(_in(JOINT, "elbow") + "/physics/ode/limit/erp", "0.9")
    ),
    Planted(
        "feedback of a joint lost",
        "joint physics",
        drop(_in(JOINT, "elbow") + "/physics/provide_feedback"),
    ),
    Planted(
        "second axis", "other elements", add(_in(JOINT, "elbow"), "<axis2><xyz>0 0 1</xyz></axis2>")
    ),
    Planted("gravity flag lost", "link flags", drop(_in(LINK, "upper_arm") + "/gravity")),
    Planted(
        "gravity flag of another link",
        "link flags",
        add(_in(LINK, "left_wheel"), "<gravity>false</gravity>"),
    ),
    Planted(
        "damping of a link",
        "link flags",
        add(_in(LINK, "forearm"), "<velocity_decay><linear>0.1</linear></velocity_decay>"),
    ),
    Planted(
        "link with wind", "link flags", add(_in(LINK, "forearm"), "<enable_wind>true</enable_wind>")
    ),
    Planted(
        "box for a cylinder",
        "collisions",
        both(
            drop(_in(SOLID, "forearm") + "/geometry/cylinder"),
            add(_in(SOLID, "forearm") + "/geometry", "<box><size>0.06 0.06 0.28</size></box>"),
        ),
    ),
    Planted(
        "size of a collision by 1 %",
        "collisions",
        say(_in(SOLID, "caster") + "/geometry/sphere/radius", "0.0303"),
    ),
    Planted(
        "collision moved", "collisions", say(_in(SOLID, "forearm") + "/pose", "0 0 0.16 0 0 0")
    ),
    Planted("collision lost", "collisions", drop(_in(SOLID, "left_wheel"))),
    Planted(
        "collision added",
        "collisions",
        add(
            _in(LINK, "forearm"),
            "<collision name='more'><geometry><sphere><radius>0.2</radius></sphere>"
            "</geometry></collision>",
        ),
    ),
    Planted(
        "scale of a mesh", "collisions", say(_in(SOLID, "upper_arm") + "//scale", "0.06 0.05 0.36")
    ),
    Planted(
        "collision that touches nothing",
        "surface",
        add(
            _in(SOLID, "caster") + "/surface",
            "<contact><collide_bitmask>0</collide_bitmask></contact>",
        ),
    ),
    Planted(
        "collision of another category",
        "surface",
        add(
            _in(SOLID, "caster") + "/surface",
            "<contact><category_bitmask>2</category_bitmask></contact>",
        ),
    ),
    Planted(
        "collision without force",
        "surface",
        add(
            _in(SOLID, "caster") + "/surface",
            "<contact><collide_without_contact>true</collide_without_contact></contact>",
        ),
    ),
    Planted("self_collide lost", "link flags", drop(_in(LINK, "base_link") + "/self_collide")),
    Planted(
        "self_collide of another link",
        "link flags",
        add(_in(LINK, "forearm"), "<self_collide>true</self_collide>"),
    ),
    Planted("friction lost", "surface", drop(_in(SOLID, "left_wheel") + "//mu")),
    Planted("friction by 1 %", "surface", say(_in(SOLID, "left_wheel") + "//mu2", "0.909")),
    Planted("direction of friction", "surface", say(_in(SOLID, "left_wheel") + "//fdir1", "0 1 0")),
    Planted("stiffness of a contact lost", "surface", drop(_in(SOLID, "base_link") + "//kp")),
    Planted("damping of a contact", "surface", say(_in(SOLID, "base_link") + "//kd", "8")),
    Planted(
        "slip",
        "surface",
        add(_in(SOLID, "left_wheel") + "/surface/friction/ode", "<slip1>1</slip1>"),
    ),
    Planted(
        "bounce",
        "surface",
        add(
            _in(SOLID, "caster") + "/surface",
            "<bounce><restitution_coefficient>1</restitution_coefficient></bounce>",
        ),
    ),
    Planted(
        "one contact at most",
        "surface",
        add(_in(SOLID, "caster"), "<max_contacts>1</max_contacts>"),
    ),
    Planted("visual lost", "visuals", drop(_in(SEEN, "caster"))),
    Planted("visual moved", "visuals", say(_in(SEEN, "forearm") + "/pose", "0 0 0.16 0 0 0")),
    Planted(
        "color by 1 %",
        "colors",
        say(_in(SEEN, "left_wheel") + "/material/diffuse", "0.606 0.62 0.65 1"),
    ),
    Planted("texture lost", "textures", drop(_in(SEEN, "base_link") + "//pbr")),
    Planted("ambient lost", "looks", drop(_in(SEEN, "left_wheel") + "/material/ambient")),
    Planted("transparency lost", "looks", drop(_in(SEEN, "caster") + "/transparency")),
    Planted(
        "color of Gazebo", "colors", say(_in(SEEN, "forearm") + "/material/diffuse", "1 0 0 1")
    ),
    Planted("metal for a texture", "looks", say(_in(SEEN, "base_link") + "//metalness", "1")),
    Planted(
        "glow", "looks", add(_in(SEEN, "left_wheel") + "/material", "<emissive>1 1 1 1</emissive>")
    ),
    Planted(
        "no shadow", "looks", add(_in(SEEN, "left_wheel"), "<cast_shadows>false</cast_shadows>")
    ),
    Planted("sensor lost", "sensors", drop(_in(SENSOR, "imu"))),
    Planted("IMU 0.5 m off", "sensors", say(_in(SENSOR, "imu") + "/pose", "0.5 0 0.01 0 0 0")),
    Planted("IMU on another link", "sensors", move(_in(SENSOR, "imu"), _in(LINK, "forearm"))),
    Planted("rate of a sensor", "sensors", say(_in(SENSOR, "imu") + "/update_rate", "10")),
    Planted("noise of a sensor", "sensors", say(_in(SENSOR, "imu") + "//stddev", "0.02")),
    Planted("type of a sensor", "sensors", put(_in(SENSOR, "scan"), "type", "lidar")),
    Planted("rays of a scanner", "sensors", say(_in(SENSOR, "scan") + "//samples", "50")),
    Planted("field of view", "sensors", say(_in(SENSOR, "camera") + "//horizontal_fov", "1")),
    Planted("image of a camera", "sensors", say(_in(SENSOR, "camera") + "//width", "320")),
    Planted("camera moved", "sensors", add(_in(SENSOR, "camera"), "<pose>0.1 0 0 0 0 0</pose>")),
    Planted("force-torque sensor lost", "sensors", drop(_in(SENSOR, "wrist_force"))),
    Planted(
        "frame of a force-torque sensor",
        "sensors",
        say(_in(SENSOR, "wrist_force") + "//frame", "parent"),
    ),
    Planted(
        "contact sensor watches another collision",
        "sensors",
        say(_in(SENSOR, "bumper") + "//collision", "base_link_hull"),
    ),
    Planted("topic added", "sensors", add(_in(SENSOR, "imu"), "<topic>elsewhere</topic>")),
    Planted("plugin lost", "plugins", drop(POSES)),
    Planted("drive lost", "plugins", drop(DRIVE)),
    Planted("parameter of a plugin", "plugins", say(POSES + "/update_frequency", "2")),
    Planted("parameter of a plugin lost", "plugins", drop(POSES + "/publish_link_pose")),
    Planted("wheel of a drive", "plugins", say(DRIVE + "/left_joint", "right_wheel_joint")),
    Planted("diameter for a radius", "plugins", say(DRIVE + "/wheel_radius", "0.2")),
    Planted("class of a plugin", "plugins", put(POSES, "name", "gz::sim::systems::Other")),
    Planted("plugin added", "plugins", add(MODEL, "<plugin name='a' filename='b'/>")),
    Planted("light lost", "other elements", drop("//light")),
    Planted("light moved", "other elements", say("//light/pose", "0 0 0.5 0 0 0")),
    Planted("color of a light", "other elements", say("//light/diffuse", "0 0 1 1")),
    Planted(
        "nested model added", "tree", add(MODEL, "<model name='more'><link name='a'/></model>")
    ),
)
"""What is changed, and where it has to be named."""
