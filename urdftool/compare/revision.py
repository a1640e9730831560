"""Descriptions at a git revision: ``REV:path``, with its includes at that revision.

The files of the revision are written to a temporary folder as stored in git: filters, hooks and
attributes of the repository do not apply, and its working tree and index are not changed. Meshes
and images are omitted, since reading a description does not need them.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from ..errors import MissingDependency, SourceError, UrdftoolError
from ..git_command import run_git
from ..model.elements import Mesh, Robot
from ..source.packages import find_packages

_MOST_BYTES = 4 * 1024 * 1024
"""Largest file of a revision that is read [bytes]; chosen, no source."""

_MEDIA = frozenset(
    (
        *(".stl", ".dae", ".obj", ".mtl", ".ply", ".glb", ".gltf", ".bin", ".step", ".stp"),
        *(".png", ".jpg", ".jpeg", ".gif", ".tif", ".tiff", ".hdr", ".webp", ".mp4", ".webm"),
        *(".fcstd", ".blend", ".mov", ".pdf", ".zip", ".gz", ".xz", ".bag", ".db3", ".mcap"),
        *(".onnx", ".pt", ".npz", ".npy"),
    )
)


class Named(NamedTuple):
    """Revision and path of ``REV:path``."""

    revision: str
    path: str


class Entry(NamedTuple):
    """Entry of a git tree: object and size [bytes], -1 for a submodule."""

    path: str
    sha: str
    size: int
    is_link: bool
    is_module: bool


@dataclass(frozen=True)
class Checkout:
    """Files of a revision in a temporary folder.

    Attributes:
        path: Path of the description there.
        folder: Folder that corresponds to the root of the repository.
        top: Root of the working tree of the repository.
        revision: Revision as named by the user.
        modules: Paths of submodules in the repository.
    """

    path: Path
    folder: Path
    top: Path
    revision: str
    modules: tuple[str, ...] = ()

    def format_path(self, text: str) -> str:
        """Return a text with paths of the temporary folder as ``REV:path``."""
        text = text.replace(f"{self.folder}{os.sep}", f"{self.revision}:")
        return text.replace(str(self.folder), f"{self.revision}:")

    def map_folder(self, folder: str | Path) -> Path:
        """Map a folder of the working tree to the temporary folder; other folders are unchanged."""
        real = Path(os.path.realpath(folder))
        if real == self.top or self.top in real.parents:
            return self.folder / real.relative_to(self.top)
        return real

    def restore_paths(self, robot: Robot) -> Robot:
        """Replace paths of the temporary folder in a robot by paths of the working tree.

        Source files get ``REV:path``. The robot is modified and returned.
        """
        if robot.source is not None:
            for file in robot.source.files:
                file.path = self.format_path(file.path)
        here, there = str(self.folder), str(self.top)
        for element in robot.element.walk():
            for name, value in element.attributes.items():
                if here in value:
                    element.attributes[name] = value.replace(here, there)
            element.text = element.text.replace(here, there)
        for _, shape in robot.shapes:
            if isinstance(shape.geometry, Mesh):
                shape.geometry.filename = shape.geometry.filename.replace(here, there)
        return robot

    def restore_error_paths(self, error: UrdftoolError) -> UrdftoolError:
        """Replace paths of the temporary folder in an error by ``REV:path`` and return it."""
        error.message = self.format_path(error.message)
        error.path = None if error.path is None else self.format_path(error.path)
        error.notes = tuple(map(self.format_path, error.notes))
        for call in error.calls:
            call.file.path = self.format_path(call.file.path)
        return error

    def find_neighbors(self) -> Mapping[str, Path]:
        """Return packages in present submodules, and next to a repository that is a package."""
        neighbors: dict[str, Path] = {}
        above = self.top.parent
        if len(above.parts) > 2 and (self.top / "package.xml").exists():  # do not search / or /home
            packages = find_packages(above)
            neighbors |= {n: p for n, p in packages.items() if self.top not in (p, *p.parents)}
        for module in self.modules:
            neighbors |= find_packages(self.top / module)
        return neighbors


def parse_revision(word: str) -> Named | None:
    """Return the revision and path in an argument; None if it is the path of a file."""
    revision, colon, path = word.partition(":")
    if not (colon and path) or os.path.exists(word) or (len(revision) == 1 and os.name == "nt"):
        return None
    return Named(revision, path)


@contextmanager
def check_out(target: Named) -> Iterator[Checkout]:
    """Provide the files of a revision during a ``with`` block.

    Raises:
        SourceError: The repository, revision or file does not exist.
        MissingDependency: git is not installed.
    """
    revision, path = target
    if not revision or revision.startswith("-"):
        raise SourceError(
            f"'{revision}' is not a git revision; write REVISION:FILE, such as HEAD:{path}"
        )
    start = os.path.dirname(os.path.abspath(path)) if os.path.isabs(path) else os.getcwd()
    top = Path(os.fsdecode(_run_git(start, "rev-parse", "--show-toplevel").rstrip(b"\r\n")))
    tree = _run_git(
        start, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{tree}}",
        fail=f"revision '{revision}' does not exist in the git repository {top}",
    )  # fmt: skip
    listing = list(_list_entries(top, tree.decode().strip()))
    blobs = {entry.path: entry for entry in listing if 0 <= entry.size <= _MOST_BYTES}
    inner = _find_in_repository(path, top, blobs)
    if inner is None:
        raise SourceError(
            f"file '{path}' does not exist in revision {revision}", path=f"{revision}:{path}"
        )
    with TemporaryDirectory(prefix="urdftool-") as name:
        folder = Path(os.path.realpath(name)) / (top.name or "repository")
        _write(top, {p: blob for p, blob in blobs.items() if p == inner or _is_read(p)}, folder)
        modules = tuple(entry.path for entry in listing if entry.is_module)
        yield Checkout(folder / inner, folder, top, revision, modules)


def _find_in_repository(path: str, top: Path, blobs: Mapping[str, Entry]) -> str | None:
    """Return the path in the repository, given from its root, as in git, or the current folder."""
    here = os.path.relpath(os.path.realpath(path), os.path.realpath(top))
    candidates = [os.path.normpath(path), here]
    if path.startswith(("./", "../")):
        candidates.reverse()
    return next((p for p in (c.replace(os.sep, "/") for c in candidates) if p in blobs), None)


def _is_read(path: str) -> bool:
    return os.path.splitext(path)[1].lower() not in _MEDIA


def _list_entries(top: Path, tree: str) -> Iterator[Entry]:
    for line in _run_git(top, "ls-tree", "-r", "-z", "--long", "--full-tree", tree).split(b"\0"):
        facts, tab, path = line.partition(b"\t")
        if tab:
            mode, kind, sha, size = facts.decode("ascii").split()
            length = int(size) if size.isdigit() else -1
            yield Entry(os.fsdecode(path), sha, length, mode == "120000", kind == "commit")


def _write(top: Path, blobs: Mapping[str, Entry], folder: Path) -> None:
    """Write files as stored in git, with one call of git."""
    data = _run_git(
        top, "cat-file", "--batch", given="".join(f"{b.sha}\n" for b in blobs.values()).encode()
    )
    (folder / ".git").mkdir(parents=True)  # empty; ends the search for packages
    at = 0
    links: list[tuple[Path, str]] = []
    for path, blob in blobs.items():
        end = data.index(b"\n", at)
        size = int(data[at:end].rsplit(b" ", 1)[1])
        content = data[end + 1 : end + 1 + size]
        at = end + 1 + size + 1
        target = folder / path
        if ".." in target.parts or ".git" in Path(path).parts:
            continue
        if blob.is_link:
            links.append((target, os.fsdecode(content)))
            continue
        with suppress(OSError):  # a path that is a file and a folder
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
    _write_links(links, folder)


def _write_links(links: Sequence[tuple[Path, str]], folder: Path) -> None:
    """Create links after all files; those that leave the revision are removed again."""
    made = []
    for target, goal in links:
        with suppress(OSError, ValueError):
            if Path(os.path.realpath(target.parent)).is_relative_to(folder):
                target.parent.mkdir(parents=True, exist_ok=True)
                target.symlink_to(goal)
                made.append(target)
    for target in made:
        if not Path(os.path.realpath(target)).is_relative_to(folder):
            target.unlink()


def _run_git(
    folder: str | Path, *words: str, fail: str | None = None, given: bytes | None = None
) -> bytes:
    try:
        done = run_git(folder, *words, given=given)
    except FileNotFoundError:
        raise MissingDependency(
            "REVISION:FILE requires git, which is not installed; pass a file instead"
        ) from None
    if done.returncode:
        lines = done.stderr.decode("utf-8", "replace").strip().splitlines() or ["no message"]
        raise SourceError(fail or f"git failed in {folder}: {lines[-1]}")
    return done.stdout
