"""Thresholds of the checks, with units and sources, and their values in a configuration file.

Lengths marked [size] are relative to the robot's size, the largest extent of its collision geometry
at the start. The sources are:

- *physics*, *geometry*: follows from the stated fact;
- *contact*: above the inaccuracy of hulls, contact margins and rounded files (up to 1 mm in
  PyBullet);
- *chosen*: no derivation; the verdicts in ``docs/measurements/simulate-robots.md``, on robots of
  two collections and on planted defects, use this value.

Defaults of what a robot that stands does are those of the row ``runs``, in ``mechanics.standing``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from ...errors import ConfigError
from ...mechanics.standing import FALLEN, LEAN, SAG_SLIDE, SAG_TURN, SLIDE
from ...suggestions import suggest_name
from ..old_names import RENAMED_THRESHOLDS
from ..rigid_bodies import TENSOR_ROUNDING


@dataclass(frozen=True)
class Thresholds:
    """Thresholds of the checks; the unit of each is in brackets."""

    # --- at rest: used in the engine's process --------------------------------------------------

    settle_window: float = 0.5
    """Time without motion after which a robot is at rest [s]. Source: chosen."""
    settle_min_time: float = 1.5
    """Minimum simulated time [s]. Source: physics; a balanced robot falls slowly at first, and the
    disturbance at the start ends at 0.2 s."""
    settle_creep: float = 0.002
    """Maximum motion of a body's origin within the window at rest [size]. Source: chosen."""
    settle_turn: float = 0.01
    """Maximum rotation of a body or revolute joint within the window at rest [rad]. Source:
    chosen."""
    settle_slide: float = 0.01
    """Maximum motion of a prismatic joint within the window at rest [m]. Source: chosen; its bodies
    are limited by ``settle_creep`` as well."""

    settle_horizon: float = 5.0
    """Time within which a robot at rest stays within these bounds if it goes on as it moves [s].
    Source: chosen, the default duration."""

    narrow_tilt: float = math.radians(2)
    """Tilt that tips the robot over, below which the report names it [rad]. Source: chosen, that of
    exports."""

    # --- final state ----------------------------------------------------------------------------

    fall_sizes: float = 2.0
    """Distance below its start at which a robot without contact fell through the ground [size].
    Source: chosen."""
    fall_depth: float = 0.5
    """Minimum of that distance [m]. Source: chosen."""
    energy_gain: float = 0.5
    """Energy increase of a run that diverged, over the energy that lifts the robot by its size [1].
    Source: chosen; motors that hold a pose add little energy."""
    tip_tilt: float = math.radians(FALLEN)
    """Tilt of the root's z axis above which the robot tipped over [rad]. Source: chosen."""
    lean_tilt: float = math.radians(LEAN)
    """Tilt of the root's z axis that is reported [rad]. Source: chosen."""
    slide_distance: float = 0.05
    """Motion of the root along the plane that is reported [size]. Source: chosen."""
    slide_failure: float = SLIDE
    """Motion of the root that is an error on a level plane [size]. Source: chosen."""
    wheel_turn: float = 0.05
    """Rotation of a wheel that rolled [rad]. Source: chosen."""
    start_height: float = 0.003
    """Height above the lowest link below which a link supports the robot at the start [size].
    Source: contact."""
    footprint_height: float = 0.001
    """Height above the lowest point of a body below which a corner is part of the support polygon
    [size]. Source: contact."""
    arm_joints: int = 4
    """Number of revolute joints in one chain from the root of a manipulator, at least [1]. Source:
    chosen."""

    # --- causes of motion at the end --------------------------------------------------------------

    yield_turn: float = 0.05
    """Distance of a saturated revolute joint from its target at which it is the cause of motion
    [rad]. Source: as ``joint_drift_turn``."""
    yield_slide: float = 0.05
    """Distance of a saturated prismatic joint from its target at which it is the cause of motion
    [m]. Source: chosen."""
    moving_rate: float = 1e-3
    """Speed of a moving revolute joint, at least [rad/s]. Source: chosen."""
    moving_speed: float = 1e-3
    """Speed of a moving prismatic joint, at least [m/s]. Source: chosen."""
    creep_speed: float = 0.01
    """Maximum speed of creep [size/s]. Source: chosen."""
    creep_rate: float = 0.05
    """Maximum angular velocity of creep [rad/s]. Source: chosen."""
    full_effort: float = 0.99
    """Part of its effort limit that a saturated joint uses [1]. Source: physics; rounding."""

    # --- support ----------------------------------------------------------------------------------

    support_margin: float = 0.05
    """Distance outside of the support polygon at which the center of mass of a robot at rest is
    reported [size]. Source: contact; the polygon is as accurate as the contacts."""
    support_margin_min: float = 0.005
    """Minimum of that distance [m]. Source: contact."""
    carried_weight: float = 0.8
    """Part of its weight that the ground carries of a robot at rest, at least [1]. Source: physics;
    it carries all, and samples vary."""
    supporting_parts: int = 2
    """Number of wheels, or feet, of a robot that stands on them, at least [1]. Source: geometry."""

    # --- contact ----------------------------------------------------------------------------------

    ground_depth: float = 0.01
    """Penetration of the ground that is reported [size]. Source: chosen."""
    contact_depth: float = 0.002
    """Penetration below which nothing is reported [m]. Source: contact."""
    ground_gap: float = 0.002
    """Distance from the ground below which a visual should make contact [m]. Source: contact."""
    foot_protrusion: float = 0.001
    """Length by which the visual of a foot extends below its collision geometry [m]. Source:
    contact."""
    submerged_visual: float = 0.4
    """Part of a visual's height that may be below the ground [1]. Source: chosen."""
    small_collision: float = 0.5
    """Extent of a collision that is much smaller than its visual, over the visual's extent [1].
    Source: chosen."""

    # --- interpenetration -------------------------------------------------------------------------

    overlap_depth: float = 0.005
    """Depth of an interpenetration that is reported [size]. Source: contact."""
    overlap_failure: float = 0.25
    """Depth of an interpenetration that is an error, over the smallest extent of the thinner body
    [1]. Source: chosen."""
    compound_joint: float = 0.5
    """Distance of joints that act as one, over the extent of the smaller body [1]. Source: chosen;
    universal and ball joints are written as joints at one point."""
    overlap_turn: float = 0.05
    """Rotation of a joint that is the cause of an interpenetration [rad]. Source: as
    ``joint_drift_turn``."""
    overlap_slide: float = 0.05
    """Translation of a joint that is the cause of an interpenetration [m]. Source: chosen."""
    mechanism_variation: float = 0.25
    """Maximum variation of an equal depth over the motion of a mechanism, over the depth [1].
    Source: chosen."""
    mechanism_depth: float = 0.002
    """Minimum of that variation as a length [m]. Source: contact."""
    rod_length: float = 2.0
    """Length of a rod or cylinder over its width, at least [1]. Source: chosen."""
    rod_angle: float = math.radians(5)
    """Angle between the axes of a rod and its cylinder, at most [rad]. Source: chosen."""
    rod_width: float = 0.8
    """Width of a rod over that of its cylinder, at most [1]. Source: chosen."""
    rod_offset: float = 0.25
    """Distance of a rod's center from its cylinder's axis, over the smaller width, at most [1].
    Source: chosen."""

    # --- misplaced collision geometry -------------------------------------------------------------

    copy_size: float = 0.05
    """Relative difference of the extents of a visual and its copy as collision, at most [1].
    Source: chosen."""
    copy_offset: float = 0.25
    """Offset of a misplaced copy from its visual, over the visual's extent [1]. Source: chosen."""
    box_overlap: float = 0.5
    """Part of the smaller bounding box that is in the other one, along each axis, at least [1].
    Source: chosen."""
    housing_size: float = 0.8
    """Extent of a motor housing over that of its link's visual, at most [1]. Source: chosen."""
    housing_offset: float = 0.25
    """Distance of a housing's center from its joint, over its extent, at most [1]. Source:
    chosen."""
    neighbor_overlap: float = 0.1
    """Part of the smaller of two neighbors that overlaps the other one, at least [1]. Source:
    chosen."""
    neighbor_gain: float = 0.2
    """Part by which collision geometry overlaps more than visual geometry, at least [1]. Source:
    chosen."""
    neighbor_growth: float = 0.05
    """Part by which centering a collision may increase its overlap with the neighbor [1]. Source:
    chosen."""
    better_fit: float = 0.2
    """Part by which centering a misplaced collision increases its overlap with its visual [1].
    Source: chosen."""
    outside_visuals: float = 0.15
    """Part of a misplaced collision that is outside of the visuals of both links [1]. Source:
    chosen."""
    unlike_overlap: float = 0.45
    """Part of the smaller of collision and visual that overlaps, if one is misplaced, at most [1].
    Source: chosen."""

    # --- joints -----------------------------------------------------------------------------------

    joint_drift_turn: float = SAG_TURN
    """Distance of a held revolute joint from its target that is reported [rad]. Source: chosen; 50
    mm at 1 m."""
    joint_drift_slide: float = SAG_SLIDE
    """Distance of a held prismatic joint from its target that is reported [size]. Source:
    chosen."""
    limit_turn: float = 0.02
    """Distance of a revolute joint beyond a limit that is reported [rad]. Source: chosen; limits
    are soft."""
    limit_slide: float = 0.02
    """Distance of a prismatic joint beyond a limit that is reported [size]. Source: chosen; limits
    are soft."""
    near_effort: float = 0.9
    """Part of its effort limit that a joint may use at rest [1]. Source: chosen."""
    wheel_offset: float = 0.01
    """Distance of the center of mass of a wheel from its axis, at most [size]. Source: chosen."""
    collapse_depth: float = 0.05
    """Distance by which the center of mass of a collapsed robot, or of the load of a joint, sank
    [size]. Source: chosen."""
    collapse_share: float = 0.01
    """Distance by which the joint that caused the collapse lowered its load, at least [size].
    Source: chosen."""
    collapse_turn: float = 0.05
    """Rotation of a joint that may cause a collapse [rad]. Source: as ``joint_drift_turn``."""
    collapse_slide: float = 0.05
    """Translation of a joint that may cause a collapse [size]. Source: chosen."""

    # --- controllers ------------------------------------------------------------------------------

    oscillation_reversals: int = 4
    """Changes of direction of an oscillating joint in the last second, at least [1]. Source:
    chosen."""
    oscillation_turn: float = 0.01
    """Peak-to-peak amplitude of an oscillating revolute joint, at least [rad]. Source: chosen."""
    oscillation_slide: float = 0.01
    """Peak-to-peak amplitude of an oscillating prismatic joint, at least [size]. Source: chosen."""
    saturated_effort: float = 0.98
    """Part of its effort limit that a saturated controller uses [1]. Source: physics; the output is
    limited, and samples vary."""
    damping_ratio: float = 0.1
    """Damping ratio below which a joint is reported as undamped [1]. Source: physics; at 0.1 the
    amplitude halves in each cycle."""

    # --- the model --------------------------------------------------------------------------------

    tensor_excess: float = TENSOR_ROUNDING
    """Relative violation of the triangle inequality that is allowed [1]. Source: physics; rounded
    files."""
    gyration_reach: float = 1.2
    """Radius of gyration over the distance of the farthest corner of the shapes, at most [1].
    Source: physics; at most 1, and shapes omit small parts."""
    light_gyration_reach: float = 3.0
    """The same for a link lighter than ``light_link`` [1]. Source: chosen."""
    axis_spread: float = 2.0
    """Spread of the mass along an axis over half the extent of the shapes, at most [1]. Source:
    physics; two point masses at the ends have 1, a rod 0.58, and shapes omit small parts."""
    axis_overhang: float = 0.5
    """Minimum of that spread, over the longest half extent [1]. Source: chosen; a motor may extend
    beyond a thin box."""
    sheet_thickness: float = 0.05
    """Minimum of a half extent, over the longest one [1]. Source: chosen; sheets are modeled
    flat."""
    placeholder_ratio: float = 2.0
    """Tensor of equal powers of ten over that of a solid box, at least [1]. Source: chosen."""
    heavy_link: float = 0.1
    """Mass of a heavy link over the robot's mass [1]. Source: chosen."""
    light_link: float = 0.02
    """Mass of a light link over the robot's mass [1]. Source: chosen; cameras and frames."""
    dominant_inertia: float = 0.5
    """Trace of a link's tensor over that of its rigid body, above which it dominates [1]. Source:
    geometry; half."""
    massless_share: float = 0.5
    """Volume of a reported link without mass over that of its rigid body [1]. Source: geometry."""
    massless_part: float = 0.05
    """Volume of a reported link without mass over that of the robot, if it has collisions [1].
    Source: chosen."""
    hollow_density: float = 20.0
    """Density of the hulls of links whose inertial is in a separate link, at least [kg/m³]. Source:
    chosen."""

    # --- two engines ------------------------------------------------------------------------------

    differ_length: float = 0.01
    """Tolerance of heights and prismatic joints between two engines [size]. Source: chosen."""
    differ_length_min: float = 1e-3
    """Minimum of that tolerance [m]. Source: contact."""
    differ_angle: float = math.radians(1)
    """Tolerance of tilts and revolute joints between two engines [rad]. Source: chosen."""
    differ_margin: float = 0.02
    """Static margin below which balance is a possible cause of a difference [size]. Source:
    chosen."""


