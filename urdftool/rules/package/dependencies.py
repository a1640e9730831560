"""Dependencies between packages in their manifests: read, followed and added."""

from __future__ import annotations

import re
from pathlib import Path

from ...errors import PackageNotFound
from ...source.comments import remove_comments
from ...source.document import Document, Element
from ...source.nearby_files import read_optional_document
from ...source.packages import Packages
from ...workspace import Workspace, memoize_by_workspace
from ..fix import Change, FixContext, insert_after, prepend_child

_DEPEND = re.compile(r"<(?:\w+_)?depend\b[^<>]*>\s*([\w-]+)\s*</")
_MOST_PACKAGES = 2000
"""Number of packages whose dependencies are followed. Chosen, no source."""


def find_dependency_chain(
    start: str, goal: str, packages: Packages, *, conditional: bool = False
) -> tuple[str, ...]:
    """Find the shortest chain of dependencies from one package to another.

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


def read_manifest_text(workspace: Workspace, folder: Path) -> str:
    """Read the package.xml of a folder without comments; empty if it cannot be read."""
    return remove_comments(read_package_text(workspace, folder / "package.xml"))


@memoize_by_workspace
def read_package_text(workspace: Workspace, path: Path) -> str:
    """Read a file of the package; empty if it cannot be read."""
    try:
        return workspace.read_text(path)
    except OSError:
        return ""


def get_dependencies(workspace: Workspace, folder: Path) -> set[str]:
    """Get the dependencies in a package's manifest."""
    return set(_DEPEND.findall(read_manifest_text(workspace, folder)))


def parse_own_manifest(context: FixContext) -> Document | None:
    """Parse the package.xml of the description's package; None without one."""
    own = context.description.packages.own
    found = (
        read_optional_document(context.workspace, own[1] / "package.xml")
        if own is not None
        else None
    )
    return found if found is not None and found.root.tag == "package" else None


def get_run_tag(package: Element) -> str:
    """Get the tag of run dependencies, which depends on the format of the manifest."""
    return "run_depend" if (package.get("format") or "1").strip() == "1" else "exec_depend"


def add_dependency(package: Element, name: str) -> Change:
    """Add a dependency after others of the same kind, or in the required order."""
    tag = get_run_tag(package)
    line = f"<{tag}>{name}</{tag}>"
    others = [child for child in package.children if child.tag not in ("export", "test_depend")]
    likes = [child for child in others if child.tag in (tag, "depend")]
    behind = likes or others
    return insert_after(behind[-1], line) if behind else prepend_child(package, line)
