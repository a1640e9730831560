"""The robots that are damaged: small ones, each with what lies beside it."""

from __future__ import annotations

import shutil
from pathlib import Path

from measure.benchmarks.robots import CORPUS, FIXTURES

MAX_BYTES = 60_000
MAX_FOLDER = 3_000_000


def candidates():
    """Where descriptions are from, and of each the folder that is copied with it.

    Fixtures, packages of PyPI and the corpus, as far as they are there; all are drawn from alike.
    """
    found = {}
    roots = [FIXTURES / "robots", FIXTURES / "rules"]
    try:
        import pybullet_data

        roots.append(Path(pybullet_data.getDataPath()))
    except ImportError:
        pass
    if CORPUS.exists():
        roots.append(CORPUS)
    for root in roots:
        for path in sorted(root.rglob("*")):
            if path.suffix in (".urdf", ".xacro") and path.stat().st_size < MAX_BYTES:
                folder = _package(path, root)
                if _size(folder) < MAX_FOLDER:
                    found.setdefault(root, []).append((path, folder))
    return list(found.values())


def _package(path, root):
    """The folder to copy: the package, or the description's own folder."""
    for folder in path.parents:
        if (folder / "package.xml").exists():
            return folder
        if folder == root:
            break
    return path.parent


_sizes: dict[Path, int] = {}


def _size(folder):
    if folder not in _sizes:
        _sizes[folder] = sum(p.stat().st_size for p in folder.rglob("*") if p.is_file())
    return _sizes[folder]


def copied(path, folder, into):
    """A copy of the folder; the path of the description in it. Every file may be written."""
    target = into / folder.name
    shutil.copytree(folder, target, copy_function=shutil.copyfile)
    for inner in (target, *target.rglob("*")):
        inner.chmod(0o755 if inner.is_dir() else 0o644)
    return target / path.relative_to(folder)
