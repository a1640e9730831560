"""Links that interpenetrate at home in the compiled model: detected, reported, and excluded.

MuJoCo pushes interpenetrating bodies apart, so such a robot never holds still at its home
configuration. The interpenetration may be in the collision geometry as authored, or only in the
convex hulls that MuJoCo computes for its meshes.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path

from lxml import etree

from ...errors import MissingDependency
from ...listing import list_first
from ...model.mechanism import ContactExclusion
from ...mujoco_library import import_mujoco
from ..written import Written
from .body import Bodies
from .compiled import compile_file
from .meshes import Assets
from .options import Options
from .structure import Structure

OVERLAP = 1e-3
"""Penetration depth [m] above which two links overlap; less is a contact, as of closed fingers."""

MOST_GEOMS = 2000
"""Number of collision geoms up to which overlaps are looked for: MuJoCo stores each contact, and
geoms at one place need memory for the square of their number. Robots have up to some hundred."""

SHOWN = 8
"""Maximum number of pairs that the warning lists. Chosen, no source."""


@dataclass(frozen=True)
class Pair:
    """Two links that interpenetrate in the compiled model.

    Attributes:
        one: Name of the first link.
        other: Name of the second link.
        depth: Penetration depth in MuJoCo [m].
        authored: Penetration depth of the authored geometry [m]; None if it was not measured, or if
            without meshes ``depth`` is exact.
    """

    one: str
    other: str
    depth: float
    authored: float | None = None

    @property
    def is_of_hulls(self) -> bool:
        """Tell whether only the convex hulls overlap."""
        return self.authored is not None and self.authored < OVERLAP


def exclude_overlapping(
    structure: Structure,
    positions: Mapping[str, float],
    sections: dict[str, etree._Element],
    bodies: Bodies,
    assets: Assets,
    options: Options,
    written: Written,
) -> None:
    """Find overlaps at home, report them, and exclude the pairs if the user chose so.

    Do nothing if MuJoCo is not installed.
    """
    if options.exclude != "touching" and options.overlap is None:
        return
    try:
        import_mujoco("--verify")
    except MissingDependency:
        return
    try:
        deepest = _find_overlaps(sections, bodies, assets, positions, written)
    except _NotChecked as error:
        written.report_loss(
            "overlap",
            f"overlaps of links at home are not looked for: {error}",
            structure.robot.place,
            hint="'urdftool lint' reports overlaps of links at rest",
        )
        return
    measure = options.overlap
    pairs = [
        Pair(
            *links,
            depth,
            None if measure is None else measure(structure.robot, positions, *links),
        )
        for links, depth in sorted(deepest.items(), key=lambda item: -item[1])
    ]
    if not pairs:
        return
    if options.exclude == "touching":
        contact = sections.setdefault("contact", etree.Element("contact"))
        for pair in pairs:
            names = (bodies[link].get("name", "world") for link in (pair.one, pair.other))
            body1, body2 = names
            etree.SubElement(contact, "exclude", body1=body1, body2=body2)
            structure.robot.exclusions.append(ContactExclusion(None, pair.one, pair.other))
    _report(structure, pairs, options, written)


class _NotChecked(Exception):  # noqa: N818 -- reads as what happened
    """Reason why overlaps are not looked for."""


def _find_overlaps(
    sections: Mapping[str, etree._Element],
    bodies: Bodies,
    assets: Assets,
    positions: Mapping[str, float],
    written: Written,
) -> dict[tuple[str, str], float]:
    """Find the pairs of links that overlap, with their penetration depths [m].

    Raises:
        OutputError: The model does not compile.
        _NotChecked: The model has too many geoms, or MuJoCo has not enough memory for its contacts.
    """
    with tempfile.TemporaryDirectory(prefix="urdftool-") as place:
        path = Path(place) / "home.xml"
        model, files = _copy_collision_model(sections, assets)
        count = sum(1 for _ in model.iter("geom"))
        if count > MOST_GEOMS:
            raise _NotChecked(f"the model has {count} geoms, more than the limit of {MOST_GEOMS}")
        path.write_bytes(etree.tostring(model))
        for name in files & written.files.keys():
            content, target = written.files[name], Path(place) / name
            target.parent.mkdir(parents=True, exist_ok=True)
            if isinstance(content, bytes):
                target.write_bytes(content)
            else:
                shutil.copyfile(content, target)
        compiled, _ = compile_file(path)
    mujoco = import_mujoco("--verify")
    data = mujoco.MjData(compiled)
    for joint in range(compiled.njnt):
        if compiled.jnt_type[joint] >= int(mujoco.mjtJoint.mjJNT_SLIDE):
            name = mujoco.mj_id2name(compiled, mujoco.mjtObj.mjOBJ_JOINT, joint)
            data.qpos[compiled.jnt_qposadr[joint]] = positions.get(name, 0.0)
    try:
        mujoco.mj_forward(compiled, data)
    except mujoco.FatalError as error:
        raise _NotChecked(f"MuJoCo stops: {' '.join(str(error).split())}") from None
    link_of = {body.get("name", "world"): link for link, body in bodies.items()}
    found: dict[tuple[str, str], float] = {}
    for number in range(data.ncon):
        contact = data.contact[number]
        names = [
            mujoco.mj_id2name(compiled, mujoco.mjtObj.mjOBJ_BODY, int(compiled.geom_bodyid[geom]))
            for geom in contact.geom
        ]
        one, other = sorted(link_of[name] for name in names)
        if -contact.dist >= OVERLAP:
            found[one, other] = max(found.get((one, other), 0.0), -float(contact.dist))
    return found


def _copy_collision_model(
    sections: Mapping[str, etree._Element], assets: Assets
) -> tuple[etree._Element, set[str]]:
    """Copy the collision geometry of a model, without classes; return it and its mesh files."""
    root = etree.Element("mujoco")
    for name in ("compiler", "option", "worldbody", "contact"):
        if name in sections:
            root.append(deepcopy(sections[name]))
    for geom in list(root.iter("geom")):
        parent = geom.getparent()
        if geom.get("class") == "visual" and parent is not None:
            parent.remove(geom)
    etree.strip_attributes(root, "class", "childclass", "material")
    used = {geom.get("mesh") for geom in root.iter("geom")}
    compiler = sections["compiler"]
    files = set()
    section = etree.SubElement(root, "asset")
    for mesh in assets.elements:
        if _format_mesh_name(mesh) in used:
            section.append(deepcopy(mesh))
            files.add("/".join(filter(None, (compiler.get("meshdir"), mesh.get("file")))))
    return root, files


def _format_mesh_name(mesh: etree._Element) -> str:
    return mesh.get("name") or mesh.get("file", "").rpartition(".")[0]


def _report(structure: Structure, pairs: list[Pair], options: Options, written: Written) -> None:
    authored = [pair for pair in pairs if not pair.is_of_hulls]
    hulls = [pair for pair in pairs if pair.is_of_hulls]
    parts = []
    if authored:
        parts.append(_format_named(authored))
    if hulls:
        parts.append(
            f"only by the convex hulls that MuJoCo makes of their meshes {_format_named(hulls)}"
        )
    does = (
        ", and are excluded from contact"
        if options.exclude == "touching"
        else ", and MuJoCo pushes them apart (--exclude touching excludes them)"
    )
    count = f"{len(pairs)} pairs of links overlap" if len(pairs) > 1 else "2 links overlap"
    hints = []
    if hulls and not options.decompose:
        hints.append("--decompose collides such meshes as convex pieces")
    if authored:
        hints.append("'urdftool collision --check' shows where the geometry is too large")
    written.report_loss(
        "overlap",
        f"{count} at home{does}: {'; '.join(parts)}",
        structure.robot.place,
        hint="; ".join(hints),
        data={"pairs": [(pair.one, pair.other) for pair in pairs]},
    )


def _format_named(pairs: list[Pair]) -> str:
    named = [f"'{p.one}' and '{p.other}' {p.depth * 1000:.3g} mm" for p in pairs]
    return list_first(named, SHOWN)
