"""Links that model directives of Drake weld to the world, so that no inertia of them is used."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ..errors import UrdftoolError
from ..source.nearby_files import read_optional_file
from ..source.yaml_tree import Node, parse_yaml
from ..workspace import Workspace, memoize_by_workspace
from .imported_readers import find_project

_NAMES = ("**/*.dmd.yaml", "**/*scenario*.yaml")
"""Names of files with directives; scenarios have a list in each."""


class _Model(NamedTuple):
    """A model that directives add.

    Attributes:
        file: URI of its file.
        welded: Its links that they weld to the world, also through other models.
        is_free: Whether they give it a pose as a free body.
    """

    file: str
    welded: frozenset[str]
    is_free: bool


def find_welded_links(files: Workspace, path: str) -> frozenset[str]:
    """Return the links of a description that are welded in all directives that place its model."""
    project = find_project(files, Path(os.path.abspath(path)).parent)
    if project is None:
        return frozenset()
    placed = [
        model.welded
        for model in _read_models(files, project)
        if (model.welded or model.is_free) and _is_path_of(path, model.file)
    ]
    return frozenset.intersection(*placed) if placed else frozenset()


def _is_path_of(path: str, uri: str) -> bool:
    """Tell whether a path ends with the path of a URI in its package."""
    inside = uri.partition("://")[2].partition("/")[2]
    return bool(inside) and f"/{os.path.abspath(path)}".endswith(f"/{inside}")


@memoize_by_workspace
def _read_models(files: Workspace, project: Path) -> list[_Model]:
    found: list[_Model] = []
    for path in sorted({path for name in _NAMES for path in files.list_matches(project, name)}):
        file = read_optional_file(files, path)
        if file is None or b"add_model" not in file.data:
            continue
        try:
            root = parse_yaml(file)
        except UrdftoolError:
            continue
        for one in (root, *(root.fields or {}).values()):
            directives = one.find("directives")
            if directives is not None:
                found += _list_models(directives.items or [])
    return found


def _list_models(directives: list[Node]) -> Iterator[_Model]:
    """Yield the models of a list of directives."""
    fixed = {"world"}
    welds = [
        (_read(one, "add_weld", "parent"), _read(one, "add_weld", "child")) for one in directives
    ]
    for _ in welds:  # a parent may be welded by a later directive
        fixed |= {child for parent, child in welds if parent in fixed}
    for one in directives:
        name, file = _read(one, "add_model", "name"), _read(one, "add_model", "file")
        if name and file:
            links = {
                link.removeprefix(f"{name}::") for link in fixed if link.startswith(f"{name}::")
            }
            is_free = one.find("add_model", "default_free_body_pose") is not None
            yield _Model(file, frozenset(links), is_free)


def _read(directive: Node, *keys: str) -> str:
    value = directive.find(*keys)
    return "" if value is None else value.text or ""
