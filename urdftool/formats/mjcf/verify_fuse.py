"""Comparison of a model with merged links with the unmerged model."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ...compare.check import Check
from ...mechanics.reference import Array
from .compiled import Compiled

FRAME = 1e-9
"""Tolerance of poses [m, rad]. Chosen, no source."""

SAME_TURN = 2e-6
"""Largest turn [rad] that MuJoCo's compiler rounds away: it takes the body's rotation for that of a
site whose quaternion differs by less than 1e-6 (``mjSAMEFRAME``; measured with MuJoCo 4.0)."""

FAMILIES = ("jnt_", "dof_", "actuator_", "sensor_", "key_", "mat_", "tex_", "numeric_", "eq_sol",
            "eq_active", "eq_type", "cam_fovy", "cam_resolution", "cam_mode", "light_diffuse",
            "light_specular", "light_type", "light_cutoff", "light_active")  # fmt: skip
"""Prefixes of the fields of MuJoCo's model that merging does not change."""

COUNTED = ("id", "adr", "num", "invweight0", "length", "length0", "acc0", "M0", "lengthrange")
"""Suffixes of fields that hold body indices, or that MuJoCo derives."""

OF_GEOMS = (
    "contype", "conaffinity", "condim", "friction", "solref", "solimp", "margin", "gap",
    "priority", "solmix", "rgba", "matid",
)  # fmt: skip


def fuse_check(
    links: Sequence[str],
    plain: Compiled,
    fused: Compiled,
    configurations: Sequence[Mapping[str, float]],
) -> Check:
    """Compare a model with merged links with one in which each link is a body."""
    check = Check(
        "fused",
        "merged and whole model: frames, masses, shapes, contacts, joints, actuators, sensors, key",
        FRAME,
    )
    for what in ("nq", "nv", "nu", "neq", "nsensor", "ngeom", "ncam", "nlight"):
        same = getattr(plain.model, what) == getattr(fused.model, what)
        check.compare(0 if same else math.inf, f"{what} of MuJoCo's model")
    if check.differing:
        return check
    for positions in configurations:
        for compiled in (plain, fused):
            compiled.set_pose(positions)
        for link in links:
            taken = plain.get_id("SITE", link) >= 0  # by a sensor or frame
            name = f"{link}_frame" if taken else link
            expected, found = plain.get_frame(link), _get_frame(fused, link, name)
            off = math.inf
            if expected is not None and found is not None:
                off = _measure_apart(expected, found)
            check.compare(off, f"frame of link '{link}'")
        for site in range(plain.model.nsite):
            name = plain.name("SITE", site)
            number = fused.get_id("SITE", name)
            off = math.inf
            if number >= 0:
                off = _measure_apart(plain.get_site_frame(site), fused.get_site_frame(number))
            check.compare(off, f"site '{name}'")
        everything = list(range(plain.model.nv))
        one, other = plain.compute_mass_matrix(everything), fused.compute_mass_matrix(everything)
        check.compare(
            _compute_relative(one, other) * FRAME / plain.tensor_rounding, "the mass matrix"
        )
        check.compare(_compute_relative(plain.data.qfrc_bias, fused.data.qfrc_bias), "gravity")
        check.compare(_get_unlike(*(_get_shapes(c) for c in (plain, fused))), "a shape")
        for compiled in (plain, fused):
            compiled.mujoco.mj_passive(compiled.model, compiled.data)
        force = plain.data.qfrc_passive, fused.data.qfrc_passive
        check.compare(_compute_relative(*force), "springs or gravity flags")
    compare_fields(plain, fused, check)
    for pair in _get_touching(plain) ^ _get_touching(fused):
        check.compare(math.inf, f"contact of shapes {sorted(pair)}")
    return check


