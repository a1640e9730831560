"""Read SDF files by libsdformat and by urdftool: ``python -m measure.libsdformat READER FILE…``.

READER is ``read_models.cpp``, compiled with Debian's libsdformat-dev (12.3)::

    g++ -std=c++17 measure/libsdformat/read_models.cpp -o READER \
        $(pkg-config --cflags --libs sdformat12)

Each model is compared: links, frames, mass properties, collisions, number of visuals, joints, axes,
limits, damping and friction. Included models are searched in the four folders above the file.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

from urdftool import load
from urdftool.errors import UrdftoolError

from .compare import compare
from .theirs import Model, read_models


def list_rows(reader: Path, path: Path) -> Iterator[tuple[str, str, list[str]]]:
    """Yield name, size and differences of each model of a file with a link."""
    folders = list(path.resolve().parents[:4])
    models, errors = read_models(reader, path, folders)
    note = ", libsdformat reports errors" if errors else ""
    if not models:
        yield "", f"no model{note}", []
    for model in models:
        if model.links:
            size = f"{len(model.links)} links, {len(model.joints)} joints{note}"
            yield model.name, size, _compare(path, folders, model, len(models) > 1)


def _compare(path: Path, folders: list[Path], model: Model, is_one_of_several: bool) -> list[str]:
    try:
        name = model.name if is_one_of_several else ""
        return list(compare(load(path, package_paths=folders, name=name), model))
    except UrdftoolError as error:
        return [str(error)]


def main() -> int:
    """Print a row for each model; return 1 if one differs."""
    parser = argparse.ArgumentParser(prog="python -m measure.libsdformat", description=__doc__)
    parser.add_argument("reader", type=Path)
    parser.add_argument("files", type=Path, nargs="+")
    options = parser.parse_args()
    rows = [
        (path, *row) for path in options.files for row in list_rows(options.reader.resolve(), path)
    ]
    for path, name, size, differences in rows:
        shown = "; ".join(differences[:4]) or ("equal" if name else "not compared")
        print(f"| {path.parent.name}/{path.name} | {name} | {size} | {shown} |")
    models = [row for row in rows if row[1]]
    differing = sum(bool(row[3]) for row in models)
    print(f"{len(options.files)} files, {len(models)} models, {differing} differ")
    return int(differing > 0)


if __name__ == "__main__":
    sys.exit(main())
