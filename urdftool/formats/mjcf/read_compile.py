"""Compilation of an MJCF model in a process of its own, and its values as plain data.

Names, files and lines are those of ``MjSpec``, which is the text with defaults resolved; numbers
are those of the compiled model. Angles are in radians, quaternions are ``(w, x, y, z)``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from typing import Any

from ...dependencies import Dependencies
from ...errors import SourceError
from ...limited import Limits, open_no_files
from ...model.settings import RESISTANCE, SURFACE_OF_MUJOCO
from ...model.world_settings import OF_MUJOCO
from ...mujoco_library import import_mujoco
from ...workspace import Workspace
from .read_assets import read_assets
from .read_native_table import KINDS

Row = dict[str, Any]

LIMITS = Limits(time=300.0, processor=15.0, memory=640 << 20)
"""Limits of a compilation. Chosen so that a command with small files stays below 20 s and 1 GiB; no
source.

Files get more memory, by ``FOR_FILES``.
"""

FOR_FILES = 24
"""Memory for each byte of the files of a model [bytes]; models with 26, 36 and 43 MB of meshes need
up to 24. Chosen."""

MOST_MEMORY = 2 << 30
"""Maximum memory of a compilation [bytes]. Chosen, no source."""

_LINE = re.compile(r"line\D{0,3}(\d+)", re.IGNORECASE)

_NO_MEMORY = re.compile("allocate memory")
"""Error of MuJoCo when memory is exhausted, with or without the element that it was for."""

_NO_REASON = re.compile("unknown exception")
"""Error of MuJoCo's bindings for exceptions of C++, without a line when memory is exhausted."""

_NO_MEMORY_FOR_IMAGE = re.compile("PNG file.*memory allocation failed")
"""Error of MuJoCo for an image, also if it names the line of the texture."""

_ASSET = re.compile(r"asset-\d+[\w.]*")


@dataclass
class Compiled:
    """Values of a compiled model: a list of rows by kind, each with ``name`` and ``line``.

    Attributes:
        name: Name of the model.
        rows: Rows of values by kind; their order is that of the compiled model.
        keys: Name and generalized positions of each keyframe.
        warnings: Warnings of the compiler.
        values: Values of the elements of each section of ``KINDS``, in their order.
        poses: Generalized positions of the free and ball joints in each keyframe.
        written: Line and name of the elements of each section of ``KINDS``.
        discards_visuals: Whether MuJoCo removes visuals, which are kept here.
        error: Reason why it does not compile; empty if it does.
        error_line: Line of the error; 0 if unknown.
        error_file: Name of the file that cannot be read.
    """

    name: str
    rows: dict[str, list[Row]]
    keys: list[tuple[str, list[float]]]
    warnings: list[str]
    values: dict[str, list[dict[str, tuple[float, ...]]]] = field(default_factory=dict)
    poses: list[tuple[float, ...]] = field(default_factory=list)
    written: dict[str, list[tuple[int, str]]] = field(default_factory=dict)
    discards_visuals: bool = False
    error: str = ""
    error_line: int = 0
    error_file: str = ""


def compile_text(
    text: str, models: Mapping[str, bytes], paths: dict[str, str], folder: str, workspace: Workspace
) -> tuple[Compiled, Dependencies]:
    """Compile a model, and return the files that were read."""
    view = workspace.with_record()
    assert view.dependencies is not None
    try:
        assets = read_assets(paths, folder, view)
    except SourceError as error:
        missing = Compiled("", {}, [], [], error=error.message, error_file=error.data["name"])
        return missing, view.dependencies
    return _compile(text, models, assets, paths), view.dependencies