def read_thresholds(table: Mapping[str, Any], path: str | None = None) -> Thresholds:
    """Read the ``simulate`` table of a configuration file.

    Args:
        table: Values by present or old threshold name, with ``-`` for ``_``; the others keep
            their defaults.
        path: The file, for messages.

    Raises:
        ConfigError: A name is unknown, or a value is not a number above zero.
    """
    types = {field.name: type(field.default) for field in fields(Thresholds)}
    found: dict[str, Any] = {}
    for key, value in table.items():
        name = RENAMED_THRESHOLDS.get(key, key).replace("-", "_")
        if name not in types:
            raise ConfigError(
                f"simulate has no threshold '{key}'{_format_hint(key, types)}", path=path
            )
        whole = types[name] is int
        if isinstance(value, bool) or not isinstance(value, int if whole else int | float):
            kind = "a whole number" if whole else "a number"
            raise ConfigError(f"simulate.{key} must be {kind}", path=path)
        if not 0 < value < math.inf:
            raise ConfigError(f"simulate.{key} must be above zero and finite", path=path)
        found[name] = value
    return Thresholds(**found)


def _format_hint(key: str, names: Mapping[str, type]) -> str:
    known = [name.replace("_", "-") for name in names]
    return suggest_name(key, known, 0.5) or "; docs/configuration.md lists them"
