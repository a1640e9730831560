"""A model with merged links against the same one without: frames, masses, shapes, contacts."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ..check import Check
from ..mechanics import Array
from .compiled import Compiled

FRAME = 1e-9


def fuse_check(
    links: Sequence[str],
    plain: Compiled,
    fused: Compiled,
    configurations: Sequence[Mapping[str, float]],
) -> Check:
    """Compare a model whose links are merged with one in which each is a body.

    Args:
        links: The names of the links.
        plain: The model with a body for each link.
        fused: The model whose merged links are sites.
        configurations: Positions of the joints by name [rad or m].
    """
    check = Check(
        "fused", "merged and whole model: frames, mass matrix, shapes, contacts, sensors", FRAME
    )
    for what in ("nq", "nv", "nu", "neq", "nsensor", "ngeom", "ncam", "nlight"):
        same = getattr(plain.model, what) == getattr(fused.model, what)
        check.compare(0 if same else math.inf, f"{what} of MuJoCo's model")
    if check.differing:
        return check
    for positions in configurations:
        for compiled in (plain, fused):
            compiled.pose(positions)
        for link in links:
            expected, found = plain.frame(link), _frame(fused, link)
            off = math.inf
            if expected is not None and found is not None:
                off = float(abs(found - expected).max())
            check.compare(off, f"frame of link '{link}'")
        for site in range(plain.model.nsite):
            name = plain.name("SITE", site)
            number = fused.id("SITE", name)
            off = math.inf
            if number >= 0:
                off = float(abs(plain.site_frame(site) - fused.site_frame(number)).max())
            check.compare(off, f"site '{name}'")
        everything = list(range(plain.model.nv))
        one, other = plain.mass_matrix(everything), fused.mass_matrix(everything)
        check.compare(_relative(one, other) * FRAME / plain.tensor_rounding, "the mass matrix")
        check.compare(_relative(plain.data.qfrc_bias, fused.data.qfrc_bias), "gravity")
        check.compare(_relative(*(_shapes(c) for c in (plain, fused))), "place of a shape")
    for pair in _touching(plain) ^ _touching(fused):
        check.compare(math.inf, f"contact of shapes {sorted(pair)}")
    return check


def _frame(compiled: Compiled, link: str) -> Array | None:
    """The pose of a link in the root's frame: of its body, or of the site of its name."""
    if compiled.body(link) >= 0:
        return compiled.frame(link)
    for name in (link, f"{link}_frame"):
        site = compiled.id("SITE", name)
        if site >= 0:
            return compiled.site_frame(site)
    return None


def _shapes(compiled: Compiled) -> Array:
    """Kind, group, size and place of every shape, in an order that bodies have no part in."""
    model = compiled.model
    rows = [
        [
            float(model.geom_type[geom]), float(model.geom_group[geom]), *model.geom_size[geom],
            *compiled.geom_frame(geom)[:3].ravel(),
        ]
        for geom in range(model.ngeom)
    ]  # fmt: skip
    table = np.array(rows).reshape(len(rows), -1)
    order = np.lexsort(np.round(table, 6).T)
    sorted_table: Array = table[order]
    return sorted_table


def _touching(compiled: Compiled) -> set[tuple[str, str]]:
    """Pairs of shapes, by name, that can touch; MuJoCo's filters are applied by rigid body."""
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


def _relative(one: Array, other: Array) -> float:
    if one.shape != other.shape:
        return math.inf
    size = max(float(abs(one).max(initial=0.0)), 1e-12)
    return float(abs(one - other).max(initial=0.0)) / size
