"""JSON schemas of what commands print with ``--format json``.

They are the files in ``docs/schemas``, which a wheel has in ``urdftool/schemas``.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from ..errors import UrdftoolError
from ..suggestions import suggest_name

_PACKAGE = Path(__file__).resolve().parents[1]


def find_schemas() -> dict[str, Path]:
    """Return the files of the schemas by name, such as ``inertia-robot``."""
    folders = (_PACKAGE / "schemas", _PACKAGE.parent / "docs" / "schemas")
    folder = next((one for one in folders if one.is_dir()), folders[0])
    return {path.stem: path for path in sorted(folder.glob("*.json"))}


def read_schema(path: Path) -> str:
    """Return the text of a schema."""
    return path.read_text("utf-8")


def read_title(path: Path) -> str:
    """Return the command line whose output a schema describes."""
    return str(json.loads(read_schema(path))["title"])


def find_schema(words: Sequence[str]) -> Path:
    """Return the schema of a command, or of one of its outputs.

    Args:
        words: Name of a schema, or words of a command line without ``urdftool``.

    Raises:
        UrdftoolError: There is none, or there are several.
    """
    found = find_schemas()
    name = "-".join(word.lstrip("-") for word in words)
    if name in found:
        return found[name]
    line = " ".join(("urdftool", *words))
    of_command = {
        key: path for key, path in found.items() if f"{read_title(path)} ".startswith(f"{line} ")
    }
    if len(of_command) == 1:
        return next(iter(of_command.values()))
    if of_command:
        raise UrdftoolError(
            f"{line} has several outputs; name one of the schemas {', '.join(of_command)}"
        )
    hint = suggest_name(name, found, 0.6) or "; 'urdftool schema' lists the schemas"
    raise UrdftoolError(f"there is no schema '{name}'{hint}")
