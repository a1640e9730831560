"""Descriptions as read: plain URDF, or xacro with its expansion."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ..errors import ConfigError
from ..memo import Memo
from ..workspace import Workspace
from .document import STDIN, Document, parse, read_file
from .location import SourceFile
from .packages import ConfiguredFolder, Packages

if TYPE_CHECKING:
    from .expansion import Expansion

GltfUp = Literal["y", "z"]
"""Up axis of a glTF file: ``y`` as in the standard, rotated to Z on reading; ``z`` in files made
for readers that keep the axes of the file.
"""


@dataclass
class Description:
    """Description with all files read for it.

    Attributes:
        path: Path as given by the user.
        document: XML tree; of a xacro file, the expanded tree.
        files: XML files read, the description itself first.
        packages: Finder of its packages and files.
        arguments: xacro arguments of the expansion.
        expansion: Result of the xacro expansion; None for plain URDF.
        gltf_up: Up axis of its glTF meshes.
        repaired: Whether the file is not well-formed, and was read as tolerant readers do; other
            commands than ``lint`` refuse it.
        memo: Values shared by several rules, computed once.
    """

    path: str
    document: Document
    files: list[SourceFile]
    packages: Packages
    arguments: dict[str, str] = field(default_factory=dict)
    expansion: Expansion | None = None
    gltf_up: GltfUp = "y"
    repaired: bool = False
    memo: Memo = field(default_factory=Memo, init=False, repr=False, compare=False)

    @property
    def workspace(self) -> Workspace:
        """Return the workspace that reads its files, and no file that it may not read."""
        return self.packages.workspace

    def without_cache(self) -> Description:
        """Return the same description with a workspace that rereads other files."""
        packages = self.packages.with_workspace(self.packages.files.with_empty_memo())
        return replace(self, packages=packages)

    def resolve(self, uri: str) -> Path:
        """Return the file of a URI or path; see :meth:`Packages.resolve`.

        A relative path is relative to the description, as in its readers, even if it is written in
        an included xacro file.
        """
        return self.packages.resolve(uri)


def is_xacro(file: SourceFile) -> bool:
    """Tell whether a file requires expansion, by its name or by the xacro namespace in it."""
    return file.path.endswith(".xacro") or b"xmlns:xacro" in file.data


def read_description(
    path: str | Path,
    arguments: Mapping[str, str] | None = None,
    *,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
    configured: Mapping[str, str | Path | ConfiguredFolder] | None = None,
    file: SourceFile | None = None,
    gltf_up: GltfUp = "y",
    workspace: Workspace | None = None,
    finder: Packages | None = None,
) -> Description:
    """Read a description (``-``: standard input), and expand it if it is xacro.

    Raises:
        SourceError: It, or an included file, cannot be read or expanded.
        ConfigError: The value of an argument is not a text.
    """
    workspace = workspace or (Workspace() if finder is None else finder.files)
    file = file or read_file(path, workspace)
    finder = finder or Packages(
        None if file.path == STDIN else file.path,
        named=packages,
        paths=package_paths,
        configured=configured,
        workspace=workspace,
    )
    arguments = dict(arguments or {})
    for name, value in arguments.items():
        if not isinstance(value, str):
            raise ConfigError(f"argument {name} is {value!r}, which is not a text; write '{value}'")
    if not is_xacro(file):
        return Description(str(path), parse(file), [file], finder, arguments, gltf_up=gltf_up)
    from .expand import expand_xacro

    expansion = expand_xacro(file, arguments, finder)
    return Description(
        str(path),
        expansion.make_document(),
        list(expansion.files.values()),
        finder,
        arguments,
        expansion,
        gltf_up,
    )
