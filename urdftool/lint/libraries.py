"""Libraries by which Python code reads robots, and the calls in them that compute dynamics."""

from __future__ import annotations

from typing import NamedTuple

CHAIN = "kinematic chains"
"""Readers that take joints and their limits: no masses, no shapes."""

SCENE = "kinematics and shapes"
"""Readers that take joints, and shapes at their places: no masses, no motion."""

PLANNER = "kinematics and collisions"
"""Readers that take joints and collide shapes: no masses, no motion."""

TESSERACT = "tesseract"
"""Tesseract, which plans with URDF and an SRDF of its own."""

OWN = "code of the project"
"""Code that reads URDF as XML by itself, and takes no inertia from it."""

READERS = {
    **dict.fromkeys(("mujoco", "mujoco_py", "dm_control", "robosuite", "brax"), "mujoco"),
    **dict.fromkeys(("mujoco_warp", "mujoco_playground", "gymnasium_robotics"), "mujoco"),
    **dict.fromkeys(("mink", "mjpl"), "mujoco"),
    **dict.fromkeys(("pybullet", "pybullet_utils", "pybullet_data", "pybullet_envs"), "pybullet"),
    "pybullet_planning": "pybullet",
    **dict.fromkeys(("pinocchio", "crocoddyl", "tsid", "pink", "placo"), "pinocchio"),
    **dict.fromkeys(("jiminy_py", "gym_jiminy"), "pinocchio"),
    "pydrake": "drake",
    "newton": "newton",
    **dict.fromkeys(("hpp", "pyhpp", "hppfcl", "coal", "gepetto"), "pinocchio"),
    **dict.fromkeys(("ikpy", "kinpy", "pytorch_kinematics", "tracikpy", "pypot"), CHAIN),
    **dict.fromkeys(("yourdfpy", "urdfpy", "urchin", "skrobot", "klampt"), SCENE),
    "pytransform3d": SCENE,
    **dict.fromkeys(("pyroki", "vamp", "curobo", "compas_fab", "compas_robots"), PLANNER),
    **dict.fromkeys(("tesseract_robotics", "tesseract_planning"), TESSERACT),
}
"""Reader, as effects name it, of each library."""

OF_ROS = frozenset(
    (
        *("rclpy", "rospy", "moveit_commander", "moveit", "moveit_msgs"),
        *("launch_ros", "roslaunch", "tf2_ros", "sensor_msgs"),
        *("scenario", "gym_ignition", "gz"),
    )
)
"""Libraries of ROS and Gazebo, without those that only find packages."""

OTHER_ENGINES = frozenset(
    (
        *("isaacgym", "isaacsim", "isaaclab", "omni", "genesis", "sapien", "mani_skill", "dartpy"),
        *("raisimpy", "jaxsim", "idyntree", "roboticstoolbox", "chrono", "pychrono", "adam"),
    )
)
"""Libraries of dynamics and simulators, whose behavior few effects describe."""

WORDS = frozenset(
    (
        *("adam", "chrono", "genesis", "gz", "newton", "omni", "pink", "scenario", "moveit"),
        *("pyroki", "urchin", "coal", "hpp", "vamp", "mink"),
    )
)
"""Names of libraries that are words too: only where a line imports them."""

GYM = frozenset(("gym", "gymnasium"))
"""Libraries of environments, which step their simulation."""

_KINEMATIC = frozenset(
    (
        *("hpp", "pyhpp", "hppfcl", "coal", "gepetto", "pink", "mink", "mjpl"),
        *("pybullet_data", "pybullet_utils", "pybullet_planning"),
        *(name for name, of in READERS.items() if of in (CHAIN, SCENE, PLANNER, TESSERACT)),
    )
)
"""Libraries that compute no dynamics by themselves."""


class Calls(NamedTuple):
    """Names that code calls in a library, or reads from it.

    Attributes:
        dynamics: What depends on masses, inertias and drives.
        kinematics: What depends on poses alone, and shows that code uses the library for that;
            empty if code with no name of dynamics does.
    """

    dynamics: frozenset[str]
    kinematics: frozenset[str] = frozenset()


_PYBULLET_STEPS = frozenset(("stepSimulation", "setRealTimeSimulation"))
"""What moves the bodies of PyBullet, unless code places them itself."""

