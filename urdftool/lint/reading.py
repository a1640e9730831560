"""Reading of what a check looks at, as tolerantly as the readers of robots do."""

from __future__ import annotations

from dataclasses import replace

from ..configuration import Configuration
from ..errors import SourceError, UrdftoolError
from ..model.elements import Robot
from ..source.description import Description, is_xacro, read_description
from ..source.document import STDIN, Document, Element
from ..source.location import SourceFile
from ..source.packages import Packages
from ..source.well_formed import repair
from .options import Options


def read_in_other_format(
    file: SourceFile, options: Options, configuration: Configuration
) -> Robot | None:
    """Read a robot in a format other than URDF; None for URDF and xacro.

    Raises:
        UrdftoolError: The file cannot be read.
    """
    assert options.read_other is not None
    return options.read_other(file, make_packages(file, options, configuration))


def make_packages(file: SourceFile, options: Options, configuration: Configuration) -> Packages:
    """Return the packages that a file can name."""
    return Packages(
        None if file.path == STDIN else file.path,
        named=options.packages,
        paths=options.package_paths,
        configured=configuration.packages,
        workspace=options.workspace,
    )


def read_urdf(file: SourceFile, options: Options, configuration: Configuration) -> Description:
    """Read a URDF or xacro file.

    Raises:
        UrdftoolError: It cannot be read or expanded.
    """
    return read_description(
        file.path if file.path != "<stdin>" else "-",
        options.arguments,
        packages=options.packages,
        package_paths=options.package_paths,
        configured=configuration.packages,
        file=file,
        gltf_up=options.gltf_up or configuration.gltf_up,
        workspace=options.workspace,
    )


def read_mended(
    file: SourceFile, options: Options, configuration: Configuration
) -> Description | None:
    """Read a file that is not well-formed as tolerant readers do, to check the rest of it."""
    is_expanded = file.path.endswith(".urdf") and b"<xacro:" not in file.data
    repaired = repair(file) if is_expanded or not is_xacro(file) else None
    if repaired is None:
        return None
    try:
        return replace(read_urdf(repaired, options, configuration), repaired=True)
    except SourceError:
        return None


def make_unexpanded(
    file: SourceFile, failures: list[UrdftoolError], packages: Packages
) -> Description:
    """Return a description without a robot, for its source files."""
    files = [file]
    for failure in failures:
        if failure.at is not None:
            files += [failure.at.file, *(call.file for call in failure.at.calls)]
    unique = list({f.path: f for f in files}.values())
    document = Document(file, Element("", {}, None, file, 0), [])
    return Description(file.path, document, unique, packages)
