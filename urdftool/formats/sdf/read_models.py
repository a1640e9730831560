"""Models of an SDF file, with included and nested models."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from ...diagnostic import Severity
from ...errors import ModelError, SourceError
from ...model.native import make_world
from ...source.access import MODEL_PATHS
from ...source.document import Element, parse, read_file
from ...source.location import SourceFile
from ...source.packages import Packages
from ...source.tinyxml2 import parse_as_tinyxml2
from ...workspace import Workspace
from ..reading import Losses
from .read_scope import MODEL, SELF_COLLIDE, Item, Scope, read_own_pose
from .read_values import Version, read_flag, read_text, read_version

NEWEST: Version = (1, 12)
"""Newest version of SDF that is read."""

OLDEST: Version = (1, 4)
"""Oldest version of SDF that is read."""

MAX_DEPTH = 30
"""Largest depth of nested models, which include each other in a cycle. Chosen, no source."""

MAX_ELEMENTS = 200_000
"""Maximum number of elements with those of included files, which count each time. Chosen."""
MAX_INCLUDES = 2000
"""Maximum number of included files, which count each time. Chosen."""


_SCENERY = ("actor", "light", "road", "population")
"""Elements next to a model without a world."""

BUILT_IN = ("sun", "ground_plane")
"""Models that every Gazebo has: a light, and a static plane. Worlds of Gazebo include both."""


class _NotFoundError(SourceError):
    """An included model does not exist here."""


class Models:
    """Reader of models and includes.

    Attributes:
        files: Files that were read.
        losses: What the robot does not hold.
        missing: Errors of models that a world includes and that are not found.
    """

    def __init__(self, packages: Packages, workspace: Workspace, losses: Losses) -> None:
        """Store the access to files."""
        self._packages = packages
        self._workspace = workspace
        self.files: list[SourceFile] = []
        self.losses = losses
        self.missing: list[SourceError] = []
        self._above: list[str] = []
        self._count = self._included = 0

    def parse_root(self, file: SourceFile) -> Element:
        """Parse a file.

        Raises:
            SourceError: It is not well-formed.
            ModelError: The root is not ``<sdf>``, or it has too many elements.
        """
        self.files.append(file)
        root = self._parse(file)
        if root.tag != "sdf":
            raise ModelError(f"the root element is <{root.tag}>, not <sdf>", at=root.place)
        for element in root.walk():
            self._count += 1
            if self._count > MAX_ELEMENTS:
                text = f"the model has more than {MAX_ELEMENTS} elements; it is not read"
                raise ModelError(text, at=element.place)
        version = read_version(root)
        if version > NEWEST:
            text = f"rules of SDF 1.{NEWEST[1]} are used for a later version"
            self.losses.add("version", text, root.get("version") or "", root.place)
        if version < OLDEST:
            text = f"rules of SDF 1.{OLDEST[1]} are used for an earlier version"
            self.losses.add("version", text, root.get("version") or "", root.place)
        return root

    def _parse(self, file: SourceFile) -> Element:
        read = parse_as_tinyxml2(file)
        if read.surplus is not None:
            text = "end tags after the root element are ignored, as by libsdformat"
            self.losses.add("end-tag", text, "", read.surplus)
        if read.error is not None:
            assert read.error.at is not None
            text = "XML that libsdformat accepts and other readers reject"
            self.losses.add(
                "not-well-formed", text, read.error.message, read.error.at, Severity.INFO
            )
        return read.document.root

    def list_top_models(self, root: Element) -> list[Scope]:
        """Return the models of a file, those of its world included.

        Raises:
            ModelError: It has two worlds.
        """
        worlds = list(root.list_children("world"))
        if len(worlds) > 1:
            raise ModelError("the file has two worlds; name a file of one", at=worlds[1].place)
        version = read_version(root)
        self._above.append(os.path.realpath(root.file.path))
        found = []
        for holder in (root, *worlds):
            for child in holder.children:
                if child.tag == "model":
                    found.append(self._read_model(child, version))
                elif child.tag == "include":
                    found += self._read_scenery(child)
                elif child.tag in _SCENERY and holder is root:
                    text = "lights and actors next to a model are not read"
                    name = child.get("name") or ""
                    self.losses.add("scenery", text, name, child.place, Severity.INFO)
        for world in worlds:
            self._report_world(world)
        return found

    def _report_world(self, world: Element) -> None:
        text = "what else is in the world is compared, not exported"
        for part in make_world(world).children:
            name = part.get("name") or f"<{part.tag}>"
            self.losses.add("world", text, name, part.place, Severity.INFO)

    def _read_scenery(self, element: Element) -> list[Scope]:
        """Return the model that a world includes; report one that is not found."""
        try:
            model = self._read_included(element)
        except _NotFoundError as error:
            uri = read_text(element, "uri") or ""
            if uri.partition("://")[2].strip("/") in BUILT_IN:
                text = "ground and sun of Gazebo are not read"
                self.losses.add("scenery", text, uri, element.place, Severity.INFO)
            else:
                text = "models that the world includes are not found, and not read"
                self.losses.add("missing-model", text, uri, element.place)
                self.missing.append(error)
            return []
        return [] if model is None else [model]

    def _read_model(self, element: Element, version: Version, parent: Scope | None = None) -> Scope:
        name = element.get("name") or ""
        if not name:
            raise ModelError("a model has no name", at=element.place)
        scope = Scope(element, name, version, element, parent=parent)
        scope.placement = element.get("placement_frame") or ""
        scope.is_static = read_flag(element, "static")
        scope.canonical = element.get("canonical_link") or ""
        self._fill(scope, element, version, MODEL)
        return scope

    def _fill(self, scope: Scope, element: Element, version: Version, home: str) -> None:
        """Add the contents of a model to a scope."""
        if len(self._list_ancestors(scope)) > MAX_DEPTH:
            text = f"models are nested more than {MAX_DEPTH} deep"
            raise ModelError(text, at=element.place)
        for child in element.children:
            if child.tag in ("link", "joint", "frame"):
                kinds = {"link": scope.links, "joint": scope.joints, "frame": scope.frames}
                self._add(scope, kinds[child.tag], Item(child, home))
            elif child.tag == "model":
                nested = self._read_model(child, version, scope)
                nested.home = home
                self._nest(scope, nested)
            elif child.tag == "include":
                self._include(scope, child, home)
            elif child.tag == "gripper":
                text = "grippers are not read"
                self.losses.add("gripper", text, child.get("name") or "", child.place)
        if read_flag(element, "self_collide") and scope.parent is not None:
            self.losses.add("self-collide", SELF_COLLIDE, scope.name, element.place, content="true")

    def _list_ancestors(self, scope: Scope | None) -> list[Scope]:
        above = []
        while scope is not None:
            above.append(scope)
            scope = scope.parent
        return above

    def _add(self, scope: Scope, kind: dict[str, Item], item: Item) -> None:
        tag = item.element.tag
        if not item.name:
            raise ModelError(f"a {tag} has no name", at=item.element.place)
        if item.name in kind:
            text = f"the model has two {tag}s named '{item.name}'"
            raise ModelError(text, at=item.element.place)
        kind[item.name] = item

    def _nest(self, scope: Scope, model: Scope) -> None:
        if model.name in scope.models:
            text = f"the model has two models named '{model.name}'"
            raise ModelError(text, at=model.posed.place)
        scope.models[model.name] = model

    def _include(self, scope: Scope, element: Element, home: str) -> None:
        """Add an included model as a nested one, or merge it."""
        model = self._read_included(element, scope)
        if model is None:
            return
        model.home = home
        if not read_flag_attribute(element, "merge"):
            self._nest(scope, model)
            return
        frame = f"_merged__{model.name}__model__"
        scope.models[frame] = _make_frame_scope(model, frame)
        for items, own in (
            (model.links, scope.links),
            (model.joints, scope.joints),
            (model.frames, scope.frames),
        ):
            for item in items.values():
                merged = frame if item.home == MODEL else item.home
                self._add(scope, own, Item(item.element, merged))
        for nested in model.models.values():
            nested.parent = scope
            nested.home = frame if nested.home == MODEL else nested.home
            self._nest(scope, nested)

    def _read_included(self, element: Element, parent: Scope | None = None) -> Scope | None:
        """Read the model of an ``<include>``; its name, pose and ``static`` replace the model's.

        Raises:
            SourceError: The file does not exist, or includes itself.
            ModelError: It has no model, or several.
        """
        path = self._resolve_path(element)
        key = os.path.realpath(path)
        if key in self._above:
            raise SourceError(f"file '{path}' includes itself", at=element.place)
        self._included += 1
        if self._included > MAX_INCLUDES:
            text = f"the model includes more than {MAX_INCLUDES} files; it is not read"
            raise ModelError(text, at=element.place)
        root = self.parse_root(self._read_file(path, element))
        self._above.append(key)
        models = list(root.list_children("model"))
        if len(models) != 1:
            text = f"file '{path}' has {len(models)} models; an included file has one"
            if not models and (root.find_child("light") or root.find_child("actor")) is not None:
                text = "included lights and actors are not read"
                self.losses.add("scenery", text, "", element.place, Severity.INFO)
                self._above.pop()
                return None
            raise ModelError(text, at=element.place)
        model = self._read_model(models[0], read_version(root), parent)
        self._above.pop()
        model.name = read_text(element, "name") or model.name
        if element.find_child("pose") is not None:
            model.posed = element
            model.placement = ""
        model.placement = read_text(element, "placement_frame") or model.placement
        model.is_static = read_flag(element, "static", model.is_static)
        for child in element.list_children("plugin"):
            name = child.get("filename") or ""
            self.losses.add("plugin", "plugins are not read", name, child.place, Severity.INFO)
        return model

    def _read_file(self, path: Path, element: Element) -> SourceFile:
        try:
            return read_file(str(path), self._workspace)
        except SourceError as error:
            raise SourceError(f"file '{path}' {error.message}", at=element.place) from None

    def _resolve_path(self, element: Element) -> Path:
        """Return the SDF file of an ``<include>``."""
        uri = read_text(element, "uri")
        if not uri:
            raise SourceError("<include> has no <uri>", at=element.place)
        for path in self._list_places(uri, element):
            if self._workspace.is_folder(path):
                return self._find_main_file(path, element)
            if self._workspace.is_file(path):
                return path
        raise _NotFoundError(f"model '{uri}' is not found", at=element.place)

    def _list_places(self, uri: str, element: Element) -> Iterator[Path]:
        """Yield the paths that a URI may mean."""
        scheme, separator, rest = uri.partition("://")
        folder = Path(element.file.path).resolve().parent
        if separator and scheme in ("http", "https"):
            text = f"model '{uri}' is on the network; download it and name its folder"
            raise _NotFoundError(text, at=element.place)
        if separator and scheme == "file":
            yield Path(rest)
            yield folder / rest
            return
        name = rest if separator else uri
        yield from (folder / name, folder.parent / name, folder.parent.parent / name)
        for variable in MODEL_PATHS:
            for entry in filter(
                None, (self._workspace.read_variable(variable) or "").split(os.pathsep)
            ):
                yield Path(entry) / name
        for path in self._packages.paths:
            yield Path(path) / name

    def _find_main_file(self, folder: Path, element: Element) -> Path:
        """Return the newest file that ``model.config`` of a folder names."""
        for name in ("model.config", "manifest.xml"):
            if not self._workspace.is_file(folder / name):
                continue
            root = parse(self._read_file(folder / name, element)).root
            files = [
                (_read_config_version(child), child.text.strip())
                for child in root.list_children("sdf")
            ]
            known = [(version, text) for version, text in files if version <= NEWEST]
            if known:
                return folder / max(known)[1]
        if self._workspace.is_file(folder / "model.sdf"):
            return folder / "model.sdf"
        text = f"folder '{folder}' has no model.config that names an SDF file"
        raise SourceError(text, at=element.place)


def read_flag_attribute(element: Element, name: str) -> bool:
    """Return whether an attribute is ``true`` or ``1``."""
    return (element.get(name) or "").lower() in ("true", "1")


def _read_config_version(element: Element) -> Version:
    try:
        return read_version(element)
    except ModelError:
        return 1, 0


def _make_frame_scope(model: Scope, name: str) -> Scope:
    """Return the pose of a merged model as a model without contents."""
    return Scope(
        model.element,
        name,
        model.version,
        model.posed,
        canonical=model.canonical or next(iter(model.links), MODEL),
        parent=model.parent,
        home=model.home,
        merged=read_own_pose(model),
    )
