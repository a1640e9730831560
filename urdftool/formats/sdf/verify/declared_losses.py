"""Differences that reported losses of an export explain."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ....compare.proof import Excuse
from ....compare.rows import NATIVE
from ....diagnostic import Severity
from ....finding import Finding
from ....model.block_elements import find_references_at, list_model_elements
from ....model.elements import Robot

MASS = frozenset(("lossy-inertia", "lossy-mass", "lossy-world", "lossy-negative-mass"))
MOTION = frozenset(("lossy-axis", "lossy-joint-type", "lossy-planar", "lossy-floating"))
SHAPES = frozenset(("lossy-mesh", "lossy-shape", "lossy-capsule", "lossy-world"))
BLOCKS = frozenset(
    (
        "lossy-element",
        "lossy-extension",
        "lossy-reference",
        "bad-extension-number",
        "invalid-sdf-value",
    )
)
"""Contents of a ``<gazebo>`` block were dropped or changed."""

_TENSORS = ("mass", "center of mass", "inertia")
_PARTS = ("surface", "link flags", "joint physics", "base")

ADDED = "added-body"
"""Code of bodies that blocks add to the model."""

DROPPED = "dropped-part"
"""Code of sensors and plugins of other formats, which are dropped."""

EXCUSES = (
    Excuse(("base",), frozenset((ADDED,)), "robot"),
    Excuse(("tree",), frozenset((ADDED,))),
    Excuse((*_TENSORS, "mass matrix", "gravity"), MASS, "body"),
    Excuse(("mass matrix", "gravity"), MASS, "robot"),
    Excuse(
        ("tree", "frames", "axes", "limits", "joint physics", "collisions", "visuals", *_TENSORS),
        MOTION,
        "below",
        ends=("_x", "_y"),
    ),
    Excuse(_TENSORS, frozenset(("lossy-joint-type",)), "body"),  # the child is fixed to it
    Excuse(("sensors",), MOTION, "below", properties=("link", "pose")),
    # the trees that a floating joint leaves move freely in the world, each with a joint of its own
    Excuse(("base", "tree"), frozenset(("lossy-floating",)), "robot"),
    Excuse(("limits",), frozenset(("lossy-limit", "lossy-ball-limit"))),
    Excuse(("joint physics",), frozenset(("lossy-joint-armature", "lossy-joint-resistance"))),
    Excuse(("frames",), frozenset(("lossy-frame",)), "body"),
    Excuse(("tree",), frozenset(("lossy-mimic",))),
    Excuse(("collisions", "visuals"), SHAPES, "body"),
    Excuse(("colors", "looks", "textures"), SHAPES | {"lossy-material", "lossy-texture"}),
    Excuse(("colors", "looks"), BLOCKS, least=Severity.WARNING),
    Excuse(("sensors", "plugins"), frozenset((DROPPED,)), properties=("existence",)),
    Excuse(("sensors",), frozenset(("lossy-frame-id",)), properties=("frame",)),
    Excuse(("sensors",), BLOCKS | {"lossy-sensor", "unknown-sensor-type"}, least=Severity.WARNING),
    Excuse((NATIVE, "loops"), frozenset(("lossy-sdf-element", "lossy-joint-extension"))),
    Excuse((NATIVE, "loops"), BLOCKS, "body", least=Severity.WARNING),
    Excuse((NATIVE,), SHAPES, "body"),
    Excuse(_PARTS, BLOCKS | {"lossy-link-flag"}, least=Severity.WARNING),
)
"""Rows and parts that a loss explains."""


def list_added_bodies(robot: Robot) -> Iterator[Finding]:
    """Yield what links and models in blocks cause: the model has several roots.

    Their reader joins the roots to the world.
    """
    added = [e for e in list_model_elements(robot) if e.tag in ("link", "model", "include")]
    if added:
        roots = [link.name for link in robot.tree.roots]
        for name in (*roots, *(element.get("name") or "" for element in added)):
            place = added[0].place
            yield Finding(ADDED, Severity.INFO, "", place, "joint", f"{name}_floating")


def list_dropped_parts(losses: Sequence[Finding]) -> Iterator[Finding]:
    """Yield the losses of whole sensors and plugins with a code of their own."""
    for loss in losses:
        if loss.kind in ("sensor", "camera", "plugin"):
            yield replace(loss, code=DROPPED)


def name_blocks(robot: Robot, losses: Sequence[Finding]) -> Iterator[Finding]:
    """Yield the losses of blocks without a name for the link or joint of each block."""
    for loss in losses:
        if loss.code in BLOCKS and not loss.name:
            names = find_references_at(robot, loss.location)
            yield from (replace(loss, name=name) for name in names)
