"""The collections of robots, and exporting one of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path

from urdftool.errors import UrdftoolError
from urdftool.formats.common.directory import write_directory
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.write import write
from urdftool.formats.written import Written
from urdftool.model.elements import Robot
from urdftool.model.load import load
from urdftool.refusal import Refused


@dataclass
class Export:
    """What became of a robot."""

    robot: Robot | None = None
    written: Written | None = None
    model: Path | None = None
    forced: bool = False
    message: str = ""
    rules: set[str] = field(default_factory=set)


def example_folder() -> Path:
    """Where example-robot-data keeps its robots."""
    distribution = metadata.distribution("example-robot-data")
    found = next(f for f in distribution.files or () if f.name == "panda.urdf")
    return Path(str(distribution.locate_file(found))).resolve().parents[2]


def example_robots(folder: Path) -> list[Path]:
    """The URDF files of example-robot-data that have a link.

    Those that write ``package:///NAME``, which names no package, are mended in a copy.
    """
    found = []
    for path in sorted(example_folder().rglob("*.urdf")):
        text = path.read_text(encoding="utf-8", errors="replace")
        if "<link" not in text:
            continue
        if "package:///" in text:
            copy = folder / "mended" / path.name
            copy.parent.mkdir(exist_ok=True)
            copy.write_text(text.replace("package:///", "package://"), encoding="utf-8")
            path = copy
        found.append(path)
    return found


def export(path: Path, folder: Path, packages: dict[str, Path], **choices: object) -> Export:
    """Export a robot; one with defects is exported past them, which is noted."""
    result = Export()
    try:
        result.robot = load(path, packages=packages, package_paths=[path.parent])
        try:
            result.written = write(result.robot, Options(**choices))
        except Refused as refused:
            result.forced = True
            result.rules = {finding.code for finding in refused.findings}
            result.written = write(result.robot, Options(force=True, **choices))
        write_directory(folder, result.written.files, main=result.written.main, overwrite=True)
        result.model = folder / result.written.main
    except UrdftoolError as error:
        result.message = str(error)
    return result
