"""The layers of a stage, opened one by one before OpenUSD composes them.

Each file is read through the workspace first, which may refuse it, and the prims of the stage are
counted: a layer of a kilobyte can refer to itself so often that composition does not end.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from pxr import Ar, Sdf, Tf, UsdUtils

from ...errors import AccessError, ModelError, SourceError
from ...file_access import AccessRefused
from ...source.location import Place
from ...workspace import Workspace

MAX_PRIMS = 100_000
"""Maximum number of prims of a stage, with those of each reference and instance, and also those
that another layer overrides. Chosen, no source."""

MAX_BYTES = 512 << 20
"""Maximum size of all layers of a stage [bytes]. Chosen, no source."""

_INTERNAL = {"inheritPaths": "inheritPathList", "specializes": "specializesList"}
"""Fields of a prim with paths of the same stage, and their attributes."""

_EXTERNAL = {"references": "referenceList", "payload": "payloadList"}

_ARCS = (*_INTERNAL, *_EXTERNAL)


class _Node(NamedTuple):
    """Prim or variant in a layer with its sublayers, by the identifier of the layer."""

    stack: str
    path: Sdf.Path


class LayerFiles:
    """Files of layers, each checked before OpenUSD opens it."""

    def __init__(self, workspace: Workspace, place: Place) -> None:
        """Create it without files."""
        self._workspace, self._place = workspace, place
        self._paths: set[str] = set()
        self._total = 0

    def allow(self, path: str) -> None:
        """Add the file of the stage itself."""
        self._paths.add(path)

    def check(self, path: str) -> None:
        """Check a file, also one that a path in a package names; a missing one is left to OpenUSD.

        Raises:
            SourceError: It cannot be read.
            ModelError: The files are too large.
        """
        path = Ar.SplitPackageRelativePathOuter(path)[0]
        if path in self._paths or not self._workspace.exists(path):
            return
        self._paths.add(path)
        try:
            with self._workspace.open(path) as stream:
                stream.read(1)
        except AccessRefused as error:
            raise AccessError(f"layer '{path}' {error.strerror}", at=self._place) from None
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise SourceError(f"layer '{path}' cannot be read: {reason}", at=self._place) from None
        self._total += self._workspace.get_size(path) or 0
        if self._total > MAX_BYTES:
            text = f"the layers of the stage are larger than {MAX_BYTES >> 20} MiB"
            raise ModelError(f"{text}; move meshes and images to other stages", at=self._place)

    def check_folder(self, path: str) -> None:
        """Check that the stage may list a folder.

        Raises:
            AccessError: It may not.
        """
        try:
            self._workspace.check(path)
        except AccessRefused as error:
            raise AccessError(f"folder '{path}' {error.strerror}", at=self._place) from None

    def check_used(self, layers: Iterable[Sdf.Layer]) -> None:
        """Check that OpenUSD composed no layer that was not checked.

        Raises:
            SourceError: It did.
        """
        for layer in layers:
            path = Ar.SplitPackageRelativePathOuter(layer.realPath)[0]
            if path and path not in self._paths:
                text = f"layer '{path}' is not named by a plain path, and is not read"
                raise SourceError(text, at=self._place)


def open_layers(path: str, files: LayerFiles) -> list[Sdf.Layer]:
    """Open the layer of a file, and all layers to which it leads; composition then uses them.

    Raises:
        SourceError: A file cannot be read.
        ModelError: The stage is too large.
        Exception: OpenUSD raises it.
    """
    root = Sdf.Layer.FindOrOpen(path)
    if root is None:  # composition reports it
        return []
    files.allow(root.realPath)
    known = {root.identifier: root}
    todo = [root]
    for layer in todo:  # a layer that is found follows
        for name in _list_assets(layer, files):
            found = _find_layer(layer, _evaluate(name, root))
            if not found or found in known:
                continue
            files.check(found)
            opened = _open(found)
            if opened is not None:
                known[found] = opened
                todo.append(opened)
    return todo


def _list_assets(layer: Sdf.Layer, files: LayerFiles) -> Iterator[str]:
    """Yield the asset paths of a layer at which OpenUSD may open layers, value clips included."""
    composed = layer.GetCompositionAssetDependencies()
    named: list[str] = []

    def record(asset: str) -> str:
        named.append(asset)
        return asset

    UsdUtils.ModifyAssetPaths(layer, record)
    for asset in dict.fromkeys((*composed, *named)):
        if "#" in asset:  # the template of value clips
            folder, name = os.path.split(layer.ComputeAbsolutePath(asset))
            files.check_folder(folder)
            folder, name = (re.sub(r"([*?[])", r"[\1]", part) for part in (folder, name))
            yield from Workspace().match(os.path.join(folder, re.sub("#+", "*", name)))
        elif asset in composed or Sdf.FileFormat.FindByExtension(asset) is not None:
            yield asset


def _evaluate(name: str, root: Sdf.Layer) -> str:
    """Return a path with the values of the variables of a stage."""
    if not Sdf.VariableExpression.IsExpression(name):
        return name
    values = root.pseudoRoot.GetInfo("expressionVariables")
    return str(Sdf.VariableExpression(name).Evaluate(dict(values or {})).value or "")


def _find_layer(layer: Sdf.Layer, name: str) -> str:
    """Return the file of a layer that a layer names; empty if there is none."""
    if not name:
        return ""
    path, _ = Sdf.Layer.SplitIdentifier(name)
    where = Sdf.ComputeAssetPathRelativeToLayer(layer, path)
    return str(Ar.GetResolver().Resolve(where)) if where else ""


def _open(path: str) -> Sdf.Layer | None:
    """Open a layer; None if it is not valid, which composition reports."""
    try:
        return Sdf.Layer.FindOrOpen(path)
    except Tf.ErrorException:
        return None


def check_count(layers: Sequence[Sdf.Layer], place: Place) -> None:
    """Check the number of prims that composition makes of layers, the first of which is the root.

    Raises:
        ModelError: There are too many.
    """
    if layers and count_prims(layers) > MAX_PRIMS:
        text = f"the stage has more than {MAX_PRIMS} prims with those of its references"
        raise ModelError(f"{text}; it is not read", at=place)


def count_prims(layers: Sequence[Sdf.Layer]) -> int:
    """Return an upper estimate of the prims that composition makes of layers, the root first.

    Prims that several layers define are counted once for each. Of the variants of a set, only the
    largest is counted.
    """
    return _Counter(layers).count()


class _Prims:
    """Prims of one layer.

    Attributes:
        weights: For each prim and variant, the number of prims that it is and that are below it,
            without those of ``parts``.
        parts: For each prim and variant, what has arcs or variants, or contains such a prim.
        arcs: Prims and variants with arcs.
    """

    def __init__(self, layer: Sdf.Layer) -> None:
        """Visit each prim of a layer once."""
        self.weights: dict[Sdf.Path, int] = {}
        self.parts: dict[Sdf.Path, list[Sdf.Path]] = {}
        self.arcs: dict[Sdf.Path, Sdf.PrimSpec] = {}

        def add(path: Sdf.Path) -> None:
            is_variant = path.IsPrimVariantSelectionPath()
            if not (path.GetVariantSelection()[1] if is_variant else path.IsPrimPath()):
                return  # a property, or a set of variants
            weights = self.weights
            weight = weights[path] = weights.get(path, 0) + (not is_variant)
            prim = layer.GetPrimAtPath(path)
            if any(map(prim.HasInfo, _ARCS)):
                self.arcs[path] = prim
            above = path.GetParentPath()
            if is_variant or path in self.parts or path in self.arcs:
                self.parts.setdefault(above, []).append(path)
            else:
                weights[above] = weights.get(above, 0) + weight

        layer.Traverse(Sdf.Path.absoluteRootPath, add)  # prims come before those above them


class _Counter:
    """State of counting the prims of a stage."""

    def __init__(self, layers: Sequence[Sdf.Layer]) -> None:
        self._layers = {layer.identifier: layer for layer in layers}
        self._root = layers[0]
        self._stacks: dict[str, list[str]] = {}
        self._prims = {name: _Prims(layer) for name, layer in self._layers.items()}

    def count(self) -> int:
        """Return the number of prims."""
        totals: dict[_Node, int] = {}
        first = _Node(self._root.identifier, Sdf.Path.absoluteRootPath)
        todo: list[tuple[_Node, list[list[_Node]] | None]] = [(first, None)]
        while todo:
            node, groups = todo.pop()
            if groups is not None:
                totals[node] = self._compute_weight(node)
                totals[node] += sum(max(totals[one] for one in group) for group in groups)
            elif node not in totals:
                totals[node] = 0  # of a prim that contains itself, which composition reports
                groups = self._list_parts(node)
                todo.append((node, groups))
                todo += [(one, None) for group in groups for one in group]
        return totals[first]

    def _compute_weight(self, node: _Node) -> int:
        stack = self._get_stack(node.stack)
        return sum(self._prims[name].weights.get(node.path, 0) for name in stack)

    def _list_parts(self, node: _Node) -> list[list[_Node]]:
        """Return what a prim consists of; one of each list is composed."""
        groups: list[list[_Node]] = []
        sets: dict[str, list[_Node]] = {}
        for name in self._get_stack(node.stack):
            prims = self._prims[name]
            for path in prims.parts.get(node.path, ()):
                part = _Node(node.stack, path)
                chosen = path.GetVariantSelection()[0] if path.IsPrimVariantSelectionPath() else ""
                if not chosen:
                    groups.append([part])
                elif chosen not in sets:
                    groups.append(sets.setdefault(chosen, [part]))
                else:
                    sets[chosen].append(part)
            if node.path in prims.arcs:
                arcs = self._list_arcs(prims.arcs[node.path], self._layers[name], node.stack)
                groups += [[arc] for arc in arcs]
        return groups

    def _list_arcs(self, prim: Sdf.PrimSpec, layer: Sdf.Layer, stack: str) -> Iterator[_Node]:
        """Yield the prims that composition adds to a prim."""
        for key, listed in _INTERNAL.items():
            if prim.HasInfo(key):
                for path in getattr(prim, listed).GetAddedOrExplicitItems():
                    yield _Node(stack, path)
        for key, listed in _EXTERNAL.items():
            if not prim.HasInfo(key):
                continue
            for arc in getattr(prim, listed).GetAddedOrExplicitItems():
                name = _evaluate(arc.assetPath, self._root)
                found = _find_layer(layer, name) if name else stack
                if found in self._layers:
                    yield _Node(found, arc.primPath or self._layers[found].GetDefaultPrimAsPath())

    def _get_stack(self, name: str) -> list[str]:
        """Return the names of a layer and its sublayers."""
        if name not in self._stacks:
            found = [name]
            for one in found:  # a layer that is found follows
                layer = self._layers[one]
                for path in layer.subLayerPaths:
                    below = _find_layer(layer, _evaluate(path, self._root))
                    if below in self._layers and below not in found:
                        found.append(below)
            self._stacks[name] = found
        return self._stacks[name]
