"""Rules on unknown elements in ``<gazebo>`` blocks."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import GazeboExtension, Robot
from ...model.sdf_schema import get_children
from ...source.document import Element
from ..fix import FixContext, Proposal, find_element, rename_element, unsafe
from ..rule import ERROR, UNSAFE, WARNING, Problem, rule
from ..words import find_nearest, fold, split_words
from .keywords import JOINT_KEYWORDS, KEYWORDS, LINK_KEYWORDS, ROBOT_KEYWORDS

APPLIES_TO = ("gazebo",)

_REMEDIES = {
    "mu": "write <mu1> and <mu2>",
    "friction": "write <mu1> and <mu2>, or <collision><surface><friction>…",
    "surface": "write it inside <collision>",
    "ode": "write it inside <collision><surface>",
    "color": "write <material>, or <visual><material><diffuse>",
    "restitution": "write <collision><surface><bounce><restitution_coefficient>",
}

_RENAMED = {
    "friction1": "mu1",
    "friction2": "mu2",
    "color": "material",
    "turnOffGravity": "turnGravityOff",
}


@rule(
    WARNING,
    effects={
        "gz, gazebo-classic": "copy it unchanged into the SDF; the default applies",
    },
)
def unknown_extension(robot: Robot) -> Iterator[Problem]:
    """A ``<gazebo>`` block contains an unknown element.

    Gazebo reads about thirty keywords and the elements of SDF; it copies others into the model and
    ignores them. With ``<mu>`` or ``<Mu1>`` the friction stays 1, and ``<updateRate>`` in a sensor
    does not set its rate. The finding is an error if the intended element is clear. In sensors, and
    in plugins with known parameters, only misspelled elements are reported, because plugins may
    have any parameters.
    """
    unknown: dict[str, list[tuple[str, GazeboExtension, Element]]] = {}
    for block in robot.gazebo:
        known, parent = _get_known_elements(robot, block)
        for child in block.element.children:
            tag = child.tag
            if tag == "sensor":
                yield from _check_sdf(child)
            elif tag == "plugin":
                yield from _check_plugin(child)
            elif tag == "ros2_control":
                continue  # ros2-control-nested reports it
            elif parent and tag not in known and tag not in KEYWORDS and ":" not in tag:
                problem = _report_misspelled(block, child, known, parent)
                if problem is not None:
                    yield problem
                else:
                    unknown.setdefault(tag, []).append((parent, block, child))
    for tag, found in unknown.items():
        parent, block, child = found[0]
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        yield Problem(
            block.element,
            f"<{tag}>{more} is not an element for a {parent} in Gazebo, which ignores it; "
            "remove it",
            at=child,
            data={"count": len(found)},
        )


@unknown_extension.fix(UNSAFE, reveals=True)
def write_known_element(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the element that Gazebo reads."""
    element, word = find_element(problem), problem.data.get("write", "")
    if element is None or not word.replace("_", "").isalnum():
        return None
    if element.parent is None or element.parent.find_child(word) is not None:
        return None
    return unsafe(f"write <{word}>", rename_element(element, word))


def _get_known_elements(robot: Robot, block: GazeboExtension) -> tuple[frozenset[str], str]:
    """Get the elements that a block may contain, and the SDF element that it is copied to."""
    name = block.reference
    if not name:
        return ROBOT_KEYWORDS | _get_children("model"), "model"
    if name in robot.link:
        known = LINK_KEYWORDS | _get_children("link")
        both = JOINT_KEYWORDS | _get_children("joint") if name in robot.joint else frozenset()
        return known | both, "link"
    if name in robot.joint:
        return JOINT_KEYWORDS | _get_children("joint"), "joint"
    return frozenset(), ""


def _get_children(tag: str) -> frozenset[str]:
    return get_children(tag) or frozenset()


def _report_misspelled(
    block: GazeboExtension, child: Element, known: frozenset[str], parent: str
) -> Problem | None:
    """Report a misspelled element; None if no similar element is known."""
    tag = child.tag
    instead, right = _REMEDIES.get(tag, ""), _RENAMED.get(tag, "")
    if not instead and not right:
        right = _suggest_element(tag, known | KEYWORDS)
    if not instead and not right:
        return None
    return Problem(
        block.element,
        f"<{tag}> is not an element for a {parent} in Gazebo; {instead or f'write <{right}>'}",
        at=child,
        severity=ERROR,
        data={"write": right} if right else {},
    )


def _check_sdf(element: Element) -> Iterator[Problem]:
    """Report misspelled elements in a sensor and its descendants."""
    known = get_children(element.tag)
    for child in element.children:
        if child.tag == "plugin":
            yield from _check_plugin(child)
            continue
        if known is not None and child.tag not in known and ":" not in child.tag:
            near = _suggest_element(child.tag, known)
            if near:
                yield Problem(
                    element,
                    f"<{element.tag}> has the unknown element <{child.tag}>; write <{near}>",
                    at=child,
                    severity=ERROR,
                    data={"write": near},
                )
                continue
        yield from _check_sdf(child)


def _check_plugin(plugin: Element) -> Iterator[Problem]:
    library = (plugin.get("filename") or "").rpartition("/")[2]
    if not library.startswith(LIBRARIES):
        return
    for child in plugin.children:
        tag = child.tag
        if tag in PARAMETERS or ":" in tag or len(tag) < 5:
            continue
        near = find_nearest(tag, PARAMETERS, 0.86)
        if near and fold(near) != fold(tag) and not _is_variant(tag, near):
            yield Problem(
                plugin,
                f"plugin '{plugin.get('name') or library}' has the unknown parameter <{tag}>; "
                f"write <{near}>",
                at=child,
                data={"write": near},
            )


