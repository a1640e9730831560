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
            "expansion-failed",
        ),
        "tags": ("unprefixed-xacro-tag", "nonstandard-xmlns"),
        "leftovers": ("unexpanded-expression",),
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
        "limits": (
            "missing-limit",
            "limit-without-effort-or-velocity",
            "limit-without-bounds",
            "lower-above-upper",
            "locked-by-limits",
            "limit-in-degrees",
            "prismatic-in-millimetres",
            "limit-rounded-outward",
            "range-above-full-turn",
            "continuous-with-bounds",
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
        ),
        "safety": (
            "incomplete-safety-controller",
            "soft-limits-lock-joint",
            "soft-limits-outside-hard",
        ),
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
            "com-outside-geometry",
            "inertial-not-at-com-suspect",
            "radius-of-gyration",
        ),
        "sides": ("left-right-asymmetry",),
    },
    "collision": {
        "presence": ("missing-collision", "massive-link-without-collision"),
        "shapes": ("non-positive-dimension", "unsupported-shape"),
    },
    "visual": {
        "materials": ("undefined-material", "conflicting-material", "invalid-color"),
    },
    "mesh": {
        "files": ("mesh-not-found", "mesh-case-mismatch", "corrupt-mesh"),
        "uris": ("absolute-path", "malformed-uri"),
    },
    "package": {"resolution": ("package-not-found",)},
    "gazebo": {
        "tags": ("missing-gazebo-tags", "missing-gazebo-material", "missing-friction"),
        "references": ("dangling-reference", "misplaced-extension"),
        "vocabulary": ("unknown-extension",),
        "values": ("bad-extension-number",),
    },
    "control": {
        "transmissions": ("transmission-unknown-joint", "unprefixed-hardware-interface"),
        "ros2_control": ("ros2-control-unknown-joint",),
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
    "lint": {"suppressions": ("unused-suppression", "unknown-rule")},
}

FAMILIES = tuple(RULES)

FAMILY_OF = {
    name: family for family, files in RULES.items() for names in files.values() for name in names
}


def get_rule(name: str) -> Rule:
    """A rule by its name, imported if need be.

    Raises:
        KeyError: There is no rule of that name.
    """
    family = FAMILY_OF[name]
    for file, names in RULES[family].items():
        if name in names:
            module = import_module(f".{family}.{file}", __name__)
            found: Rule = getattr(module, name.replace("-", "_"))
            return found
    raise KeyError(name)


def all_rules() -> Iterator[Rule]:
    """Every rule, in reading order."""
    return map(get_rule, FAMILY_OF)