def _compile(
    text: str, models: Mapping[str, bytes], assets: dict[str, bytes], paths: dict[str, str]
) -> Compiled:
    import warnings

    mujoco = import_mujoco()
    texts: list[str] = []
    mujoco.set_mju_user_warning(texts.append)  # else MuJoCo writes a log file
    try:
        with warnings.catch_warnings(record=True) as caught, open_no_files():
            warnings.simplefilter("always")
            options = {"include": dict(models)} if models else {}
            spec = mujoco.MjSpec.from_string(text, assets=assets, **options)
            discards = bool(spec.compiler.discardvisual)
            _keep_all(spec)
            model = spec.compile()
    except (ValueError, RuntimeError, mujoco.FatalError) as error:
        error_text = str(error)
        line = _LINE.search(error_text)
        exhausted = _NO_MEMORY_FOR_IMAGE.search(error_text) or _NO_MEMORY.search(error_text)
        if exhausted or (_NO_REASON.search(error_text) and not line):
            raise MemoryError from None
        reason = " ".join(_LINE.sub("", error_text).split()).strip(" ,")
        for name in set(_ASSET.findall(reason)):
            reason = reason.replace(name, paths.get(name, name))
        at = int(line[1]) if line else 0
        return Compiled("", {}, [], texts, error=reason, error_line=at)
    texts += [str(warning.message) for warning in caught]
    rows = {kind: read(spec, model, mujoco) for kind, read in _READERS.items()}
    for row in (*rows["mesh"], *rows["material"]):
        for name in {"file", "texture"} & row.keys():
            row[name] = paths.get(row[name], "")
    names = [key.name for key in spec.keys]
    keys = [(names[i], model.key_qpos[i].tolist()) for i in range(model.nkey)]
    values = {tag: _list_numbers_of(spec, model, *kind) for tag, kind in KINDS.items()}
    poses = _list_poses(model, mujoco)
    written = {
        tag: [(_get_line(one), str(one.name)) for one in getattr(spec, elements)]
        for tag, (_, elements) in KINDS.items()
    }
    texts = list(dict.fromkeys(texts))
    return Compiled(spec.modelname, rows, keys, texts, values, poses, written, discards)


def _list_poses(model: Any, mujoco: Any) -> list[tuple[float, ...]]:
    """Return the generalized positions of free and ball joints in each keyframe."""
    sizes = {int(mujoco.mjtJoint.mjJNT_FREE): 7, int(mujoco.mjtJoint.mjJNT_BALL): 4}
    spans = [
        (int(at), sizes[int(kind)])
        for kind, at in zip(model.jnt_type, model.jnt_qposadr, strict=True)
        if int(kind) in sizes
    ]
    return [
        tuple(float(value) for at, size in spans for value in row[at : at + size])
        for row in model.key_qpos
    ]


_PLACES = re.compile(r"(id|adr|num|geom[12]|plugin|signature|length0|acc0|weight0)$")
"""Fields of MuJoCo's model that are numbers or hashes of other elements, or computed of joints."""


def _list_numbers_of(
    spec: Any, model: Any, prefix: str, elements: str
) -> list[dict[str, tuple[float, ...]]]:
    """Return all values of each element of a kind, by the names of MuJoCo's fields."""
    count = len(getattr(spec, elements))
    names = [n for n in dir(model) if n.startswith(f"{prefix}_") and not _PLACES.search(n)]
    fields = {name: getattr(model, name) for name in names}
    return [
        {n: tuple(map(float, v[i].ravel())) for n, v in fields.items() if len(v) == count}
        for i in range(count)
    ]


def _keep_all(spec: Any) -> None:
    """Keep bodies, geoms and frames that the compiler's settings remove or move."""
    spec.compiler.fusestatic = False
    spec.compiler.discardvisual = False
    spec.compiler.alignfree = False
    for joint in spec.joints:
        joint.align = 0


def _get_line(element: Any) -> int:
    found = _LINE.search(element.info or "")
    return int(found[1]) if found else 0


def _make_row(element: Any) -> Row:
    return {"name": element.name, "line": _get_line(element)}


def _sort_by_id(elements: Iterable[Any]) -> list[Any]:
    """Return elements by their id in the compiled model."""
    return sorted(elements, key=lambda element: element.id)


