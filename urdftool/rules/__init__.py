"""The opinions: every rule by family and file, in reading order, and nothing else.

A family follows from the stage at which its rules can look: the bytes (xml), the xacro source
(xacro), the expanded robot (tree to name), its files (mesh, package), what a simulator would do
with it (gazebo, control), and the linter itself (lint). Rules are imported when they are wanted.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module

from .rule import Rule

RULES: dict[str, dict[str, tuple[str, ...]]] = {
    "xml": {
        "document": (
            "not-well-formed",
            "content-before-declaration",
            "wrong-root",
            "missing-name",
        ),
        "vocabulary": ("unknown-element", "unknown-attribute", "wrong-case-keyword"),
        "shape": ("repeated-element", "several-shapes-in-geometry", "empty-geometry"),
        "numbers": ("wrong-arity", "not-a-number", "tab-or-newline-in-vector"),
        "reference": ("padded-reference",),
        "version": (
            "unsupported-urdf-version",
            "feature-needs-newer-version",
            "rpy-and-quat",
            "colon-space-in-comment",
        ),
    },
    "xacro": {
        "expansion": (
            "missing-xmlns",
            "unknown-macro",
            "undefined-name",
            "undeclared-arg",
            "include-not-found",
            "macro-arguments-mismatch",
            "circular-property",
            "endless-expansion",
            "non-boolean-conditional",
            "expansion-failed",
        ),
        "tags": ("unprefixed-xacro-tag", "nonstandard-xmlns"),
        "leftovers": ("unexpanded-expression",),
        "unreached": ("bad-substitution-command", "unclosed-expression"),
        "expansion_warnings": (
            "shadowed-builtin",
            "unknown-xacro-attribute",
            "deprecated-global-function",
        ),
        "unused": (
            "unused-arg",
            "unused-property",
            "unused-macro",
            "macro-redefined",
            "hard-coded-name-in-macro",
        ),
    },
    "tree": {
        "links": (
            "no-links",
            "duplicate-link-name",
            "duplicate-joint-name",
            "link-joint-name-clash",
            "unknown-parent-link",
            "unknown-child-link",
            "missing-parent-or-child",
            "joint-to-itself",
        ),
        "roots": ("multiple-roots", "no-root", "detached-cycle", "multiple-parents"),
    },
    "joint": {
        "kind": ("unknown-joint-type", "planar-or-floating", "redundant-on-fixed"),
        "axis": ("zero-axis", "axis-not-unit", "axis-omitted", "axis-nearly-canonical"),
        "origin": ("rpy-in-degrees",),
        "place": ("axis-misses-links",),
        "limits": (
            "missing-limit",
            "limit-without-effort-or-velocity",
            "limit-without-bounds",
            "continuous-with-bounds",
        ),
        "range": (
            "lower-above-upper",
            "locked-by-limits",
            "limit-in-degrees",
            "prismatic-in-millimetres",
            "limit-rounded-outward",
            "range-above-full-turn",
            "zero-outside-limits",
        ),
        "drive": (
            "zero-effort-limit",
            "zero-velocity-limit",
            "negative-limit",
            "implausible-velocity",
            "implausible-effort",
            "negative-dynamics",
            "empty-dynamics",
            "dynamics-as-child-elements",
            "missing-dynamics",
        ),
        "mimic": (
            "mimic-unknown-joint",
            "mimic-cycle",
            "mimic-chain",
            "mimic-limits-inconsistent",
            "mimic-dof-mismatch",
            "mimic-not-simulated",
            "gripper-finger-not-mimic",
            "fingers-move-together",
        ),
        "safety": (
            "incomplete-safety-controller",
            "soft-limits-lock-joint",
            "soft-limits-outside-hard",
            "soft-limits-far-inside",
        ),
        "sides": ("joint-not-mirrored", "limits-not-mirrored", "axis-against-others"),
    },
    "inertia": {
        "presence": (
            "missing-inertial",
            "massless-moving-body",
            "massless-root-body",
            "root-link-has-inertia",
            "mass-without-geometry",
        ),
        "mass": (
            "incomplete-inertial",
            "zero-mass",
            "negative-mass",
            "implausible-mass",
            "implausible-density",
        ),
        "density": ("mass-out-of-line",),
        "tensor": (
            "inertia-not-positive-definite",
            "inertia-triangle-inequality",
            "inertia-triangle-inequality-rounding",
            "zero-inertia",
            "singular-inertia",
            "tiny-moving-inertia",
        ),
        "slips": (
            "inertia-component-slip",
            "inertia-off-by-power-of-ten",
            "redundant-inertia-attributes",
        ),
        "size": (
            "placeholder-inertia",
            "inertia-exceeds-geometry",
            "inertia-below-geometry",
            "radius-of-gyration",
        ),
        "center": ("com-outside-geometry", "inertial-not-at-com-suspect"),
        "frame": ("inertia-about-link-frame",),
        "sides": ("left-right-asymmetry", "com-not-mirrored"),
    },
    "collision": {
        "presence": (
            "missing-collision",
            "odd-link-without-collision",
            "massive-link-without-collision",
        ),
        "shapes": ("non-positive-dimension", "unsupported-shape", "shape-in-millimetres"),
        "likeness": (
            "visual-mesh-as-collision",
            "collision-mesh-too-dense",
            "collision-much-larger-than-visual",
            "collision-much-smaller-than-visual",
            "collision-off-visual",
        ),
        "displaced": ("collision-mesh-displaced",),
        "wheels": ("wheel-cylinder-axis", "caster-height-mismatch", "paper-thin-collision"),
        "overlap": (
            "self-collision-at-zero",
            "self-collide-at-spawn",
            "link-inside-parent",
            "self-collision-in-range",
        ),
    },
    "visual": {
        "materials": (
            "undefined-material",
            "nameless-material",
            "conflicting-material",
            "invalid-color",
        ),
        "looks": (
            "missing-visual",
            "fully-transparent",
            "empty-material-name",
            "unused-material",
            "missing-texture",
        ),
    },
    "mesh": {
        "files": ("mesh-not-found", "mesh-case-mismatch", "corrupt-mesh", "git-lfs-pointer"),
        "uris": (
            "absolute-path",
            "mesh-without-filename",
            "malformed-uri",
            "unsupported-uri-scheme",
            "relative-uri-in-ros",
            "unsafe-file-name",
            "package-uri-unresolvable",
            "mesh-stem-collision",
        ),
        "formats": (
            "unsupported-mesh-format",
            "ascii-stl",
            "binary-stl-starts-with-solid",
            "dae-unit-or-axis",
            "dae-as-collision",
        ),
        "scale": (
            "mesh-in-millimetres",
            "mesh-scaled-twice",
            "mesh-scale-differs",
            "mesh-scale-out-of-line",
            "mirrored-scale",
            "bad-scale",
            "non-uniform-scale",
            "heavy-visual",
        ),
        "parts": ("missing-mesh-dependency",),
        "surface": (
            "not-watertight",
            "inverted-mesh",
            "degenerate-triangles",
            "nonconvex-collision-mesh",
        ),
    },
    "package": {
        "resolution": ("package-not-found",),
        "manifest": (
            "undeclared-mesh-dependency",
            "dependency-circle",
            "directory-not-installed",
            "gazebo-path-not-exported",
            "wrong-package-in-uri",
        ),
        "launching": ("obsolete-cli-option",),
    },
    "gazebo": {
        "tags": ("missing-gazebo-tags", "missing-gazebo-material", "missing-friction"),
        "references": ("dangling-reference", "misplaced-extension", "conflicting-references"),
        "vocabulary": ("unknown-extension",),
        "values": ("bad-extension-number", "half-friction", "implausible-friction"),
        "settings": (
            "deprecated-cfm-damping",
            "no-effect-in-gz",
            "ogre-material-script",
            "missing-contact-parameters",
            "engine-ignores-ode-friction",
        ),
        "lumping": (
            "lumped-joint-loses-content",
            "lumped-flag-leaks",
            "preserved-joint-massless",
            "named-geometry-loses-extensions",
            "lumped-link-referenced",
            "surface-without-collision",
        ),
        "model": (
            "robot-level-static",
            "gravity-off-everywhere",
            "reserved-name",
            "missing-control-plugin",
            "root-not-anchored",
        ),
        "sensors": (
            "unknown-sensor-type",
            "cpu-ray-in-gz",
            "ros-plugin-inside-sensor",
            "missing-gz-frame-id",
            "duplicate-sensor-name",
            "missing-sensor-tag",
            "sensor-needs-world-system",
        ),
        "plugins": (
            "plugin-without-filename",
            "classic-plugin-in-gz",
            "gz-plugin-in-classic",
            "ignition-name",
            "plugin-class-mismatch",
            "plugin-unknown-entity",
            "duplicate-plugin-name",
        ),
        "drives": ("drive-size-mismatch", "drive-direction-mismatch"),
    },
    "control": {
        "transmissions": (
            "transmission-unknown-joint",
            "unprefixed-hardware-interface",
            "incomplete-transmission",
            "missing-hardware-interface",
            "unknown-hardware-interface",
            "several-hardware-interfaces",
            "duplicate-transmission",
            "transmission-on-immovable-joint",
            "actuated-joint-without-transmission",
            "ros1-transmission-in-ros2",
        ),
        "ros2_control": (
            "ros2-control-unknown-joint",
            "ros2-control-fixed-joint",
            "ros2-control-mimic",
            "ros2-control-legacy-mimic-param",
            "ros2-control-duplicate-interface",
            "nonstandard-interface-name",
            "command-without-state",
            "joint-outside-ros2-control",
            "bad-initial-value",
        ),
        "ros2_control_form": (
            "ros2-control-missing-attribute",
            "ros2-control-missing-plugin",
            "ros2-control-invalid-tag",
            "ros2-control-nested",
            "ros2-control-bad-param",
        ),
        "ros2_control_simulated": (
            "ros2-control-wrong-sim-plugin",
            "ros2-control-sim-plugin-pair",
            "ros2-control-empty-parameters",
            "ros2-control-unknown-imu-interface",
            "sensor-name-mismatch",
        ),
        "controllers": ("controller-unknown-joint",),
        "parameter_types": ("controller-parameter-type",),
    },
    "simulation": {
        "stability": ("mass-ratio",),
        "spawn": ("stiff-joint-damping", "below-ground-at-spawn"),
        "readers": (
            "pybullet-ignores-inertia",
            "mujoco-welds-root",
            "mujoco-missing-compiler",
            "isaac-empty-root",
        ),
    },
    "moveit": {
        "semantic": (
            "srdf-unknown-link",
            "srdf-unknown-joint",
            "srdf-robot-name",
            "chain-not-connected",
            "group-state-out-of-bounds",
            "missing-virtual-joint",
            "end-effector-group",
            "missing-acceleration-limits",
        ),
        "configuration": (
            "moveit-parameter-type",
            "moveit-controller-incomplete",
            "moveit-controller-unknown-joint",
        ),
        "adjacent": ("adjacent-pair-not-disabled",),
    },
    "name": {
        "spelling": (
            "invalid-frame-name",
            "not-portable-identifier",
            "name-style",
            "non-ascii-name",
            "confusable-names",
            "duplicate-geometry-name",
        ),
        "frames": (
            "missing-base-link",
            "optical-frame-orientation",
            "camera-sensor-not-optical",
            "optical-frame-has-sensor-body",
            "base-footprint-placement",
        ),
    },
    "lint": {
        "suppressions": ("unused-suppression", "unknown-rule"),
        "analysis": ("analysis-incomplete",),
        "comments": ("suppression-without-reason", "blanket-suppression"),
    },
}

# A file of rules that speak of certain elements alone is not imported for a robot without them;
# one with no element is never imported to look, because the readers of files report its rules.
ONLY_WITH: dict[str, tuple[str, ...]] = {
    "xacro.expansion": (),
    "package.resolution": ("mesh",),
    "lint.suppressions": (),
    "lint.analysis": ("mesh", "collision"),
    "joint.mimic": ("mimic", "joint"),
    "joint.safety": ("safety_controller",),
    "visual.materials": ("material",),
    "mesh.files": ("mesh",),
    "mesh.uris": ("mesh",),
    "mesh.formats": ("mesh",),
    "mesh.scale": ("mesh",),
    "mesh.parts": ("mesh",),
    "mesh.surface": ("mesh",),
    "visual.looks": ("visual", "collision"),
    "collision.likeness": ("collision",),
    "collision.displaced": ("mesh",),
    "collision.wheels": ("collision",),
    "collision.overlap": ("collision",),
    "inertia.slips": ("inertia",),
    "gazebo.references": ("gazebo",),
    "gazebo.vocabulary": ("gazebo",),
    "gazebo.values": ("gazebo",),
    "gazebo.lumping": ("gazebo",),
    "gazebo.sensors": ("gazebo",),
    "gazebo.plugins": ("plugin",),
    "gazebo.drives": ("plugin", "ros2_control", "transmission"),
    "control.transmissions": ("transmission", "plugin"),
    "control.ros2_control": ("ros2_control",),
    "control.ros2_control_form": ("ros2_control",),
    "control.ros2_control_simulated": ("ros2_control", "plugin"),
    "control.controllers": ("ros2_control", "transmission"),
    "control.parameter_types": ("ros2_control",),
}

FAMILIES = tuple(RULES)

FILE_OF = {
    name: f"{family}.{file}"
    for family, files in RULES.items()
    for file, names in files.items()
    for name in names
}

FAMILY_OF = {name: file.partition(".")[0] for name, file in FILE_OF.items()}

_loaded: dict[str, Rule] = {}


def get_rule(name: str) -> Rule:
    """A rule by its name, imported if need be.

    Raises:
        KeyError: There is no rule of that name.
    """
    rule = _loaded.get(name)
    if rule is None:
        module = import_module(f".{FILE_OF[name]}", __name__)
        rule = _loaded[name] = getattr(module, name.replace("-", "_"))
    return rule


def speaks_of(name: str, tags: set[str]) -> bool:
    """Whether a rule can find anything in a robot that has only certain elements."""
    wanted = ONLY_WITH.get(FILE_OF[name])
    return wanted is None or not tags.isdisjoint(wanted)


def all_rules() -> Iterator[Rule]:
    """Every rule, in reading order."""
    return map(get_rule, FAMILY_OF)
