"""Read a robot from a stage of OpenUSD with the schemas of UsdPhysics.

Bodies become links, and joints become joints of URDF. Attributes of Newton take precedence over
those of PhysX. Names and frames that an export of this tool stored in ``customData`` are restored.
OpenUSD runs in a process with limits, because a small file can be a large stage.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ...dependencies import Dependencies
from ...errors import SourceError, UrdftoolError
from ...extras import is_installed, make_missing_error
from ...limited import Limits, call_with_limits
from ...source.document import STDIN
from ...source.location import Place, SourceFile
from ...source.packages import Packages
from ...storage import cache_folder
from ...workspace import Workspace
from ..reading import Opened, Reading, choose_limits, open_description, report_limits

LIMITS = Limits(time=300.0, processor=15.0, memory=640 << 20)
"""Limits of reading a stage. Chosen so that a command stays below 20 s and 1 GiB; no source."""


def read(
    path: str | Path,
    *,
    file: SourceFile | None = None,
    packages: Packages | None = None,
    workspace: Workspace | None = None,
    name: str = "",
    mesh_folder: str | Path | None = None,
    **_: Any,
) -> Reading:
    """Read a robot.

    ``name`` is that of an articulation, empty for the one with most bodies; without a mesh folder,
    meshes are in the user's cache.

    Raises:
        MissingDependency: usd-core is not installed.
        SourceError: The file cannot be read.
        ModelError: OpenUSD does not open it, or it has no rigid body.
    """
    opened = open_description(path, file, packages, workspace)
    if opened.file.data.startswith(b"PK") and opened.file.path.endswith(".zip"):
        text = "is a zip file, not a USDZ package; extract it, and name the description in it"
        raise SourceError(text, path=path)
    if not is_installed("pxr"):
        raise make_missing_error("pxr", "a USD file")
    folder = Path(mesh_folder) if mesh_folder is not None else cache_folder("usd-meshes")
    opened.packages.access.allow(folder)
    with (
        report_limits("OpenUSD", "stage", Place(opened.file, 0, 0)),
        _locate(opened.file) as located,
    ):
        result, read_files = call_with_limits(
            _read_stage,
            *opened,
            *(str(path), located, name, folder),
            limits=choose_limits(LIMITS, opened.workspace),
            prepare=_import_library,
            threaded="pxr",
        )
    if opened.workspace.dependencies is not None:
        opened.workspace.dependencies.include(read_files)
    if isinstance(result, UrdftoolError):
        raise result
    return result


def _import_library() -> None:
    """Import OpenUSD and its schemas; it has no threads, each of which would reserve memory."""
    from pxr import Usd, Work

    from . import read_child  # noqa: F401

    Work.SetConcurrencyLimit(1)
    Usd.Stage.CreateInMemory()


def _read_stage(
    file: SourceFile, packages: Packages, workspace: Workspace, *arguments: Any
) -> tuple[Reading | UrdftoolError, Dependencies]:
    """Read a robot in the process with limits, which imports OpenUSD."""
    from .read_child import read_stage

    return read_stage(Opened(file, packages, workspace), *arguments)


@contextmanager
def _locate(file: SourceFile) -> Iterator[str]:
    """Yield the path of a stage: of a temporary copy, if it is standard input."""
    if file.path != STDIN:
        yield file.path
        return
    with TemporaryDirectory(prefix="urdftool-") as folder:
        copy = Path(folder) / f"stdin{_get_suffix(file.data)}"
        copy.write_bytes(file.data)
        yield str(copy)


def _get_suffix(data: bytes) -> str:
    if data.startswith(b"PXR-USDC"):
        return ".usdc"
    return ".usdz" if data.startswith(b"PK") else ".usda"
