"""Joints with their axes, limits and dynamics; units and sources as in ``elements``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ..source.document import Element
from .part import Origin, Part, Vector
from .settings import Settings, get_number, is_set


@dataclass(slots=True)
class Limit(Part):
    """Limits of a joint: position [rad or m], effort [N·m or N], velocity [rad/s or m/s].

    None if not written; readers replace a missing ``lower`` or ``upper`` by 0.
    """

    lower: float | None = None
    upper: float | None = None
    effort: float | None = None
    velocity: float | None = None


@dataclass(slots=True)
class Dynamics(Part):
    """Forces that depend on the motion of a joint; None if not written.

    Attributes:
        damping: Damping [N·m·s/rad or N·s/m].
        friction: Static friction [N·m or N].
        armature: Inertia of the rotor at the joint [kg·m² or kg] (MJCF).
    """

    damping: float | None = None
    friction: float | None = None
    armature: float | None = None


@dataclass(slots=True)
class Mimic(Part):
    """Dependence of a joint on another: ``multiplier * position + offset``."""

    joint: str = ""
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(slots=True)
class SafetyController(Part):
    """Soft limits of a joint and the gains that keep it within them."""

    soft_lower_limit: float = 0.0
    soft_upper_limit: float = 0.0
    k_position: float = 0.0
    k_velocity: float | None = None


@dataclass(slots=True)
class Calibration(Part):
    """Reference position of a joint."""

    rising: float | None = None
    falling: float | None = None
    reference_position: float | None = None


@dataclass(slots=True)
class Axis(Part):
    """Axis of a joint in the joint frame, as written (not normalized)."""

    xyz: Vector = (1.0, 0.0, 0.0)


MOVING_TYPES = frozenset(("revolute", "continuous", "prismatic", "floating", "planar"))
JOINT_TYPES = MOVING_TYPES | {"fixed"}

BALL_TYPES = frozenset(("spherical", "ball"))
"""Joint types that URDF does not have and several readers do."""


@dataclass(slots=True)
class Joint(Part):
    """Connection of a child link to a parent link.

    Attributes:
        type: Type as written; ``JOINT_TYPES`` are those of URDF. Readers of other formats also
            use ``ball``, three rotations about the origin, and ``screw``.
        parent: Name of the parent link; empty if not written.
        child: Name of the child link; empty if not written.
        parent_element: The ``<parent>`` element of URDF, if any.
        child_element: The ``<child>`` element of URDF, if any.
        axis: Axis; None if not written, which means x.
        thread_pitch: Translation along the axis [m] for each right-handed turn of a ``screw``.
        settings: Settings of ``settings.OF_JOINTS``.
    """

    name: str = ""
    type: str = ""
    parent: str = ""
    child: str = ""
    parent_element: Element | None = None
    child_element: Element | None = None
    origin: Origin | None = None
    axis: Axis | None = None
    limit: Limit | None = None
    dynamics: Dynamics | None = None
    mimic: Mimic | None = None
    safety_controller: SafetyController | None = None
    calibration: Calibration | None = None
    thread_pitch: float | None = None
    settings: Settings = field(default_factory=dict)

    @property
    def spring(self) -> tuple[float, float] | None:
        """Return stiffness [N·m/rad, N/m] and rest position [rad, m]; None without a spring."""
        stiffness = get_number(self.settings, "spring_stiffness")
        rest = get_number(self.settings, "spring_reference")
        return (stiffness, rest or 0.0) if stiffness else None

    @property
    def is_preserved(self) -> bool:
        """Tell whether Gazebo keeps the joint if it is fixed."""
        return is_set(self.settings, "preserved") or is_set(self.settings, "not_lumped")

    @property
    def is_fixed(self) -> bool:
        """Tell whether the type is ``fixed``."""
        return self.type == "fixed"

    @property
    def has_axis(self) -> bool:
        """Tell whether the type uses an axis."""
        return self.type in ("revolute", "continuous", "prismatic", "planar")

    @property
    def has_direction(self) -> bool:
        """Tell whether the type moves along or about an axis, also if URDF does not have it."""
        return self.has_axis or self.type == "screw"

    @property
    def is_limited(self) -> bool:
        """Tell whether the type requires limits."""
        return self.type in ("revolute", "prismatic")

    def get_magnitude(self, name: str) -> float | None:
        """Return the limit of ``effort`` or ``velocity`` without its sign; None if not written."""
        value = getattr(self.limit, name, None)
        return None if value is None else abs(value)

    def get_resistance(self, name: str) -> float:
        """Return ``damping``, ``friction`` or ``armature``; 0 if it is not written or negative."""
        return max(getattr(self.dynamics, name, None) or 0.0, 0.0)

    def replace_resistance(self, values: Mapping[str, Any]) -> Joint:
        """Return the joint with other values of its dynamics, by their names."""
        before = self.dynamics or Dynamics(self.provenance)
        return replace(self, dynamics=replace(before, **values)) if values else self

    @property
    def turns_freely(self) -> bool:
        """Tell whether it is continuous, or revolute with a drive and no written bound.

        By the letter of URDF both bounds of the latter are zero, and it could not move; but an
        effort or a velocity is written for a joint that moves. Bounds that are written count.
        """
        limit = self.limit
        if self.type != "revolute" or limit is None:
            return self.type == "continuous"
        is_bounded = limit.lower is not None or limit.upper is not None
        return not is_bounded and bool(limit.effort or limit.velocity)