def _is_variant(tag: str, near: str) -> bool:
    """Tell whether two words differ by a number, a plural or an additional word."""
    a, b = fold(tag), fold(near)
    letters = "".join(c for c in a if not c.isdigit()), "".join(c for c in b if not c.isdigit())
    if letters[0] == letters[1] or a.startswith(b) or b.startswith(a):
        return True
    return a.endswith(b) or b.endswith(a) or abs(len(a) - len(b)) > 1


def _suggest_element(tag: str, known: frozenset[str]) -> str:
    near = find_nearest(tag, known, 0.8)
    if near and fold(near) != fold(tag) and (len(tag) < 4 or abs(len(tag) - len(near)) > 2):
        return ""
    return near


PARAMETERS = split_words(
    # gazebo_ros for ROS 1
    "alwaysOn updateRate robotNamespace robotSimType robotParam controlPeriod legacyModeNS "
    "eStopTopic bodyName linkName frameName frameId topicName serviceName gaussianNoise "
    "initialOrientationAsReference rpyOffset rpyOffsets xyzOffset xyzOffsets localTwist "
    "commandTopic odometryTopic odometryFrame robotBaseFrame odometryRate odometrySource "
    "leftJoint rightJoint leftFrontJoint rightFrontJoint leftRearJoint rightRearJoint "
    "wheelSeparation wheelDiameter wheelTorque wheelAcceleration wheelBase torque broadcastTF "
    "publishWheelTF publishOdomTF publishTf publishOdom publishWheelJointState rosDebugLevel "
    "steeringJoint actuatedWheelJoint encoderWheelLeftJoint encoderWheelRightJoint "
    "actuatedWheelDiameter encoderWheelDiameter encoderWheelSeparation wheelSpeedTolerance "
    "steeringAngleTolerance steeringSpeed wheelDeceleration covariance_x covariance_y "
    "covariance_yaw cameraName imageTopicName cameraInfoTopicName hackBaseline distortionK1 "
    "distortionK2 distortionK3 distortionT1 distortionT2 focalLength autoDistortion "
    "triggerTopicName baseline Cx Cy CxPrime depthImageTopicName depthImageInfoTopicName "
    "depthImageCameraInfoTopicName pointCloudTopicName pointCloudCutoff pointCloudCutoffMax "
    "useDepth16UC1 borderCrop jointName jointNames mimicJoint multiplier offset maxEffort "
    "sensitiveness hasPID hokuyoMinIntensity bumperTopicName clock_topic velocityTopicName "
    "projectorTopicName textureTopicName filterTextureName textureName maxVelocity minForce "
    "maxUpdateRate "
    # hector_gazebo_plugins
    "accelOffset accelDrift accelDriftFrequency accelGaussianNoise rateOffset rateDrift "
    "rateDriftFrequency rateGaussianNoise headingOffset headingDrift headingGaussianNoise "
    "yawOffset yawDrift yawGaussianNoise biasTopic drift driftFrequency offset "
    "referenceLatitude referenceLongitude referenceAltitude referenceHeading status service "
    "fixTopicName "
    # gazebo_ros for ROS 2
    "ros namespace remapping argument update_rate robot_param robot_param_node robot_sim_type "
    "parameters controller_manager_name controller_manager_node_name hold_joints "
    "controller_manager_prefix_node_name position_proportional_gain joint_name left_joint "
    "right_joint num_wheel_pairs wheel_separation wheel_diameter wheel_radius "
    "max_wheel_torque max_wheel_acceleration command_topic odometry_topic odometry_frame "
    "robot_base_frame publish_odom publish_odom_tf publish_wheel_tf publish_rate frame_name "
    "body_name link_name output_type camera_name hack_baseline min_depth max_depth "
    "initial_orientation_as_reference gaussian_noise xyz_offset rpy_offset local_twist "
    "front_left_joint front_right_joint rear_left_joint rear_right_joint left_steering_joint "
    "right_steering_joint steering_wheel_joint max_steer max_speed left_steering_pid_gain "
    "right_steering_pid_gain linear_velocity_pid_gain steering_joint actuated_wheel_joint "
    "encoder_wheel_left_joint encoder_wheel_right_joint wheel_speed_tolerance "
    # gz sim
    "topic odom_topic tf_topic frame_id child_frame_id odom_publish_frequency "
    "odom_publisher_frequency odom_frame robot_base_frame dimensions min_velocity "
    "max_velocity min_acceleration max_acceleration min_jerk max_jerk min_linear_velocity "
    "max_linear_velocity min_angular_velocity max_angular_velocity min_linear_acceleration "
    "max_linear_acceleration min_angular_acceleration max_angular_acceleration "
    "linear_velocity angular_velocity wheel_base kingpin_width steering_limit steering_only "
    "use_actuator_msg actuator_number left_wheel_joint right_wheel_joint "
    "front_left_joint_name initial_velocity initial_position use_force_commands "
    "use_velocity_commands cmd_max cmd_min cmd_offset p_gain i_gain d_gain i_max i_min "
    "publish_link_pose publish_visual_pose publish_collision_pose publish_sensor_pose "
    "publish_model_pose publish_nested_model_pose use_pose_vector_msg static_publisher "
    "static_update_frequency update_frequency xyz_covariance engine "
    "render_enginelibgazebo_roslibhector_gazebolibroboticsgroupgz-sim-libgz-sim-ignition- "
    "gazebo-libignition-gazebo-gz_ros2_controlign_ros2_control "
)

LIBRARIES = (
    "libgazebo_ros",
    "libhector_gazebo",
    "libroboticsgroup",
    "gz-sim-",
    "libgz-sim-",
    "ignition-gazebo-",
    "libignition-gazebo-",
    "gz_ros2_control",
    "ign_ros2_control",
)
"""Prefixes of the libraries with these parameters."""
