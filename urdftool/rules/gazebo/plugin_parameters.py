"""Parameters of plugins of gazebo_ros and gz sim, to find misspelled ones.

The list is not complete, so an unknown parameter is only reported if it is similar to a known one.
"""

from __future__ import annotations

from ..words import split_words

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
