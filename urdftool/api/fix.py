"""``urdftool.fix``: a description with its findings mended."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from ..lint.fix_run import Mended
from ..source.description import GltfUp


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
) -> Mended:
    """Mend what ``check`` finds, in the bytes of the source and no others.

    Each fix is proved: the description is read again, and what would leave more to find is not
    done. Nothing is written unless that is asked for.

    Args:
        path: A ``.urdf`` or ``.xacro`` file. Files that it includes are mended, too, where they
            are in its project.
        args: Values for xacro arguments.
        packages: Folders of ROS packages by name; others are found as on the command line.
        package_paths: Folders with ROS packages below.
        select: Rule names, prefixes with ``*`` and families; None is what is on by default.
        ignore: The same, taken away.
        targets: Simulators and middlewares; none means that they are inferred.
        config: A configuration file, instead of the nearest above the description.
        unsafe: Whether to make also fixes that invent or remove physics.
        meshes: Whether to make also fixes that write mesh files.
        write: Whether to write the files that changed: all of them, or none.
        gltf_up: The axis that is up in glTF meshes; None for what the configuration says.

    Raises:
        SourceError: The file cannot be read.
        ConfigError: A rule, target or option is not known.
        OutputError: A file cannot be written, or was changed meanwhile.
    """
    from ..lint.fix_run import mend
    from ..lint.outcome import Options
    from ..lint.run import lint_file
    from ..lint.settings import Settings, check_selectors, check_targets

    chosen = Settings(
        select=None if select is None else check_selectors(select),
        ignore=check_selectors(ignore),
        targets=check_targets(targets),
    )
    options = Options(chosen, args or {}, packages or {}, tuple(package_paths), config, fixes=True)
    options.gltf_up = gltf_up
    if unsafe:
        from ..inertia.scales import Scales
        from ..rules.inertia.solids import DENSITY

        options.weigh = Scales(DENSITY)
    report = lint_file(path, options)
    if report.error is not None:
        raise report.error
    mended = mend(report, options, unsafe=unsafe, meshes=meshes)
    if write and mended.after:
        from ..output import rewrite

        rewrite(mended.before, mended.after)
    return mended
