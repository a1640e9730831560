"""One run of the command: read, write, verify, and say what was lost."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from ...configuration import find_configuration
from ...console import Console
from ...errors import OutputError
from ...model.load import robot_of
from ...source.description import Description, read_description
from ...source.document import STDIN
from ..directory import write_beside, write_directory
from ..said import lines
from ..said import strict as as_errors
from ..written import Written
from .options import VERSIONS, Options
from .write import write

FILE_SUFFIXES = (".sdf", ".xml", ".world")


@dataclass(frozen=True)
class Job:
    """What the user asked for, beside the choices of the export."""

    path: str
    arguments: dict[str, str]
    output: str
    overwrite: bool = False
    verify: bool = False
    strict: bool = False
    json: bool = False


def options_for(
    output: str, *, target: str, version: str, mesh_dir: str, **choices: Any
) -> Options:
    """The choices of an export to a place.

    Raises:
        ValueError: They do not go together.
    """
    if version and version not in VERSIONS[target]:
        known = " and ".join((", ".join(VERSIONS[target][:-1]), VERSIONS[target][-1]))
        raise ValueError(f"{target} reads SDF {known}, not {version}")
    inner = os.path.normpath(mesh_dir)
    if os.path.isabs(inner) or inner.startswith(".."):
        raise ValueError(f"--mesh-dir is a folder beside the model, not '{mesh_dir}'")
    full = Path(os.path.abspath(output))
    single = full.suffix in FILE_SUFFIXES
    return Options(
        target=target,
        version=version,
        folder=(full.parent if single else full).name,
        file=full.name if single else "",
        mesh_dir=Path(inner).as_posix(),
        **choices,
    )


def run(
    console: Console,
    job: Job,
    options: Options,
    packages: Mapping[str, Path],
    package_paths: tuple[str, ...],
) -> int:
    """Do it.

    Returns:
        The exit code: 1 where the verification found what was not announced, 2 where losses are
        errors.
    """
    description = read_description(
        job.path,
        job.arguments,
        packages=packages,
        package_paths=package_paths,
        configured=find_configuration(job.path, console.config).packages,
    )
    robot = robot_of(description)
    written = write(robot, options)
    refused = as_errors(written.losses) if job.strict else []
    said = refused or written.losses
    for line in lines(said):
        console.note(line) if not refused else click.echo(line, err=True)
    if refused:
        console.note(
            f"{job.output}: not written; {len(refused)} things cannot be carried (--strict)"
        )
        if job.json:
            click.echo(_json(written, []))
        return 2
    _put(job, written, description)
    checks = []
    if job.verify:
        from .verify.compare import verify

        checks = verify(robot, written, options, job.output)
    if job.json:
        click.echo(_json(written, checks))
    elif checks:
        from .verify.table import table

        click.echo(table(checks, color=console.colors()), nl=False)
    console.note(_summary(job, written))
    return 1 if any(check.failed for check in checks) else 0


def _put(job: Job, written: Written, description: Description) -> None:
    inputs = [file.path for file in description.files if file.path != STDIN]
    if Path(job.output).suffix in FILE_SUFFIXES:
        put = write_beside
    else:
        put = write_directory
        if Path(job.output).is_file():
            raise OutputError("is a file; a folder, or a name with .sdf is wanted", path=job.output)
    put(job.output, written.files, main=written.main, overwrite=job.overwrite, inputs=inputs)


def _summary(job: Job, written: Written) -> str:
    model = written.files[written.main]
    assert isinstance(model, bytes)
    counts = ", ".join(
        f"{model.count(f'<{tag} '.encode())} {tag}s" for tag in ("link", "joint", "frame")
    )
    copied = sum(isinstance(content, Path) for content in written.files.values())
    meshes = f", {copied} files copied" if copied else ""
    return f"{job.output}: {counts}{meshes}"


def _json(written: Written, checks: list[Any]) -> str:
    from ...report.findings_json import finding_record

    table: dict[str, Any] = {
        "version": 1,
        "files": sorted(written.files),
        "losses": [finding_record(finding) for finding in written.losses],
        "renamed": [
            {"kind": kind, "from": old, "to": new} for (kind, old), new in written.renamed.items()
        ],
        "checks": [check.record() for check in checks],
    }
    return json.dumps(table, indent=1, ensure_ascii=False)