def _list_values(model: Any, prefix: str, index: int, names: Iterable[str]) -> Row:
    found = {}
    for name in names:
        value = getattr(model, f"{prefix}_{name}")[index]
        found[name] = value.tolist() if hasattr(value, "tolist") else value
    return found


def _list_bodies(spec: Any, model: Any, _: Any) -> list[Row]:
    names = ("parentid", "pos", "quat", "mass", "inertia", "ipos", "iquat", "gravcomp", "mocapid")
    return [
        {**_make_row(body), **_list_values(model, "body", i, names)}
        for i, body in enumerate(_sort_by_id(spec.bodies))
    ]


def _list_joints(spec: Any, model: Any, mujoco: Any) -> list[Row]:
    names = (
        *("bodyid", "pos", "axis", "range", "limited", "stiffness", "qposadr", "dofadr"),
        *("actfrclimited", "actfrcrange", "margin"),
    )
    rows = []
    for i, joint in enumerate(_sort_by_id(spec.joints)):
        row = {**_make_row(joint), **_list_values(model, "jnt", i, names)}
        row["type"] = _get_enum_name(mujoco.mjtJoint(model.jnt_type[i]), "mjJNT_")
        row |= _list_values(model, "dof", row["dofadr"], [r.mjcf_attribute for r in RESISTANCE])
        for kind, end in (("jnt", "limit"), ("dof", "friction")):
            number = i if kind == "jnt" else row["dofadr"]
            soft = _list_values(model, kind, number, ("solref", "solimp"))
            row |= {name + end: value for name, value in soft.items()}
        row["actuatorgravcomp"] = bool(model.jnt_actgravcomp[i])
        row["ref"] = float(model.qpos0[row["qposadr"]])
        row["springref"] = float(model.qpos_spring[row["qposadr"]])
        row["poly"] = _is_set(model, "dof_dampingpoly", row["dofadr"])
        row["spring_poly"] = _is_set(model, "jnt_stiffnesspoly", i)
        row["springyield"] = _is_set(model, "jnt_springyield", i)
        rows.append(row)
    return rows


def _is_set(model: Any, name: str, number: int) -> bool:
    """Tell whether a value of a compiled model is not zero; older versions of MuJoCo lack some."""
    values = getattr(model, name, None)
    return bool(values is not None and values[number].any())


def _list_geoms(spec: Any, model: Any, mujoco: Any) -> list[Row]:
    names = (
        *("bodyid", "pos", "quat", "size", "dataid", "contype", "conaffinity", "group"),
        *("rgba", "matid"),
        *{row.mjcf.removeprefix("geom ") for row in SURFACE_OF_MUJOCO},
    )
    paired = {int(i) for pair in (model.pair_geom1, model.pair_geom2) for i in pair}
    rows = []
    for i, geom in enumerate(_sort_by_id(spec.geoms)):
        row = {**_make_row(geom), **_list_values(model, "geom", i, names)}
        row["type"] = _get_enum_name(mujoco.mjtGeom(model.geom_type[i]), "mjGEOM_")
        row["paired"] = i in paired
        if row["type"] == "hfield":
            row["content"] = _describe_heightfield(model, row["dataid"])
        rows.append(row)
    return rows


def _list_meshes(spec: Any, model: Any, _: Any) -> list[Row]:
    rows = []
    for i, mesh in enumerate(_sort_by_id(spec.meshes)):
        row = {**_make_row(mesh), **_list_values(model, "mesh", i, ("pos", "quat"))}
        row["file"] = mesh.file
        row |= {name: getattr(mesh, name).tolist() for name in ("scale", "refpos", "refquat")}
        row["content"] = _describe_mesh(model, i)
        rows.append(row)
    return rows


def _describe_mesh(model: Any, index: int) -> dict[str, Any]:
    """Return counts, extent [m] and a digest of the points and faces of a mesh."""
    first, count = model.mesh_vertadr[index], model.mesh_vertnum[index]
    start, faces = model.mesh_faceadr[index], model.mesh_facenum[index]
    points = model.mesh_vert[first : first + count]
    data = points.tobytes() + model.mesh_face[start : start + faces].tobytes()
    return {
        "points": (float(count),),
        "faces": (float(faces),),
        "extent": tuple(map(float, points.max(axis=0) - points.min(axis=0))),
        "digest": sha256(data).hexdigest()[:12],
    }


