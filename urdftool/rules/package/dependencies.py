"""Find dependencies between packages in their manifests."""

from __future__ import annotations

from pathlib import Path

from ...errors import PackageNotFound
from ...source.document import Element
from ...source.nearby_files import read_optional_document
from ...source.packages import Packages
from ...workspace import Workspace

_MOST_PACKAGES = 2000
"""Number of packages whose dependencies are followed. Chosen, no source."""


def find_dependency_chain(
    start: str, goal: str, packages: Packages, *, conditional: bool = False
) -> tuple[str, ...]:
    """Find the shortest chain of dependencies from one package to another.

    Args:
        start: The package that depends.
        goal: The package that it may depend on.
        packages: Finds packages; one that is not found depends on nothing.
        conditional: Whether dependencies with a ``condition`` count too.

    Returns:
        The packages from ``start`` to ``goal``; empty if there is no chain.
    """
    ways: dict[str, tuple[str, ...]] = {start: (start,)}
    todo = [start]
    while todo and len(ways) < _MOST_PACKAGES:
        name = todo.pop(0)
        try:
            folder = packages.find(name)
        except PackageNotFound:
            continue
        for element in _list_dependencies(packages.workspace, folder):
            other = element.text.strip()
            if other in ways or (element.get("condition") is not None and not conditional):
                continue
            ways[other] = (*ways[name], other)
            if other == goal:
                return ways[other]
            todo.append(other)
    return ()


def _list_dependencies(workspace: Workspace, folder: Path) -> list[Element]:
    """List the dependencies in a package's manifest."""
    document = read_optional_document(workspace, folder / "package.xml")
    if document is None or document.root.tag != "package":
        return []
    children = document.root.children
    return [one for one in children if one.tag.endswith("depend") and one.text.strip()]
