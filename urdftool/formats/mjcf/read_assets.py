"""Files that MJCF models name. MuJoCo gets their contents under other names, and opens no file."""

from __future__ import annotations

import os
import posixpath
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from ...errors import SourceError
from ...source.document import Element
from ...workspace import Workspace

MAX_BYTES = 256 << 20
"""Maximum size of all meshes, textures and height fields of a model [bytes]; chosen, no source."""

_FOLDERS = ("assetdir", "meshdir", "texturedir")

_IN = {
    "mesh": "meshdir",
    "hfield": "meshdir",
    "skin": "meshdir",
    "flexcomp": "meshdir",
    "texture": "texturedir",
}
"""Setting of the compiler for the folder of the files of each element."""

_FOR_RUNNING = ("memory", "nstack", "njmax", "nconmax")
"""Attributes of ``<size>`` that set the memory of a running simulation."""

_NAMED = ("mesh", "hfield", "texture")
"""Elements that have the name of their file if no other is written."""


@dataclass(frozen=True)
class Asset:
    """A file that a model names."""

    path: str
    element: Element


class AssetNames:
    """Names under which MuJoCo gets the files of one model."""

    def __init__(self, folder: str, assets: dict[str, Asset]) -> None:
        """Store where the files are."""
        self._folder = folder
        self._assets = assets
        self._settings = {"meshdir": "", "texturedir": ""}
        self._strips = False

    def rewrite(self, element: Element) -> dict[str, str]:
        """Return the attributes of an element for MuJoCo: files renamed, without folders."""
        attributes = dict(element.attributes)
        if element.tag == "compiler":
            self._set_folders(attributes)
        if element.tag == "size":
            return {name: v for name, v in attributes.items() if name not in _FOR_RUNNING}
        if element.tag not in _IN:
            return attributes
        for name, value in element.attributes.items():
            if name.startswith("file") and value:
                path = _normalize(value)
                attributes[name] = f"asset-{len(self._assets) + 1}{PurePosixPath(path).suffix}"
                self._assets[attributes[name]] = Asset(path, element)
                if name == "file" and element.tag in _NAMED and not element.get("name"):
                    attributes["name"] = PurePosixPath(path).stem
        return attributes

    def _set_folders(self, attributes: dict[str, str]) -> None:
        """Take the settings of an element ``<compiler>`` out of its attributes."""
        for name in _FOLDERS:
            if name in attributes:
                value = attributes.pop(name)
                self._settings |= (
                    dict.fromkeys(self._settings, value) if name == "assetdir" else {name: value}
                )
        if attributes.get("strippath") in ("true", "false"):
            self._strips = attributes.pop("strippath") == "true"

    def add_folders(self, first: int, main: str, workspace: Workspace) -> None:
        """Complete the paths of files; all settings have been seen.

        A file that is not there is looked for in the folder of the included file that names it, as
        MuJoCo 4.0 does.

        Args:
            first: Number of files of other models, which precede those of this model.
            main: Folder of the main file.
            workspace: Access to files.
        """
        for name, asset in list(self._assets.items())[first:]:
            folder = os.path.join(self._folder, self._settings[_IN[asset.element.tag]])
            path = posixpath.basename(asset.path) if self._strips else asset.path
            complete = os.path.join(folder, path)
            beside = os.path.join(os.path.dirname(asset.element.file.path), path)
            if not workspace.exists(os.path.join(main, complete)) and workspace.exists(beside):
                complete = os.path.relpath(beside, main or os.curdir)
            self._assets[name] = Asset(complete, asset.element)


def _normalize(path: str) -> str:
    """Return a path as MuJoCo writes it."""
    return posixpath.normpath(path.replace("\\", "/"))


def read_assets(paths: dict[str, str], folder: str, workspace: Workspace) -> dict[str, bytes]:
    """Read files.

    Raises:
        SourceError: One cannot be read; ``data`` has its new ``name``.
    """
    found: dict[str, bytes] = {}
    total = 0
    for name, path in paths.items():
        reason, place = "", Path(folder) / path
        try:
            size = workspace.get_size(place)
            total += size or 0
            if total > MAX_BYTES:
                reason = f"makes the files of the model larger than {MAX_BYTES >> 20} MiB"
            elif size is None and workspace.exists(place):
                reason = "is not a regular file"
            else:
                found[name] = workspace.read_bytes(place)
        except FileNotFoundError:
            reason = "does not exist"
        except (OSError, ValueError) as error:
            reason = f"cannot be read: {getattr(error, 'strerror', None) or error}"
        if reason:
            raise SourceError(f"file '{path}' {reason}", data={"name": name})
    return found