def compare_fields(
    plain: Compiled, fused: Compiled, check: Check, families: tuple[str, ...] = FAMILIES
) -> None:
    """Compare joints, actuators, sensors, keys, materials and options field by field."""
    for name in dir(plain.model):
        if not name.startswith(families) or name.endswith(COUNTED):
            continue
        one, other = getattr(plain.model, name), getattr(fused.model, name)
        if isinstance(one, np.ndarray):
            same = one.shape == other.shape and np.allclose(one, other, rtol=1e-6, atol=1e-12)
            check.compare(0 if same else math.inf, f"{name} of MuJoCo's model")
    for name, value in plain.written_options.items():
        same = bool(np.array_equal(value, fused.written_options[name]))
        check.compare(0 if same else math.inf, f"option {name}")
    for number in range(plain.model.nu):
        joints = [c.name("JOINT", int(c.model.actuator_trnid[number][0])) for c in (plain, fused)]
        check.compare(0 if joints[0] == joints[1] else math.inf, f"joint of actuator {number}")
    for number in range(plain.model.nsensor):
        names = [_name_measured(compiled, number) for compiled in (plain, fused)]
        check.compare(0 if names[0] == names[1] else math.inf, f"object of sensor {number}")
    for number in range(plain.model.ncam):
        other = fused.get_id("CAMERA", plain.name("CAMERA", number))
        off = math.inf
        if other >= 0:
            off = float(abs(plain.get_camera_frame(number) - fused.get_camera_frame(other)).max())
        check.compare(off, f"camera '{plain.name('CAMERA', number)}'")


def _get_frame(compiled: Compiled, link: str, name: str) -> Array | None:
    """Return the pose of a link in the root's frame, of its body or of a site; None without."""
    if compiled.get_body(link) >= 0:
        return compiled.get_frame(link)
    site = compiled.get_id("SITE", name)
    return compiled.get_site_frame(site) if site >= 0 else None


def _measure_apart(one: Array, other: Array) -> float:
    """Measure how far two frames are apart [m, rad], except for turns up to ``SAME_TURN``."""
    change = abs(one - other)
    turn = float(change[:3, :3].max())
    return max(float(change[:3, 3].max()), turn if turn > SAME_TURN else 0.0)


def _get_shapes(compiled: Compiled) -> Array:
    """Return kind, group, size, pose, contact and appearance of every geom, one row each."""
    model = compiled.model
    rows = [
        [
            float(model.geom_type[geom]), float(model.geom_group[geom]), *model.geom_size[geom],
            *compiled.get_geom_frame(geom)[:3].ravel(),
            *(
                float(value)
                for field in OF_GEOMS
                for value in np.ravel(getattr(model, f"geom_{field}")[geom])
            ),
        ]
        for geom in range(model.ngeom)
    ]  # fmt: skip
    table: Array = np.array(rows)
    return table


def _get_unlike(one: Array, other: Array) -> float:
    """Return the largest difference between the rows of two tables, matched to the nearest row."""
    if one.shape != other.shape:
        return math.inf
    left, worst = list(range(len(other))), 0.0
    for row in one:
        distances = abs(other[left] - row).max(axis=1)
        nearest = int(distances.argmin())
        worst = max(worst, float(distances[nearest]))
        del left[nearest]
    return worst


def _get_touching(compiled: Compiled) -> set[tuple[str, str]]:
    """Return the pairs of geoms, by name, that rigid bodies and exclusions let collide."""
    model = compiled.model
    excluded = {int(signature) for signature in model.exclude_signature}
    solid = [
        geom
        for geom in range(model.ngeom)
        if (model.geom_contype[geom] or model.geom_conaffinity[geom])
    ]
    pairs = []
    for index, one in enumerate(solid):
        for other in solid[index + 1 :]:
            bodies = int(model.geom_bodyid[one]), int(model.geom_bodyid[other])
            welds = [int(model.body_weldid[body]) for body in bodies]
            if welds[0] == welds[1] or (min(bodies) << 16) + max(bodies) in excluded:
                continue
            pairs.append((compiled.name("GEOM", one), compiled.name("GEOM", other)))
    return {(min(pair), max(pair)) for pair in pairs}


def _compute_relative(one: Array, other: Array) -> float:
    if one.shape != other.shape:
        return math.inf
    size = max(float(abs(one).max(initial=0.0)), 1e-12)
    return float(abs(one - other).max(initial=0.0)) / size


def _name_measured(compiled: Compiled, sensor: int) -> tuple[str, str]:
    """Return type and name of the object that a sensor measures."""
    kind = compiled.mujoco.mjtObj(int(compiled.model.sensor_objtype[sensor])).name
    kind = kind.removeprefix("mjOBJ_")
    return kind, compiled.name(kind, int(compiled.model.sensor_objid[sensor]))
