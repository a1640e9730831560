"""Which rules have fixes, and where: what may be known of them without importing them.

A fix is *safe* if everything that reads the robot has the same kinematics, masses, inertia,
collision shapes, limits and control afterwards, or could not read them before;
``tests/lint/test_fix_safe.py`` loads robots before and after. All others are *unsafe*: they invent
or remove physics, guess what was meant, change what one reader loads, or take comments away. Some
rules have both, depending on the case. Rules of the file ``mesh_files`` write meshes, which an
option of its own asks for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..model.elements import Robot, Vector
    from ..model.tensor3 import Six

    Weigh = Callable[[Robot, Sequence[str]], "dict[str, tuple[float, Vector, Six]]"]
else:
    Weigh = Callable

SAFE, UNSAFE, BOTH = "safe", "unsafe", "safe or unsafe"

OPTIONS = {
    SAFE: "safe (--fix)",
    UNSAFE: "unsafe (--fix --unsafe-fixes)",
    BOTH: "safe (--fix) in some cases, unsafe (--fix --unsafe-fixes) in others",
}
"""Applicability with what applies it."""

FIXES: dict[str, dict[str, str]] = {
    "failures": {
        "not-well-formed": SAFE,
        "content-before-declaration": SAFE,
        "missing-xmlns": SAFE,
        "unknown-macro": UNSAFE,
        "undeclared-arg": UNSAFE,
        "include-not-found": BOTH,
        "non-boolean-conditional": UNSAFE,
        "unknown-rule": UNSAFE,
        "unused-suppression": SAFE,
    },
    "xml": {
        "missing-name": UNSAFE,
        "unknown-element": BOTH,
        "unknown-attribute": BOTH,
        "wrong-case-keyword": BOTH,
        "repeated-element": BOTH,
        "several-shapes-in-geometry": UNSAFE,
        "empty-geometry": UNSAFE,
        "wrong-arity": BOTH,
        "not-a-number": UNSAFE,
        "tab-or-newline-in-vector": UNSAFE,
        "padded-reference": BOTH,
        "unsupported-urdf-version": UNSAFE,
        "feature-needs-newer-version": UNSAFE,
        "rpy-and-quat": UNSAFE,
    },
    "xacro": {
        "nonstandard-xmlns": SAFE,
        "unprefixed-xacro-tag": UNSAFE,
        "unexpanded-expression": UNSAFE,
        "bad-substitution-command": SAFE,
        "deprecated-global-function": SAFE,
        "unused-arg": UNSAFE,
        "unused-property": UNSAFE,
        "unused-macro": UNSAFE,
        "hard-coded-name-in-macro": UNSAFE,
        "shadowed-builtin": UNSAFE,
    },
    "tree": {
        "unknown-parent-link": BOTH,
        "unknown-child-link": UNSAFE,
        "duplicate-joint-name": UNSAFE,
        "conflicting-material": BOTH,
    },
    "joint": {
        "unknown-joint-type": UNSAFE,
        "redundant-on-fixed": SAFE,
        "axis-not-unit": UNSAFE,
        "axis-omitted": SAFE,
        "axis-nearly-canonical": UNSAFE,
        "rpy-in-degrees": UNSAFE,
        "missing-limit": UNSAFE,
        "limit-without-effort-or-velocity": BOTH,
        "limit-without-bounds": UNSAFE,
        "continuous-with-bounds": UNSAFE,
        "lower-above-upper": UNSAFE,
        "locked-by-limits": UNSAFE,
        "limit-in-degrees": UNSAFE,
        "prismatic-in-millimetres": UNSAFE,
        "limit-rounded-outward": UNSAFE,
        "negative-limit": UNSAFE,
        "negative-dynamics": UNSAFE,
        "empty-dynamics": SAFE,
        "dynamics-as-child-elements": UNSAFE,
        "mimic-unknown-joint": UNSAFE,
        "mimic-chain": UNSAFE,
        "mimic-limits-inconsistent": UNSAFE,
        "soft-limits-lock-joint": UNSAFE,
        "soft-limits-outside-hard": UNSAFE,
    },
    "inertia": {
        "missing-inertial": UNSAFE,
        "massless-moving-body": UNSAFE,
        "preserved-joint-massless": UNSAFE,
        "root-link-has-inertia": UNSAFE,
        "incomplete-inertial": UNSAFE,
        "negative-mass": UNSAFE,
        "inertia-not-positive-definite": UNSAFE,
        "inertia-triangle-inequality": UNSAFE,
        "inertia-triangle-inequality-rounding": UNSAFE,
        "zero-inertia": UNSAFE,
        "singular-inertia": UNSAFE,
        "inertia-component-slip": UNSAFE,
        "inertia-off-by-power-of-ten": UNSAFE,
        "redundant-inertia-attributes": SAFE,
        "placeholder-inertia": UNSAFE,
        "inertia-exceeds-geometry": UNSAFE,
        "inertial-not-at-com-suspect": UNSAFE,
        "inertia-about-link-frame": UNSAFE,
        "com-not-mirrored": UNSAFE,
        "radius-of-gyration": UNSAFE,
    },
    "shapes": {
        "missing-collision": UNSAFE,
        "odd-link-without-collision": UNSAFE,
        "missing-visual": UNSAFE,
        "collision-off-visual": UNSAFE,
        "collision-mesh-displaced": UNSAFE,
        "unsupported-shape": UNSAFE,
        "shape-in-millimetres": UNSAFE,
        "wheel-cylinder-axis": UNSAFE,
        "caster-height-mismatch": UNSAFE,
        "invalid-color": UNSAFE,
        "fully-transparent": UNSAFE,
        "empty-material-name": BOTH,
        "unused-material": BOTH,
        "mesh-in-millimetres": UNSAFE,
        "mesh-scaled-twice": UNSAFE,
        "optical-frame-orientation": UNSAFE,
    },
    "mesh": {
        "mesh-case-mismatch": SAFE,
        "malformed-uri": SAFE,
        "absolute-path": UNSAFE,
        "relative-uri-in-ros": UNSAFE,
        "wrong-package-in-uri": UNSAFE,
        "package-uri-unresolvable": UNSAFE,
        "mujoco-missing-compiler": UNSAFE,
    },
    "mesh_files": {
        "ascii-stl": BOTH,
        "binary-stl-starts-with-solid": SAFE,
        "inverted-mesh": UNSAFE,
        "degenerate-triangles": UNSAFE,
        "dae-as-collision": UNSAFE,
        "unsupported-mesh-format": UNSAFE,
        "mirrored-scale": UNSAFE,
        "unsafe-file-name": UNSAFE,
        "mesh-stem-collision": UNSAFE,
    },
    "package": {
        "undeclared-mesh-dependency": SAFE,
        "gazebo-path-not-exported": BOTH,
        "directory-not-installed": UNSAFE,
        "obsolete-cli-option": SAFE,
    },
    "gazebo": {
        "missing-gazebo-tags": UNSAFE,
        "missing-gazebo-material": SAFE,
        "ogre-material-script": SAFE,
        "missing-friction": UNSAFE,
        "missing-contact-parameters": UNSAFE,
        "dangling-reference": UNSAFE,
        "misplaced-extension": UNSAFE,
        "unknown-extension": UNSAFE,
        "bad-extension-number": SAFE,
        "half-friction": UNSAFE,
        "deprecated-cfm-damping": SAFE,
        "no-effect-in-gz": UNSAFE,
        "lumped-joint-loses-content": UNSAFE,
        "lumped-flag-leaks": UNSAFE,
        "named-geometry-loses-extensions": UNSAFE,
        "lumped-link-referenced": UNSAFE,
        "surface-without-collision": UNSAFE,
        "root-not-anchored": UNSAFE,
        "missing-control-plugin": UNSAFE,
        "unknown-sensor-type": UNSAFE,
        "cpu-ray-in-gz": UNSAFE,
        "ros-plugin-inside-sensor": UNSAFE,
        "missing-gz-frame-id": SAFE,
        "duplicate-sensor-name": UNSAFE,
        "duplicate-plugin-name": UNSAFE,
        "camera-sensor-not-optical": UNSAFE,
    },
    "migration": {
        "ros1-transmission-in-ros2": UNSAFE,
        "mujoco-welds-root": UNSAFE,
    },
    "plugins": {
        "classic-plugin-in-gz": UNSAFE,
        "ignition-name": UNSAFE,
        "plugin-class-mismatch": SAFE,
        "plugin-unknown-entity": UNSAFE,
        "ros2-control-sim-plugin-pair": UNSAFE,
    },
    "control": {
        "transmission-unknown-joint": UNSAFE,
        "unprefixed-hardware-interface": SAFE,
        "missing-hardware-interface": UNSAFE,
        "unknown-hardware-interface": UNSAFE,
        "duplicate-transmission": UNSAFE,
        "transmission-on-immovable-joint": UNSAFE,
        "actuated-joint-without-transmission": UNSAFE,
        "ros2-control-unknown-joint": UNSAFE,
        "ros2-control-fixed-joint": UNSAFE,
        "ros2-control-mimic": UNSAFE,
        "ros2-control-legacy-mimic-param": UNSAFE,
        "ros2-control-duplicate-interface": UNSAFE,
        "nonstandard-interface-name": UNSAFE,
        "command-without-state": UNSAFE,
        "joint-outside-ros2-control": UNSAFE,
        "ros2-control-invalid-tag": UNSAFE,
        "ros2-control-nested": BOTH,
        "ros2-control-wrong-sim-plugin": UNSAFE,
        "ros2-control-unknown-imu-interface": UNSAFE,
        "controller-unknown-joint": UNSAFE,
        "controller-parameter-type": SAFE,
    },
    "renames": {
        "link-joint-name-clash": UNSAFE,
        "invalid-frame-name": UNSAFE,
        "reserved-name": UNSAFE,
        "not-portable-identifier": UNSAFE,
        "name-style": UNSAFE,
        "non-ascii-name": UNSAFE,
    },
    "moveit": {
        "moveit-parameter-type": SAFE,
        "moveit-controller-incomplete": UNSAFE,
        "srdf-robot-name": SAFE,
        "srdf-unknown-link": UNSAFE,
        "srdf-unknown-joint": UNSAFE,
        "group-state-out-of-bounds": UNSAFE,
        "missing-virtual-joint": UNSAFE,
        "adjacent-pair-not-disabled": UNSAFE,
    },
    "names": {
        "colon-space-in-comment": UNSAFE,
        "duplicate-geometry-name": UNSAFE,
    },
}
"""Applicability by rule, by the file in ``fixes``."""

FIXABLE = {rule: how for rules in FIXES.values() for rule, how in rules.items()}
"""Applicability by rule."""

FIX_FILE = {rule: file for file, rules in FIXES.items() for rule in rules}
"""The file in ``fixes`` by rule."""


def options_of(rule: str) -> str:
    """Applicability of a rule's fixes, with what applies them on the command line."""
    text = OPTIONS[FIXABLE[rule]]
    return text.replace(")", " --fix-meshes)") if FIX_FILE[rule] == "mesh_files" else text
