"""``urdftool.verify``: comparison of robots of any formats as mechanisms."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ..arguments import check_arguments
from ..errors import ConfigError
from ..model.elements import Robot
from ..suggestions import require_number
from .load import load
from .places import list_words

if TYPE_CHECKING:
    from ..compare.several import Agreement


@check_arguments
def verify(
    *robots: Robot | str | Path,
    only: Iterable[str] = (),
    tolerance: float | None = None,
    names: str | Path | None = None,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
) -> Agreement:
    """Compare two or more robots of any formats as mechanisms.

    Frames, axes, limits, masses, shapes and mass matrices of all pairs are compared. Names of
    roots, link frames at other places in the same body, and links that a converter merged are no
    differences.

    Args:
        robots: Robots from :func:`urdftool.load`, or paths of descriptions.
        only: Names of the rows to compare, such as ``"frames"``; empty for all.
        tolerance: Tolerance of every row, in the unit of the row; None for that of each row.
        names: A file with names that belong together, as for ``urdftool verify --map``.
        packages: Folders of ROS packages by name, for paths.
        package_paths: Folders that contain ROS packages, for paths.

    Raises:
        SourceError: A file cannot be read, parsed or expanded.
        ModelError: A file is not a robot description, or the links of a robot do not form a tree.
        ConfigError: Fewer than two robots are given, a row is unknown, or ``names`` is malformed.
        MissingDependency: A file is MJCF, and MuJoCo is not installed.
    """
    from ..compare.correspondence import Correspondence, read_correspondence
    from ..compare.rows import limit_tolerances, select_rows
    from ..compare.several import compare_all

    if len(robots) < 2:
        raise ConfigError("verify compares at least two robots")
    if tolerance is not None:
        require_number("tolerance", tolerance, 0.0)
    rows = select_rows(",".join(list_words("only", only)), tolerance)
    declared = Correspondence() if names is None else read_correspondence(Path(names), len(robots))
    if declared.is_declared and tolerance is None:
        rows = limit_tolerances(rows, declared.tolerance)
    read = [
        robot
        if isinstance(robot, Robot)
        else load(robot, packages=packages, package_paths=package_paths)
        for robot in robots
    ]
    return compare_all(read, rows=rows, names=declared)