_CALLS = {
    "mujoco": Calls(
        frozenset(
            (
                *("mj_step", "mj_step1", "mj_step2", "mj_inverse", "mj_rne", "mj_crb", "mj_fullM"),
                *("mj_mulM", "mj_solveM", "mj_Euler", "mj_RungeKutta", "mj_implicit", "rollout"),
                *("mj_rnePostConstraint", "mj_fwdActuation", "mj_fwdAcceleration", "qfrc_bias"),
                *("qfrc_inverse", "qfrc_applied", "xfrc_applied", "mj_applyFT", "mjx", "MujocoEnv"),
                *("do_simulation", "subtree_com", "mj_jacSubtreeCom", "viewer.launch", "body_mass"),
                *("body_inertia", "actuator_forcerange", "viewer.launch_from_path"),
            )
        ),
        frozenset(
            (
                *("mj_forward", "mj_kinematics", "mj_fwdPosition", "mj_jac", "mj_jacBody", "mink"),
                *(
                    "mj_jacSite",
                    "mj_jacBodyCom",
                    "mj_geomDistance",
                    "mj_comPos",
                    "mj_fwdKinematics",
                ),
                *("mj_collision", "mjpl"),
            )
        ),
    ),
    "pybullet": Calls(
        frozenset(
            (
                *("setJointMotorControl", "setJointMotorControl2", "setJointMotorControlArray"),
                *("setJointMotorControlMultiDof", "setJointMotorControlMultiDofArray"),
                *("applyExternalForce", "applyExternalTorque", "calculateInverseDynamics"),
                *("calculateMassMatrix", "changeDynamics", "createConstraint"),
                *("resetBaseVelocity", "getDynamicsInfo"),
            )
        ),
        frozenset(("resetJointState", "resetJointStates", "calculateInverseKinematics")),
    ),
    "pydrake": Calls(
        frozenset(
            (
                *("Simulator", "AdvanceTo", "MakeHardwareStation", "CalcInverseDynamics"),
                *("CalcMassMatrix", "CalcMassMatrixViaInverseDynamics", "InverseDynamics"),
                *("InverseDynamicsController", "CalcBiasTerm", "CalcCenterOfMassPositionInWorld"),
                *("CalcGravityGeneralizedForces", "LinearQuadraticRegulator", "CalcTotalMass"),
                *("DirectCollocation", "DirectTranscription", "JointStiffnessController"),
            )
        ),
        frozenset(
            (
                *(
                    "InverseKinematics",
                    "KinematicTrajectoryOptimization",
                    "IrisInConfigurationSpace",
                ),
                *("CalcRelativeTransform", "EvalBodyPoseInWorld", "CalcPointsPositions"),
                *("GcsTrajectoryOptimization", "CalcJacobianSpatialVelocity", "CalcJacobian"),
            )
        ),
    ),
    "pinocchio": Calls(
        frozenset(
            (
                *("rnea", "aba", "crba", "ccrba", "dccrba", "computeAllTerms", "computeMinverse"),
                *("nonLinearEffects", "computeGeneralizedGravity", "computeCentroidalMap"),
                *("computeCentroidalMomentum", "computeCentroidalMomentumTimeVariation"),
                *("centerOfMass", "forwardDynamics", "constraintDynamics", "inertias"),
                *("computeRNEADerivatives", "computeABADerivatives", "computeTotalMass"),
                *("computeJointTorqueRegressor", "computeStaticRegressor", "jacobianCenterOfMass"),
                *("computeKineticEnergy", "computePotentialEnergy", "computeStaticTorque"),
                *("computeMechanicalEnergy", "computeCoriolisMatrix", "bodyRegressor"),
            )
        )
    ),
    "placo": Calls(
        frozenset(
            (
                *("DynamicsSolver", "add_com_task", "com_world", "mass_matrix", "total_mass"),
                *("generalized_gravity", "static_gravity_compensation_torques", "HumanoidRobot"),
                *("WalkPatternGenerator", "LIPM", "torques_from_acceleration_with_fixed_frame"),
            )
        )
    ),
    "klampt": Calls(
        frozenset(("Simulator", "getMass", "getGravityForces", "getMassMatrix", "getCom"))
    ),
}
"""Names of libraries that are used with dynamics and without."""

_POSES = _CALLS["pybullet"].kinematics

NAMES_OF_CALLS = _PYBULLET_STEPS.union(*(names for of in _CALLS.values() for names in of))
"""All names that tell whether code computes dynamics."""


def find_moving_readers(used: frozenset[str], called: frozenset[str]) -> frozenset[str]:
    """Return the readers by which code computes dynamics, also those of which that is not known.

    Args:
        used: Libraries that it imports or names.
        called: Names in it.
    """
    moving = set()
    for name in used & READERS.keys():
        calls = _CALLS.get(name)
        if name in _KINEMATIC and calls is None:
            continue
        if calls is None or called & calls.dynamics:
            moving.add(READERS[name])
        elif name == "pybullet" and called & _PYBULLET_STEPS:
            if not called & _POSES or used & GYM:
                moving.add("pybullet")
        elif calls.kinematics and not called & calls.kinematics:
            moving.add(READERS[name])
    return frozenset(moving)