def _describe_heightfield(model: Any, index: int) -> dict[str, Any]:
    """Return sizes [m], numbers of rows and columns, and a digest of the heights."""
    first = model.hfield_adr[index]
    shape = int(model.hfield_nrow[index]), int(model.hfield_ncol[index])
    heights = model.hfield_data[first : first + shape[0] * shape[1]]
    return {
        "size": tuple(map(float, model.hfield_size[index])),
        "grid": tuple(map(float, shape)),
        "digest": sha256(heights.tobytes()).hexdigest()[:12],
    }


def _list_materials(spec: Any, model: Any, _: Any) -> list[Row]:
    files = {texture.name: texture.file for texture in spec.textures}
    rows = []
    for i, material in enumerate(_sort_by_id(spec.materials)):
        row = {**_make_row(material), "rgba": model.mat_rgba[i].tolist()}
        named = [name for name in material.textures if name]
        row["texture"] = next((files[name] for name in named if files.get(name)), "")
        row["is_textured"] = bool(named)
        rows.append(row)
    return rows


def _list_sites(spec: Any, model: Any, _: Any) -> list[Row]:
    return [
        {**_make_row(site), **_list_values(model, "site", i, ("bodyid", "pos", "quat"))}
        for i, site in enumerate(_sort_by_id(spec.sites))
    ]


def _list_cameras(spec: Any, model: Any, _: Any) -> list[Row]:
    names = ("bodyid", "pos", "quat", "fovy", "resolution", "mode")
    return [
        {**_make_row(camera), **_list_values(model, "cam", i, names)}
        for i, camera in enumerate(_sort_by_id(spec.cameras))
    ]


def _list_lights(spec: Any, model: Any, mujoco: Any) -> list[Row]:
    names = ("bodyid", "pos", "dir", "diffuse", "specular", "cutoff", "castshadow", "mode")
    rows = []
    for i, light in enumerate(_sort_by_id(spec.lights)):
        row = {**_make_row(light), **_list_values(model, "light", i, names)}
        row["type"] = _get_enum_name(mujoco.mjtLightType(model.light_type[i]), "mjLIGHT_")
        rows.append(row)
    return rows


def _list_actuators(spec: Any, model: Any, mujoco: Any) -> list[Row]:
    names = (
        *("gear", "gainprm", "biasprm", "ctrlrange", "ctrllimited", "forcerange", "forcelimited"),
        "trnid",
    )
    rows = []
    for i, actuator in enumerate(_sort_by_id(spec.actuators)):
        row = {**_make_row(actuator), **_list_values(model, "actuator", i, names)}
        # a positive third number of a servo is the ratio of its damping to the critical one
        ratio = float(actuator.biasprm[2])
        row["dampratio"] = ratio if ratio > 0 and actuator.biasprm[1] < 0 else None
        for name, enum, prefix in (
            ("trntype", mujoco.mjtTrn, "mjTRN_"),
            ("gaintype", mujoco.mjtGain, "mjGAIN_"),
            ("biastype", mujoco.mjtBias, "mjBIAS_"),
            ("dyntype", mujoco.mjtDyn, "mjDYN_"),
        ):
            row[name] = _get_enum_name(enum(getattr(model, f"actuator_{name}")[i]), prefix)
        rows.append(row)
    return rows


def _list_equalities(spec: Any, model: Any, mujoco: Any) -> list[Row]:
    rows = []
    for i, equality in enumerate(_sort_by_id(spec.equalities)):
        row = {
            **_make_row(equality),
            **_list_values(model, "eq", i, ("obj1id", "obj2id", "data", "active0")),
        }
        row["type"] = _get_enum_name(mujoco.mjtEq(model.eq_type[i]), "mjEQ_")
        row["objtype"] = _get_enum_name(mujoco.mjtObj(model.eq_objtype[i]), "mjOBJ_")
        rows.append(row)
    return rows


