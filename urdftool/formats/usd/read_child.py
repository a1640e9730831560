"""Reading of a stage in the process with limits. The reader's only use of OpenUSD is below it."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pxr import Pcp, Sdf, Tf, Usd, UsdPhysics, UsdUtils

from ...dependencies import Dependencies
from ...diagnostic import Severity
from ...errors import ModelError, UrdftoolError
from ...model.drives import GAINS
from ...model.elements import Robot
from ...model.provenance import Written
from ...model.settings import RESISTANCE, Settings, Value
from ...source.description import Description
from ...source.document import Document, Element
from ...source.location import Place, SourceFile
from ...workspace import Workspace
from ..reading import Losses, Opened, Reading
from .read_layers import LayerFiles, check_count, open_layers
from .read_mesh import MeshFolder
from .read_native import add_native, has_default
from .read_places import Layers
from .read_shapes import add_shapes
from .read_stage import Context, convert_float
from .read_tree import add_tree


def read_stage(
    opened: Opened, shown: str, path: str, name: str, mesh_folder: Path
) -> tuple[Reading | UrdftoolError, Dependencies]:
    """Read a robot, and return it or why it cannot be read, and the files that were asked for."""
    view = opened.workspace.with_record()
    assert view.dependencies is not None
    try:
        return _read(opened, view, shown, path, name, mesh_folder), view.dependencies
    except UrdftoolError as error:
        return error, view.dependencies


def _read(
    opened: Opened, view: Workspace, shown: str, path: str, name: str, mesh_folder: Path
) -> Reading:
    """Read a robot.

    Raises:
        SourceError: A layer cannot be read.
        ModelError: OpenUSD does not open it, or it has no rigid body.
    """
    file, finder, _ = opened
    losses = Losses()
    with _convert_errors(file):
        stage, layers = _open_stage(path, file, losses, view)
        context = Context(stage, layers, losses, name)
        robot = Robot(Written(context.get_place(context.top)), "", format="usd")
        robot.world = _read_world(context)
        joints = add_tree(context, robot)
        robot.name = context.robot_name
        root = Element("robot", {"name": robot.name}, None, file, 0)
        document = Document(file, root, [])
        robot.source = Description(shown, document, layers.list_files(), finder)
        _report_unread(context)
        add_native(context, robot, joints)
        folder = MeshFolder(mesh_folder, Place(file, 0, 0))
        try:
            add_shapes(context, robot, folder)
        except BaseException:
            folder.remove_new()
            raise
    robot.contradictions = context.contradictions
    robot.unread = losses.make_findings()
    return Reading(robot, robot.unread)


_EARTH = 9.81
"""Gravity [m/s²] by default: UsdPhysics says "earth gravity" without a number; chosen."""


def _read_world(context: Context) -> Settings:
    """Return the gravity [m/s²] of the first scene of a stage that sets it.

    By the schema of UsdPhysics, a negative magnitude is that of the Earth, and no direction is
    down.
    """
    for prim in context.stage.Traverse():
        scene = UsdPhysics.Scene(prim)
        written = scene.GetGravityMagnitudeAttr(), scene.GetGravityDirectionAttr()
        if not prim.IsA(UsdPhysics.Scene) or not any(one.HasAuthoredValue() for one in written):
            continue
        magnitude, direction = written[0].Get(), [float(part) for part in written[1].Get()]
        amount = convert_float(magnitude, context.length) if 0 <= magnitude < math.inf else _EARTH
        size = math.hypot(*direction)
        x, y, z = (part / size for part in direction) if size > 0 else _get_down(context)
        up = (x, -z, y) if context.is_y_up else (x, y, z)
        place = context.get_written(prim, written[0].GetName())
        return {"gravity": Value(place, tuple(amount * part + 0.0 for part in up))}
    return {}


def _get_down(context: Context) -> tuple[float, float, float]:
    return (0.0, -1.0, 0.0) if context.is_y_up else (0.0, 0.0, -1.0)


_INCOMPLETE = (
    Pcp.ErrorArcCycle,
    Pcp.ErrorInvalidAssetPath,
    Pcp.ErrorInvalidSublayerPath,
    Pcp.ErrorSublayerCycle,
    Pcp.ErrorUnresolvedPrimPath,
)
"""Errors after which parts of the stage are missing."""


@contextmanager
def _convert_errors(file: SourceFile) -> Iterator[None]:
    """Convert exceptions of OpenUSD, which decodes parts of a stage when they are asked for.

    Raises:
        ModelError: OpenUSD raised an exception.
    """
    try:
        yield
    except (Tf.ErrorException, UnicodeError) as error:
        notes = [_NOT_TEXT] if isinstance(error, UnicodeError) else list(_list_messages(error.args))
        text = "OpenUSD does not open the stage"
        raise ModelError(text, at=Place(file, 0, 0), notes=notes) from None


def _open_stage(
    path: str, file: SourceFile, losses: Losses, workspace: Workspace
) -> tuple[Usd.Stage, Layers]:
    """Open a stage with its payloads, and record the warnings of OpenUSD.

    Returns:
        The stage, and its layers.

    Raises:
        ModelError: A layer that it refers to cannot be opened.
        Exception: OpenUSD raises it, see :func:`convert_errors`.
    """
    delegate = UsdUtils.CoalescingDiagnosticDelegate()
    place = Place(file, 0, 0)
    files = LayerFiles(workspace, place)
    opened = open_layers(os.path.abspath(path), files)
    check_count(opened, place)
    stage = Usd.Stage.Open(os.path.abspath(path), Usd.Stage.LoadAll)
    layers = Layers(stage, file, files, workspace)
    errors = [error for error in stage.GetCompositionErrors() if isinstance(error, _INCOMPLETE)]
    if errors:
        delegate.TakeUncoalescedDiagnostics()
        raise ModelError(
            "parts of the stage are missing",
            at=layers.get_place(stage.GetPrimAtPath(errors[0].rootSite.path)),
            notes=[_join(str(error)) for error in errors[:_MOST]],
        )
    for text in _list_messages(delegate.TakeUncoalescedDiagnostics()):
        losses.add("warning", f"OpenUSD warns: {text}", "", place, Severity.INFO)
    return stage, layers


_MOST = 3
"""Number of messages of OpenUSD that an error shows. Chosen, no source."""


_NOT_TEXT = "the text is not valid UTF-8"


def _list_messages(items: Iterable[Any]) -> Iterator[str]:
    """Yield the messages of diagnostics; they quote the file, which may be no valid text."""
    for item in items:
        try:
            yield _join(str(item.commentary))
        except UnicodeError:
            yield _NOT_TEXT


def _join(text: str) -> str:
    return " ".join(text.split())


_NAMESPACES = re.compile(r"(physics|physx\w*|newton|mjc|drive|limit|state|urdf|omniphysics)$")

_READ = re.compile(
    r"physics:(mass|centerOfMass|diagonalInertia|principalAxes|rigidBodyEnabled|collisionEnabled|"
    r"approximation|axis|(lower|upper)Limit|local(Pos|Rot)[01]|jointEnabled|excludeFromArticulation)"
    r"|newton:(inertia|velocityLimit|mimic(Coef[01]|Enabled)|maxHullVertices)"
    rf"|drive:\w+:physics:(maxForce|{'|'.join(GAINS)})|limit:\w+:physics:(low|high)"
    r"|physxJointAxis:\w+:maxJointVelocity|physxJoint:maxJointVelocity|physxMimicJoint:\w+:(gearing|offset)"
    r"|physics:((static|dynamic)Friction|restitution|gravity(Magnitude|Direction))"
    r"|mjc:(coef[01]|actuatorfrc(range:(min|max)|limited))|"
    + "|".join(
        name.replace("*", r"\w+")
        for row in RESISTANCE
        for name in (row.usd, *row.physx, f"mjc:{row.mjcf_attribute}")
    )
)
"""Names of the attributes that the reader uses."""

_HARMLESS = re.compile(
    r"urdf:.*|state:.*|drive:\w+:physics:(targetPosition|targetVelocity|type)"
    r"|physics:(startsAsleep|velocity|angularVelocity|simulationOwner|collisionEnabled)"
    r"|.*([sS]olver|[sS]leep|[sS]tabilization|[iI]teration|[hH]ull|report).*"
)
"""Names of settings, of states at the start, and of what drives are set to at the start."""

_SELF = re.compile(r"newton:selfCollisionEnabled|physxArticulation:enabledSelfCollisions")
"""Names of the settings of collisions of a robot with itself."""


def _report_unread(context: Context) -> None:
    """Report each attribute of physics that is not read once, with the first prim that has it."""
    found: dict[str, list[Usd.Prim]] = {}
    for prim in context.iterate_prims():
        for attribute in prim.GetAuthoredAttributes():
            name = attribute.GetName()
            space, colon, _ = name.partition(":")
            if colon and _NAMESPACES.match(space) and not _READ.fullmatch(name):
                found.setdefault(name, []).append(prim)
    without: dict[str, Usd.Prim] = {}
    for name, having in found.items():
        prims = [one for one in having if not has_default(one, name)]
        if not prims:
            continue
        prim = prims[0]
        if _SELF.fullmatch(name):
            own = [one for one in prims if not context.is_of_other(one)]
            if own and own[0].GetAttribute(name).Get() is False and not context.is_ours:
                without.setdefault(str(own[0].GetPath()), own[0])
            continue
        place = context.get_place(prim, name)
        if _HARMLESS.fullmatch(name):
            text = "settings, and states and targets at the start, are not read"
            context.losses.add("setting", text, name, place, Severity.INFO)
        else:
            values = [f"{one.GetPath()} {one.GetAttribute(name).Get()}" for one in prims]
            content = "; ".join(values)
            context.losses.add("attribute", "attributes are not read", name, place, content=content)
    for prim in without.values():
        text = "that parts of the robot do not collide with each other is not read"
        context.report_loss("self-collision", text, prim, Severity.INFO)
    for prim in context.bodies.values():
        if UsdPhysics.RigidBodyAPI(prim).GetKinematicEnabledAttr().Get():
            context.report_loss("kinematic", "kinematic bodies are read as dynamic ones", prim)
    _report_variants(context)
    _report_units(context)


def _report_variants(context: Context) -> None:
    """Report the variants of the robot that are not selected."""
    sets = context.top.GetVariantSets()
    for name in sets.GetNames():
        selected = sets.GetVariantSelection(name) or "none"
        others = [one for one in sets.GetVariantSet(name).GetVariantNames() if one != selected]
        if others:
            text = "variant sets are read as selected"
            shown = f"{name}: {selected}, not {', '.join(others)}"
            place = context.get_place(context.top)
            context.losses.add("variant", text, shown, place, Severity.INFO)


_UNITS = {"upAxis": "Y", "metersPerUnit": 0.01, "kilogramsPerUnit": 1.0}
"""Metadata of a layer that OpenUSD takes from the root layer only, with their defaults."""


def _report_units(context: Context) -> None:
    """Report an up axis that does not exist, and layers whose units are not those of the stage."""
    root = context.stage.GetRootLayer()
    own = {name: _get_metadata(root, name, default) for name, default in _UNITS.items()}
    place = context.get_place(context.stage.GetPseudoRoot())
    if own["upAxis"] not in ("Y", "Z"):
        text = "an up axis other than Y and Z is read as Z"
        context.losses.add("up-axis", text, f"upAxis '{own['upAxis']}'", place)
    for layer in context.stage.GetUsedLayers():
        for name, value in own.items():
            other = _get_metadata(layer, name, value)
            if other != value:
                text = "layers have other units than the stage, and OpenUSD does not convert them"
                shown = f"{layer.GetDisplayName()}: {name} {other}, not {value}"
                context.losses.add("units", text, shown, place)


def _get_metadata(layer: Sdf.Layer, name: str, default: object) -> object:
    """Return a value of the metadata of a layer; the default without one."""
    return layer.pseudoRoot.GetInfo(name) if layer.pseudoRoot.HasInfo(name) else default
