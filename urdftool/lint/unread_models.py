"""MJCF that the installed MuJoCo does not compile, but the one that a project asks for may."""

from __future__ import annotations

import os
import re
from dataclasses import replace
from pathlib import Path

from ..diagnostic import Severity
from ..errors import UrdftoolError
from ..finding import Finding
from ..source.description import Description
from ..source.packages import shorten_path
from .imported_readers import find_imported_readers, find_project, list_code_of

_PIN = re.compile(
    rb"""(?<![\w-])mujoco(?:\[[\w,-]*\])?\s*\(?\s*(?:==|~=|<=?)\s*(\d+)\.(\d+)[\d.]*"""
    rb"""|(?<![\w-])mujoco[-_]py(?![\w-])"""
)
"""A requirement of one release, or of none above; ``mujoco-py`` is for MuJoCo 2.1."""

_OF_REQUIREMENTS = re.compile(
    r"METADATA|PKG-INFO|pyproject\.toml|setup\.(?:py|cfg)|.*require.*\.txt"
)


def name_version(finding: Finding, description: Description) -> Finding:
    """Return a finding of a model that does not compile, with the release of MuJoCo that was run.

    It is a warning if the project asks for an older release, or imports only other readers.
    """
    from importlib.metadata import PackageNotFoundError, version

    try:
        installed = version("mujoco")
    except PackageNotFoundError:
        return finding
    pin = _find_pin(description, installed)
    if pin:
        hint = f"MuJoCo {installed} was run; the project asks for {pin}, which may compile it"
        return replace(finding, hint=hint, severity=Severity.WARNING)
    finding = replace(finding, hint=f"MuJoCo {installed} was run")
    used = find_imported_readers(description, frozenset())
    if used is not None and "mujoco" not in used.readers:
        return replace(finding, severity=Severity.WARNING)
    return finding


def _find_pin(description: Description, installed: str) -> str:
    """Return the requirement of an older MuJoCo, with its file; empty if there is none."""
    files = description.packages.files
    project = find_project(files, Path(os.path.abspath(description.path)).parent)
    if project is None:
        return ""
    newest = tuple(int(part) for part in installed.split(".")[:2])
    for path in list_code_of(files, str(project)):
        if not _OF_REQUIREMENTS.fullmatch(os.path.basename(path)):
            continue
        try:
            text = files.read_bytes(path)
        except (OSError, UrdftoolError):
            continue
        for match in _PIN.finditer(text):
            asked = (int(match[1]), int(match[2])) if match[1] else (2, 1)
            if asked < newest:
                words = b" ".join(match[0].split()).decode("ascii", "replace")
                return f"{words} ({shorten_path(path)})"
    return ""
