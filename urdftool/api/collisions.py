"""``urdftool.simplify_collisions``: simplified collision geometry with a measured error."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..arguments import check_arguments
from ..collision.compute import Result
from ..collision.settings import Settings
from ..model.elements import Robot
from ..suggestions import require_word
from .places import check_jobs, check_settings, list_words


@check_arguments
def simplify_collisions(
    robot: Robot,
    output: str | Path,
    *,
    settings: Settings | None = None,
    source: str | None = None,
    links: Iterable[str] = (),
    skip_links: Iterable[str] = (),
    keep_primitives: bool = True,
    per: str | None = None,
    mesh_dir: str | Path | None = None,
    uri: str = "auto",
    mesh_format: str = "stl",
    jobs: int | None = None,
    cache: bool = True,
    overwrite: bool = False,
) -> dict[str, list[Result]]:
    """Write a robot with primitives, convex hulls or convex pieces as collision geometry.

    Args:
        robot: A robot from ``load``.
        output: Path of the new URDF; for xacro, of the expanded text.
        settings: Method and error bounds; None allows an error of 5 % of the size of a part.
        source: ``"visual"`` or ``"collision"``, the meshes to simplify; None uses the visuals, or
            the collisions of links without visuals.
        links: Links to process; if empty, all.
        skip_links: Links to skip.
        keep_primitives: Whether to keep existing primitive collisions.
        per: ``"link"`` or ``"mesh"``: whether the methods ``"auto"`` and ``"cuts"`` decompose the
            meshes of a link together, or each of them; None is the link.
        mesh_dir: Folder of the new meshes; None is a folder next to the output.
        uri: ``"package"``, ``"relative"``, ``"file"``, or ``"auto"``: the form that the robot uses.
        mesh_format: ``"stl"`` or ``"obj"``.
        jobs: Number of processes; None is one per core.
        cache: Whether to read and store results in the cache of the command.
        overwrite: Whether to replace mesh files not written by urdftool.

    Returns:
        The results of each processed link, by link name; one for each mesh if not together.

    Raises:
        ConfigError: A link or setting is unknown.
        MeshError: A mesh cannot be read or simplified; nothing was written.
        MissingDependency: A library of the extra 'mesh' is not installed.
        ModelError: The robot was not read from a description.
        OutputError: A file cannot be written; previous contents are unchanged.
    """
    from ..collision.links import CollisionOptions, plan
    from ..collision.parallel import compute_all
    from ..collision.robot import Place, check_place, collect_tasks, write_robot
    from ..collision.settings import PER, Settings
    from ..errors import ModelError, UrdftoolError
    from ..extras import require
    from ..storage import DiskCache, cache_folder

    check_jobs(jobs)
    if per is not None:
        require_word("per", per, PER)
    check_settings(settings, Settings)
    require("simplify_collisions", "scipy", "manifold3d")
    if robot.source is None:
        raise ModelError("the robot was not read from a description; use urdftool.load")
    options = CollisionOptions(
        settings or Settings(),
        source,
        tuple(list_words("links", links)),
        tuple(list_words("skip_links", skip_links)),
        keep_primitives,
        per == "mesh",
    )
    folder = None if mesh_dir is None else Path(mesh_dir)
    place = Place(Path(output), folder, uri, mesh_format, overwrite=overwrite)
    check_place(robot, place)
    plans, problems = plan(robot, options)
    for problem in problems:
        raise problem
    disk_cache = DiskCache(cache_folder("collision") if cache else None)
    results = {}
    for task, result in compute_all(collect_tasks(plans), disk_cache, jobs=jobs).items():
        if isinstance(result, UrdftoolError):
            raise result
        results[task] = result
    write_robot(robot, plans, results, place)
    return {
        item.link.name: [results[use.task] for use in item.uses if use.task is not None]
        for item in plans
    }
