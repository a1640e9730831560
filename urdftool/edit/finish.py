"""The texts of an edited robot, and its comparison with the robot before."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from ..compare.correspondence import parse_correspondence
from ..compare.declared import compare_declared
from ..compare.difference import Comparison
from ..compare.rows import ROWS, Row, limit_tolerances, narrow_tolerances
from ..errors import OutputError
from ..finding import Finding
from ..model.elements import Robot
from ..output import check_targets
from ..source.document import STDIN
from ..source.location import SourceFile
from ..storage import write_files
from ..workspace import Workspace
from .around import YamlDraft
from .attach import move_paths
from .draft import Draft, open_file
from .references import report_file_names

TOLERANCE = 1e-8
"""Tolerance of the proof of an edit, in the unit of each row. Chosen, no source.

Texts are within 4e-15 of the computed numbers, which add up along a tree of some 100 joints.
"""


@dataclass
class Proof:
    """Comparison of an edited robot with one it was made of.

    Attributes:
        name: What the robot is compared with, such as ``arm.urdf``.
        lines: Words of the lines of the correspondence.
        comparison: The comparison.
    """

    name: str
    lines: list[list[str]]
    comparison: Comparison

    @property
    def text(self) -> str:
        """Return the correspondence as a file for ``verify --map``."""
        head = f"# {self.name}, and what urdftool edit made of it; for urdftool verify --map\n"
        return head + "".join(" ".join(map(_quote, words)) + "\n" for words in self.lines)


def _quote(word: str) -> str:
    return f'"{word}"' if not word or any(letter in word for letter in " \t#") else word


@dataclass
class Edited:
    """An edited robot, in memory.

    Attributes:
        robot: The robot.
        data: Bytes of the URDF.
        proofs: Comparisons with the robots it was made of.
        files: Files next to the URDF by their relative paths: SRDF, YAML, meshes.
        notes: What is not kept, or must be known, each with its place.
        inputs: Paths of the files that were read.
        sources: Robots of the proofs, as they were before.
    """

    robot: Robot
    data: bytes
    proofs: list[Proof]
    files: dict[str, bytes | Path] = field(default_factory=dict)
    notes: list[Finding] = field(default_factory=list)
    inputs: list[str] = field(default_factory=list)
    sources: list[Robot] = field(default_factory=list)

    @property
    def is_proved(self) -> bool:
        """Tell whether nothing differs from what the operation declares."""
        return not any(proof.comparison.is_different for proof in self.proofs)

    def write(self, output: str | Path) -> list[Path]:
        """Write the robot; see :func:`write_edited`."""
        return write_edited(self, output)


def finish(
    draft: Draft,
    sources: Sequence[tuple[Robot, str, list[list[str]]]],
    output: str | Path | None,
    *,
    tolerance: float = TOLERANCE,
) -> Edited:
    """Make the texts of an edited robot, read them, and compare the robot with its sources."""
    rows = narrow_tolerances(ROWS, tolerance)
    file = draft.file
    folder = Path(file.path).parent
    if output is not None:
        move_paths(draft, Path(output).parent)
        folder = Path(output).parent
    name = Path(file.path).name.split(".")[0] + ".urdf" if output is None else Path(output).name
    yaml = [file for file in draft.around if isinstance(file, YamlDraft) and file.edits]
    report_file_names(draft, [Path(file.file.path).name for file in yaml])
    data = draft.make_bytes()
    place = str(folder / name) if file.path != STDIN or output is not None else STDIN
    edited = _read_result(draft, SourceFile(place, data))
    proofs = [
        Proof(name, lines, _compare(source, edited, lines, rows)) for source, name, lines in sources
    ]
    files = _name_files(draft, get_stem(name))
    inputs = [one.path for one in (*draft.description.files, *(a.file for a in draft.around))]
    before = [source for source, _, _ in sources]
    return Edited(edited, data, proofs, files, draft.notes, inputs, before)


def prove_again(edited: Edited, robot: Robot) -> Edited:
    """Return the result with another robot, which is compared with the same sources."""
    rows = narrow_tolerances(ROWS, TOLERANCE)
    proofs = [
        Proof(proof.name, proof.lines, _compare(source, robot, proof.lines, rows))
        for source, proof in zip(edited.sources, edited.proofs, strict=True)
    ]
    return replace(edited, robot=robot, proofs=proofs)


def _read_result(draft: Draft, file: SourceFile) -> Robot:
    """Read the result; new meshes, which are not on disk yet, are seen by an overlay."""
    description = draft.description
    packages = description.packages.make_finder_for(file.path)
    folder = Path(file.path).parent
    content = {
        str(folder / name): data for name, data in draft.meshes.items() if isinstance(data, bytes)
    }
    if content:
        packages = packages.with_workspace(Workspace(content))
    return open_file(replace(description, path=file.path, packages=packages), file).robot


def _compare(
    source: Robot, edited: Robot, lines: list[list[str]], rows: Sequence[Row]
) -> Comparison:
    declared = parse_correspondence(list(enumerate(lines, 1)), 2)
    if declared.tolerance:
        rows = limit_tolerances(ROWS, declared.tolerance)
    return compare_declared(source, edited, declared, rows=rows)


def is_xacro_name(output: str | Path) -> bool:
    """Tell whether an output has the name of a xacro file."""
    return Path(output).suffix == ".xacro"


def get_stem(name: str | Path) -> str:
    """Return the name of a file without ``.urdf``, ``.xacro`` or both."""
    path = Path(name)
    return Path(path.stem).stem if is_xacro_name(path) else path.stem


def _name_files(draft: Draft, stem: str) -> dict[str, bytes | Path]:
    """Return the files around by their new names: an SRDF has that of the URDF."""
    files: dict[str, bytes | Path] = dict(draft.meshes)
    for file in draft.around:
        path = PurePosixPath(file.file.path)
        is_yaml = isinstance(file, YamlDraft)
        name = path.name if is_yaml else f"{stem}.srdf"
        number = 2
        while name in files:
            end = path.suffix if is_yaml else ".srdf"
            name = f"{path.stem}_{number}{end}"
            number += 1
        files[name] = file.make_bytes()
    return files


def write_edited(
    edited: Edited, output: str | Path, *, inputs: Iterable[str | Path] = ()
) -> list[Path]:
    """Write the URDF and all files next to it; return their paths, the URDF last.

    Raises:
        OutputError: A file cannot be written or is an input, or the name is that of a xacro file;
            nothing is changed then.
    """
    target = Path(output)
    source = edited.robot.source
    if is_xacro_name(target) and (source is None or source.expansion is None):
        raise OutputError(
            "the result is URDF without macros; give it the ending .urdf", path=target
        )
    written: dict[Path, bytes | Path] = {
        target.parent / name: data for name, data in edited.files.items()
    }
    for number, proof in enumerate(edited.proofs):
        end = ".map" if number == 0 else f".{number + 1}.map"
        written[target.with_name(get_stem(target) + end)] = proof.text.encode("utf-8")
    written[target] = edited.data
    read = [path for path in (*edited.inputs, *inputs) if path not in (STDIN, "-")]
    check_targets(written, inputs=read)
    write_files(written)
    return list(written)
