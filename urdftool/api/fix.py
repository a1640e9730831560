"""``urdftool.fix``: a description with its findings fixed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from ..arguments import check_arguments
from ..lint.fix_run import FixedDescription
from ..source.description import GltfUp
from .places import check_places, list_words


@check_arguments
def fix(
    path: str | Path,
    *,
    args: Mapping[str, str] | None = None,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
    select: Iterable[str] | None = None,
    ignore: Iterable[str] = (),
    targets: Iterable[str] = (),
    config: str | None = None,
    unsafe: bool = False,
    meshes: bool = False,
    write: bool = False,
    gltf_up: GltfUp | None = None,
) -> FixedDescription:
    """Fix the findings of ``check``, changing only the affected bytes of the source.

    Each fix is checked: the description is read again, and a fix that adds findings is reverted.
    Nothing is written by default.

    Args:
        path: A ``.urdf`` or ``.xacro`` file. Included files of its project are fixed too.
        args: Values of xacro arguments.
        packages: Folders of ROS packages by name; others are searched as on the command line.
        package_paths: Folders that contain ROS packages.
        select: Rule names, prefixes with ``*`` and families; None selects the default rules.
        ignore: Rule names, prefixes and families to exclude.
        targets: Simulators and middleware; if empty, they are inferred.
        config: Configuration file; None uses the nearest one above the description.
        unsafe: Whether to apply fixes that add or remove physical properties too.
        meshes: Whether to apply fixes that write mesh files too.
        write: Whether to write the changed files: all of them, or none.
        gltf_up: Up axis of glTF meshes; None uses the configuration.

    Raises:
        SourceError: The file cannot be read.
        ConfigError: A rule, target or option is unknown.
        OutputError: A file cannot be written, or was changed by another program.
    """
    from ..formats.detect import read_other_format
    from ..lint.fix_run import fix_description
    from ..lint.options import Options
    from ..lint.run import check_file, warn_of_renamed
    from ..lint.settings import Settings, check_selectors, check_targets

    paths = check_places(packages, package_paths, gltf_up=gltf_up)
    selected = None if select is None else list_words("select", select)
    ignored = list_words("ignore", ignore)
    warn_of_renamed((*(selected or ()), *ignored), path, config)
    chosen = Settings(
        select=None if selected is None else check_selectors(selected),
        ignore=check_selectors(ignored),
        targets=check_targets(list_words("targets", targets)),
    )
    options = Options(chosen, args or {}, packages or {}, paths, config, fixes=True)
    options.gltf_up, options.read_other = gltf_up, read_other_format
    if unsafe:
        from ..inertia.scales import Scales
        from ..rules.inertia.solids import DENSITY

        options.compute_inertia = Scales(DENSITY)
    report = check_file(path, options)
    if report.error is not None:
        raise report.error
    result = fix_description(report, options, unsafe=unsafe, meshes=meshes)
    if write and result.after:
        from ..output import rewrite

        rewrite(result.before, result.after)
    return result
