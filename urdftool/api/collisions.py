"""``urdftool.simplify_collisions``: collision geometry that is cheap, tight and measured."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..collision.compute import Result
from ..collision.settings import Settings
from ..model.elements import Robot


def simplify_collisions(
    robot: Robot,
    output: str | Path,
    *,
    settings: Settings | None = None,
    source: str | None = None,
    links: Iterable[str] = (),
    skip_links: Iterable[str] = (),
    keep_primitives: bool = True,
    mesh_dir: str | Path | None = None,
    uri: str = "auto",
    mesh_format: str = "stl",
    jobs: int | None = None,
    cache: bool = True,
    overwrite: bool = False,
) -> dict[str, list[Result]]:
    """Write a robot whose links collide as primitives, hulls or convex pieces.

    Args:
        robot: A robot from ``load``.
        output: The new URDF; of xacro, the expanded text.
        settings: The method and its bounds; None keeps within 1 % of a part's size.
        source: ``"visual"`` or ``"collision"``, the meshes to simplify; None takes the visuals, or
            the collisions where there are none.
        links: The links to work on; none means all.
        skip_links: Links to leave as they are.
        keep_primitives: Whether collisions that are primitives already stay.
        mesh_dir: The folder of the pieces; None is one beside the output.
        uri: ``"package"``, ``"relative"``, ``"file"``, or ``"auto"``: as the robot names its own.
        mesh_format: ``"stl"`` or ``"obj"``.
        jobs: Processes to use; None is one for each core.
        cache: Whether to take results from the cache of the command, and to keep new ones there.
        overwrite: Whether to replace mesh files that are not ours.

    Returns:
        For each link that was worked on, what became of its meshes.

    Raises:
        ConfigError: A link or setting is not known.
        MeshError: A mesh cannot be read or simplified; nothing was written.
        MissingDependency: A library of the extra 'mesh' is not installed.
        OutputError: A file cannot be written; what was there is as it was.
    """
    from ..collision.links import Wishes, plan
    from ..collision.parallel import compute_all
    from ..collision.robot import Place, check_place, tasks_of, write_robot
    from ..collision.settings import Settings
    from ..errors import ModelError, UrdftoolError
    from ..extras import require
    from ..storage import DiskCache, cache_folder

    require("simplify_collisions", "scipy", "manifold3d")
    if robot.source is None:
        raise ModelError("the robot was not read from a description; use urdftool.load")
    wishes = Wishes(
        settings or Settings(), source, tuple(links), tuple(skip_links), keep_primitives
    )
    folder = None if mesh_dir is None else Path(mesh_dir)
    place = Place(Path(output), folder, uri, mesh_format, overwrite=overwrite)
    check_place(robot, place)
    plans, problems = plan(robot, wishes)
    for problem in problems:
        raise problem
    kept = DiskCache(cache_folder("collision") if cache else None)
    results = {}
    for task, result in compute_all(tasks_of(plans), kept, jobs=jobs).items():
        if isinstance(result, UrdftoolError):
            raise result
        results[task] = result
    write_robot(robot, plans, results, place)
    return {
        item.link.name: [results[use.task] for use in item.uses if use.task is not None]
        for item in plans
    }