def _list_sensors(spec: Any, model: Any, mujoco: Any) -> list[Row]:
    rows = []
    for i, sensor in enumerate(_sort_by_id(spec.sensors)):
        row = {**_make_row(sensor), "objid": int(model.sensor_objid[i])}
        row["type"] = _get_enum_name(mujoco.mjtSensor(model.sensor_type[i]), "mjSENS_")
        row["objtype"] = _get_enum_name(mujoco.mjtObj(model.sensor_objtype[i]), "mjOBJ_")
        rows.append(row)
    return rows


def _list_excludes(spec: Any, *_: Any) -> list[Row]:
    return [{**_make_row(e), "body1": e.bodyname1, "body2": e.bodyname2} for e in spec.excludes]


_WORDS = {word.lower(): word for word in ("Euler", "RK4", "PGS", "CG", "Newton")}
"""Words of ``<option>`` that are not in lower case."""


_GROUPS = 31
"""Number of groups of actuators in MuJoCo's ``mjNGROUPS`` of ``actuatorgroupdisable``."""


def _list_options(_: Any, model: Any, mujoco: Any) -> list[Row]:
    option, usual = model.opt, mujoco.MjOption()  # versions have other defaults
    row: Row = {"name": "", "line": 0}
    for setting in OF_MUJOCO:
        name = setting.mjcf.partition(" ")[2]
        values = [getattr(one, name, setting.default) for one in (option, usual)]
        value, other = (v.tolist() if hasattr(v, "tolist") else v for v in values)
        row[name] = setting.default if value == other else value
    groups = (group for group in range(_GROUPS) if option.disableactuator & 1 << group)
    row["actuatorgroupdisable"] = " ".join(map(str, groups))
    for name, enum, prefix in (
        ("integrator", mujoco.mjtIntegrator, "mjINT_"),
        ("cone", mujoco.mjtCone, "mjCONE_"),
        ("jacobian", mujoco.mjtJacobian, "mjJAC_"),
        ("solver", mujoco.mjtSolver, "mjSOL_"),
    ):
        word = _get_enum_name(enum(getattr(option, name)), prefix)
        row[name] = _WORDS.get(word, word)
    for name, enum, prefix in (
        ("disableflags", mujoco.mjtDisableBit, "mjDSBL_"),
        ("enableflags", mujoco.mjtEnableBit, "mjENBL_"),
    ):
        bits = {n: int(getattr(enum, n)) for n in dir(enum) if n.startswith(prefix)}
        on = [n for n, bit in bits.items() if bit & getattr(option, name)]
        row[name] = " ".join(sorted(n.removeprefix(prefix).lower() for n in on))
    return [row]


def _list_numbers(spec: Any, *_: Any) -> list[Row]:
    return [{**_make_row(e), "data": list(e.data)[:1]} for e in spec.numerics]


def _make_lister(attribute: str) -> Callable[..., list[Row]]:
    def read(spec: Any, *_: Any) -> list[Row]:
        return [_make_row(element) for element in getattr(spec, attribute, ())]

    return read


def _get_enum_name(value: Any, prefix: str) -> str:
    return str(value.name).removeprefix(prefix).lower()


_READERS: dict[str, Callable[..., list[Row]]] = {
    "body": _list_bodies,
    "joint": _list_joints,
    "geom": _list_geoms,
    "mesh": _list_meshes,
    "material": _list_materials,
    "site": _list_sites,
    "camera": _list_cameras,
    "actuator": _list_actuators,
    "equality": _list_equalities,
    "sensor": _list_sensors,
    "exclude": _list_excludes,
    "option": _list_options,
    "numeric": _list_numbers,
    "tendon": _make_lister("tendons"),
    "light": _list_lights,
    "flex": _make_lister("flexes"),
    "skin": _make_lister("skins"),
    "plugin": _make_lister("plugins"),
}
"""Reader of each kind."""
