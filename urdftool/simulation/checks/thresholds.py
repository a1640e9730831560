"""Every threshold of a verdict in one place, and how a configuration file changes them.

Lengths marked [size] are parts of the robot's size, the largest extent of its collision geometry at
the start. The sources are:

- *physics*, *geometry*: follows from the stated fact;
- *contact*: above what hulls, contact margins and rounded files add (up to 1 mm in PyBullet);
- *chosen*: no derivation; the verdicts in ``docs/simulate-robots.md``, on robots of two collections
  and on planted defects, were made with this number.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from ...errors import ConfigError
from ...suggestions import suggest_name
from ..old_names import RENAMED_THRESHOLDS
from ..rigid_bodies import TENSOR_ROUNDING


@dataclass(frozen=True)
class Thresholds:
    """Bounds beyond which something is reported; the unit of each is in brackets."""

    # --- at rest: read by the engine's process --------------------------------------------------

    settle_window: float = 0.5
    """How long nothing may move for a robot to be at rest [s]. Source: chosen."""
    settle_min_time: float = 1.5
    """The least simulated time [s]. Source: physics; what balances falls slowly at first, and the
    nudge that starts it ends at 0.2 s."""
    settle_creep: float = 0.002
    """The most that a body's origin moves within the window at rest [size]. Source: chosen."""
    settle_turn: float = 0.01
    """The most that a body, or a turning joint, turns within the window [rad]. Source: chosen."""
    settle_slide: float = 0.01
    """The most that a sliding joint moves within the window [m]. Source: chosen; bodies on it are
    bounded by ``settle_creep`` as well."""

    # --- final state ----------------------------------------------------------------------------

    fall_sizes: float = 2.0
    """How far below its start a robot without support has fallen through [size]. Source: chosen."""
    fall_depth: float = 0.5
    """The least such depth [m]. Source: chosen."""
    energy_gain: float = 0.5
    """Energy gained of a run that diverged, over what lifting the robot by its size takes [1].
    Source: chosen; motors that hold a pose add little energy."""
    tip_tilt: float = math.radians(30)
    """Tilt of the root's upright axis that counts as tipped over [rad]. Source: chosen."""
    lean_tilt: float = math.radians(10)
    """Tilt that is reported [rad]. Source: chosen."""
    slide_distance: float = 0.05
    """Drift of the root along the plane that is reported [size]. Source: chosen."""
    slide_failure: float = 0.5
    """Drift that fails on a level plane [size]. Source: chosen."""
    wheel_turn: float = 0.05
    """How far a wheel turned that rolled [rad]. Source: chosen."""
    start_height: float = 0.003
    """How much higher than the lowest link a link is that the robot starts on [size]. Source:
    contact."""
    footprint_height: float = 0.001
    """How much higher than the lowest point of its body a corner is that touches [size]. Source:
    contact."""
    arm_joints: int = 4
    """Turning joints in one chain from the root that make a manipulator [1]. Source: chosen."""

    # --- why a robot does not come to rest --------------------------------------------------------

    yield_turn: float = 0.05
    """How far a turning joint is off its target that yields [rad]. Source: as
    ``joint_drift_turn``."""
    yield_slide: float = 0.05
    """How far a sliding joint is off its target that yields [m]. Source: chosen."""
    moving_rate: float = 1e-3
    """How fast a turning joint is that moves [rad/s]. Source: chosen."""
    moving_speed: float = 1e-3
    """How fast a sliding joint is that moves [m/s]. Source: chosen."""
    creep_speed: float = 0.01
    """The highest speed of creep [size/s]. Source: chosen."""
    creep_rate: float = 0.05
    """The highest rate of creep [rad/s]. Source: chosen."""
    full_effort: float = 0.99
    """The part of its effort limit that a saturated joint uses [1]. Source: physics; rounding."""

    # --- support ----------------------------------------------------------------------------------

    support_margin: float = 0.05
    """How far outside the support polygon the center of mass of a robot at rest may be [size].
    Source: contact; the polygon is known only as well as contacts are."""
    support_margin_min: float = 0.005
    """The least such distance [m]. Source: contact."""
    carried_weight: float = 0.8
    """The least part of its weight that the ground carries of a robot at rest [1]. Source: physics;
    it carries all, and samples vary."""
    supporting_parts: int = 2
    """The fewest wheels, or feet, of a robot that stands on them [1]. Source: geometry."""

    # --- contact ----------------------------------------------------------------------------------

    ground_depth: float = 0.01
    """How deep a robot may be in the ground [size]. Source: chosen."""
    contact_depth: float = 0.002
    """The least depth of a contact that counts [m]. Source: contact."""
    ground_gap: float = 0.002
    """How near to the ground a part is that should touch it [m]. Source: contact."""
    foot_protrusion: float = 0.001
    """How far a visual extends below the collision geometry of its foot [m]. Source: contact."""
    submerged_visual: float = 0.4
    """The part of a visual's height that may be below the ground [1]. Source: chosen."""
    small_collision: float = 0.5
    """The extent of a collision that is much smaller than its visual, over the visual's [1].
    Source: chosen."""

    # --- interpenetration -------------------------------------------------------------------------

    overlap_depth: float = 0.005
    """Depth of an overlap that is reported [size]. Source: contact."""
    overlap_failure: float = 0.25
    """Depth that fails, over the smallest extent of the thinner body [1]. Source: chosen."""
    compound_joint: float = 0.5
    """Distance of joints that act as one, over the extent of the smaller body [1]. Source: chosen;
    universal and ball joints are written as joints at one point."""
    overlap_turn: float = 0.05
    """How far a joint turned that took parts into each other [rad]. Source: as
    ``joint_drift_turn``."""
    overlap_slide: float = 0.05
    """How far a joint slid that took parts into each other [m]. Source: chosen."""
    mechanism_variation: float = 0.25
    """How much an overlap varies that stays the same along the motion, over its depth [1]. Source:
    chosen."""
    mechanism_depth: float = 0.002
    """The same as a length [m]. Source: contact."""
    rod_length: float = 2.0
    """Length of a rod or cylinder over its width, at least [1]. Source: chosen."""
    rod_angle: float = math.radians(5)
    """Angle between the axes of a rod and its cylinder, at most [rad]. Source: chosen."""
    rod_width: float = 0.8
    """Width of a rod over that of its cylinder, at most [1]. Source: chosen."""
    rod_offset: float = 0.25
    """Distance of a rod's center from its cylinder's axis, over the thinner width [1]. Source:
    chosen."""

    # --- misplaced collision geometry -------------------------------------------------------------

    copy_size: float = 0.05
    """How much the extents of a visual and its copy as collision may differ [1]. Source: chosen."""
    copy_offset: float = 0.25
    """How far a copy is off its visual, over the visual's extent [1]. Source: chosen."""
    box_overlap: float = 0.5
    """How much of the smaller bounding box is in the other, along each axis, at least [1]. Source:
    chosen."""
    housing_size: float = 0.8
    """Extent of a motor housing over that of its link's visual, at most [1]. Source: chosen."""
    housing_offset: float = 0.25
    """Distance of a housing's center from its joint, over its extent [1]. Source: chosen."""
    neighbor_overlap: float = 0.1
    """How much of the smaller of two neighbors is in both, at least [1]. Source: chosen."""
    neighbor_gain: float = 0.2
    """How much more of it is in both by collision geometry than by visuals [1]. Source: chosen."""
    neighbor_growth: float = 0.05
    """How much more a centered collision may share with its neighbor [1]. Source: chosen."""
    better_fit: float = 0.2
    """How much more of a collision is in its visual if it is centered on it [1]. Source: chosen."""
    outside_visuals: float = 0.15
    """How much of a misplaced collision is in no visual, of its link or the other [1]. Source:
    chosen."""
    unlike_overlap: float = 0.45
    """How much of the smaller of collision and visual is in both, if one is misplaced, at most [1].
    Source: chosen."""

    # --- joints -----------------------------------------------------------------------------------

    joint_drift_turn: float = 0.05
    """How far a held turning joint may be off its target [rad]. Source: chosen; 50 mm at 1 m."""
    joint_drift_slide: float = 0.05
    """How far a held sliding joint may be off its target [size]. Source: chosen."""
    limit_turn: float = 0.02
    """How far a turning joint may be beyond a limit [rad]. Source: chosen; limits are soft."""
    limit_slide: float = 0.02
    """How far a sliding joint may be beyond a limit [size]. Source: chosen; limits are soft."""
    near_effort: float = 0.9
    """The part of its effort limit that a joint may use to stand [1]. Source: chosen."""
    wheel_offset: float = 0.01
    """How far from its axis the center of mass of a wheel is, at most [size]. Source: chosen."""
    collapse_depth: float = 0.05
    """How far a robot, or what a joint carries, sank that collapsed [size]. Source: chosen."""
    collapse_share: float = 0.01
    """How far one joint moves what it carries, to be the cause [size]. Source: chosen."""
    collapse_turn: float = 0.05
    """How far a joint turned that gave way [rad]. Source: as
    ``joint_drift_turn``."""
    collapse_slide: float = 0.05
    """How far a joint slid that gave way [size]. Source: chosen."""

    # --- controllers ------------------------------------------------------------------------------

    oscillation_reversals: int = 4
    """Changes of direction in the last second of a joint that shakes [1]. Source: chosen."""
    oscillation_turn: float = 0.01
    """Peak to peak, of a turning joint [rad]. Source: chosen."""
    oscillation_slide: float = 0.01
    """Peak to peak, of a sliding joint [size]. Source: chosen."""
    saturated_effort: float = 0.98
    """The part of its effort limit that a saturated controller uses [1]. Source: physics; it is
    clipped, and samples vary."""
    damping_ratio: float = 0.1
    """Damping over critical damping, below which nothing damps [1]. Source: physics; at 0.1 an
    oscillation halves with each cycle."""

    # --- the model --------------------------------------------------------------------------------

    tensor_excess: float = TENSOR_ROUNDING
    """How far a tensor may exceed the triangle inequality [1]. Source: physics; rounded files."""
    gyration_reach: float = 1.2
    """Radius of gyration over the reach of the shapes, at most [1]. Source: physics; at most 1, and
    shapes leave out small parts."""
    light_gyration_reach: float = 3.0
    """The same of a link lighter than ``light_link`` [1]. Source: chosen."""
    axis_spread: float = 2.0
    """Spread of the mass along an axis over half the extent of the shapes, at most [1]. Source:
    physics; two lumps at the ends have 1, a rod 0.58, and shapes leave out small parts."""
    axis_overhang: float = 0.5
    """The least such spread, over the longest half extent [1]. Source: chosen; a motor may extend
    beyond a thin box."""
    sheet_thickness: float = 0.05
    """The least half extent, over the longest [1]. Source: chosen; sheets are modeled flat."""
    placeholder_ratio: float = 2.0
    """A tensor of equal powers of ten, over that of a solid box, at least [1]. Source: chosen."""
    heavy_link: float = 0.1
    """Mass of a heavy link over the robot's [1]. Source: chosen."""
    light_link: float = 0.02
    """Mass of a light link over the robot's [1]. Source: chosen; cameras and frames."""
    dominant_inertia: float = 0.5
    """Trace of a link's tensor over its body's that dominates it [1]. Source: geometry; half."""
    massless_share: float = 0.5
    """Volume of a link without mass over its body's that is reported [1]. Source: geometry."""
    massless_part: float = 0.05
    """The same over the robot's, if the link collides [1]. Source: chosen."""
    hollow_density: float = 20.0
    """The least density of hulls that a separate inertial stands for [kg/m³]. Source: chosen."""

    # --- two engines ------------------------------------------------------------------------------

    differ_length: float = 0.01
    """How much heights and sliding joints of two engines may differ [size]. Source: chosen."""
    differ_length_min: float = 1e-3
    """The least such difference [m]. Source: contact."""
    differ_angle: float = math.radians(1)
    """How much tilts and turning joints may differ [rad]. Source: chosen."""
    differ_margin: float = 0.02
    """Static margin below which balance may be a cause [size]. Source: chosen."""


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
