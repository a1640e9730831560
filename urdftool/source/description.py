"""A description as it was read: plain URDF, or xacro with its expansion."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from copy import copy
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ..workspace import Memo, Workspace
from .document import STDIN, Document, parse, read_file
from .location import SourceFile
from .packages import Packages

if TYPE_CHECKING:
    from .expansion import Expansion

GltfUp = Literal["y", "z"]
"""The axis of a glTF file that is up: ``y`` by its standard, which is turned to Z on reading; ``z``
in files made for readers that keep the axes of the file."""


@dataclass
class Description:
    """A description and all that was read for it.

    Attributes:
        path: The path as the user gave it.
        document: The tree; of a xacro file, the expanded one.
        files: The XML files it was read from, the description itself first.
        packages: Finds packages and files for it.
        arguments: The xacro arguments it was expanded with.
        expansion: What xacro did; None for plain URDF.
        gltf_up: The axis that is up in its glTF meshes.
        memo: What several rules need to know of it, computed once.
    """

    path: str
    document: Document
    files: list[SourceFile]
    packages: Packages
    arguments: dict[str, str] = field(default_factory=dict)
    expansion: Expansion | None = None
    gltf_up: GltfUp = "y"
    memo: Memo = field(default_factory=Memo, init=False, repr=False, compare=False)

    @property
    def workspace(self) -> Workspace:
        """What reads its files."""
        return self.packages.workspace

    def unread(self) -> Description:
        """Return the same description, of which other files are read again."""
        packages = copy(self.packages)
        packages.workspace = self.workspace.unread()
        return replace(self, packages=packages)

    def resolve(self, uri: str) -> Path:
        """The file that a URI or path in it means; as :meth:`Packages.resolve`.

        A relative path is relative to the description, as its readers take it, whichever of its
        xacro files it is written in.
        """
        return self.packages.resolve(uri)


def is_xacro(file: SourceFile) -> bool:
    """Whether a file is to be expanded: by its name, or by the xacro namespace in it."""
    return file.path.endswith(".xacro") or b"xmlns:xacro" in file.data


def read_description(
    path: str | Path,
    arguments: Mapping[str, str] | None = None,
    *,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
    configured: Mapping[str, str | Path] | None = None,
    file: SourceFile | None = None,
    gltf_up: GltfUp = "y",
    workspace: Workspace | None = None,
) -> Description:
    """Read a description, and expand it where it is xacro.

    Args:
        path: A ``.urdf`` or ``.xacro`` file, or ``-`` for standard input.
        arguments: Values for its xacro arguments.
        packages: Folders by package name.
        package_paths: Folders with packages below.
        configured: Folders by package name that the configuration knows.
        file: The file, where it has been read already.
        gltf_up: The axis that is up in glTF meshes.
        workspace: Reads the files; a new one if None.

    Raises:
        SourceError: It, or a file it includes, cannot be read or expanded.
    """
    workspace = workspace or Workspace()
    file = file or read_file(path, workspace)
    finder = Packages(
        None if file.path == STDIN else file.path,
        named=packages,
        paths=package_paths,
        configured=configured,
        workspace=workspace,
    )
    arguments = dict(arguments or {})
    if not is_xacro(file):
        return Description(str(path), parse(file), [file], finder, arguments, gltf_up=gltf_up)
    from .expand import expand_xacro

    expansion = expand_xacro(file, arguments, finder)
    return Description(
        str(path),
        expansion.document(),
        list(expansion.files.values()),
        finder,
        arguments,
        expansion,
        gltf_up,
    )
