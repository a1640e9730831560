"""Measure what an installation takes: ``PYTHON -m tests.installed_size [EXTRA]``.

PYTHON is that of the environment; EXTRA is what it has, ``core`` or ``all``.
"""

import sys
import sysconfig
from pathlib import Path

LARGEST = {"core": 115, "all": 1000}
"""Megabytes (10^6 bytes) that an installation may take, by extra."""

TOOLS = (
    *("pip", "setuptools", "pkg_resources", "_distutils_hack", "distutils-precedence"),
    *("python", "activate", "Activate"),
)
"""What a new environment brings by itself."""


def megabytes(path):
    """The size of a file or folder."""
    files = [path] if path.is_file() else path.rglob("*")
    return sum(file.lstat().st_size for file in files if file.is_file()) / 1e6


def sizes():
    """The parts of this environment's packages, largest first; what it came with left out."""
    places = {"": "purelib", "bin/": "scripts", "share/": "data"}
    found = {}
    for prefix, name in places.items():
        folder = Path(sysconfig.get_path(name)) / ("share" if name == "data" else "")
        parts = sorted(folder.iterdir()) if folder.is_dir() else []
        sizes = {prefix + p.name: megabytes(p) for p in parts if not p.name.startswith(TOOLS)}
        found.update(sizes)  # a program has the name of its package
    return dict(sorted(found.items(), key=lambda item: -item[1]))


if __name__ == "__main__":
    most = LARGEST[sys.argv[1] if len(sys.argv) > 1 else "core"]
    parts = sizes()
    whole = sum(parts.values())
    largest = ", ".join(f"{name} {size:.0f}" for name, size in list(parts.items())[:5])
    print(f"installed: {whole:.0f} MB of at most {most} ({largest})")
    sys.exit(whole > most)
