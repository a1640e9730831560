"""Masses of links from a file: CSV rows ``link,mass``, or a YAML mapping ``link: mass``."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

from ..errors import SourceError

MAX_BYTES = 4 * 1024 * 1024
"""Size of a file of masses [bytes] that is read. Chosen, no source."""


def read_masses(path: str | Path) -> dict[str, float]:
    """Read masses [kg] by link.

    A CSV file may have a header (``link,mass``) and comments that start with ``#``; columns are
    separated by commas, semicolons or tabs.

    Raises:
        SourceError: The file cannot be read, or a line is not a link and a number.
    """
    file = Path(path)
    try:
        data = file.read_bytes()
    except OSError as error:
        raise SourceError(f"cannot be read: {error.strerror}", path=path) from None
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise SourceError("is not text in UTF-8", path=path) from None
    if len(data) > MAX_BYTES:
        raise SourceError("is too large for a list of masses", path=path)
    masses = (
        _read_yaml(text, file)
        if file.suffix.lower() in (".yaml", ".yml")
        else _read_csv(text, file)
    )
    if not masses:
        raise SourceError("has no masses; expected rows of link,mass", path=path)
    return masses


def _read_csv(text: str, path: Path) -> dict[str, float]:
    separator = next((mark for mark in ("\t", ";") if mark in text), ",")
    found: dict[str, float] = {}
    rows = csv.reader(io.StringIO(text, newline=""), delimiter=separator, skipinitialspace=True)
    first = True
    for row in rows:
        cells = [cell.strip() for cell in row]
        if not any(cells) or cells[0].startswith("#"):
            continue
        heading, first = first, False
        try:
            name, mass = cells[0], float(cells[1])
        except (IndexError, ValueError):
            if heading:
                continue
            raise SourceError(
                f"'{separator.join(row)}' is not a link and its mass [kg], such as "
                f"base_link{separator}4.5",
                path=path,
                line=rows.line_num,
            ) from None
        _add(found, name, mass, path, rows.line_num)
    return found


def _read_yaml(text: str, path: Path) -> dict[str, float]:
    import yaml

    try:
        node = yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or "it cannot be parsed"
        raise SourceError(
            f"is not valid YAML: {problem}", path=path, line=mark.line + 1 if mark else None
        ) from None
    found: dict[str, float] = {}
    if not isinstance(node, yaml.MappingNode):
        raise SourceError("is not a mapping of links to masses, such as base_link: 4.5", path=path)
    pairs: list[tuple[Any, Any]] = node.value
    if len(pairs) == 1 and isinstance(pairs[0][1], yaml.MappingNode):
        pairs = pairs[0][1].value
    for key, value in pairs:
        line = key.start_mark.line + 1
        try:
            mass = float(value.value)
        except (TypeError, ValueError):
            raise SourceError(
                f"the mass of '{key.value}' is not a number; write {key.value}: 4.5",
                path=path,
                line=line,
            ) from None
        _add(found, str(key.value), mass, path, line)
    return found


def _add(found: dict[str, float], name: str, mass: float, path: Path, line: int) -> None:
    if name in found:
        raise SourceError(f"link '{name}' is listed twice", path=path, line=line)
    found[name] = mass
