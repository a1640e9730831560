"""``urdftool.expand``: xacro to URDF, as text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from ..arguments import check_arguments
from ..source.document import STDIN, read_file
from ..source.packages import Packages
from .places import check_places


@check_arguments
def expand(
    path: str | Path,
    *,
    args: Mapping[str, str] | None = None,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
) -> str:
    """Expand a xacro file to URDF that is equal, as XML, to the output of ``xacro``.

    Args:
        path: A xacro file, or ``-`` for standard input. Plain URDF is returned equal as XML.
        args: Values of xacro arguments.
        packages: Folders of ROS packages by name; others are searched as on the command line.
        package_paths: Folders that contain ROS packages.

    Raises:
        SourceError: It, or an included file, cannot be read or expanded.
    """
    from ..source.expand import expand_xacro

    paths = check_places(packages, package_paths)
    file = read_file(path)
    finder = Packages(None if file.path == STDIN else file.path, named=packages, paths=paths)
    return expand_xacro(file, args or {}, finder).text
