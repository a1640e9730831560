"""Every name that a measuring program imports of the tool exists, also inside of functions."""

import ast
import importlib
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "measure"
PROGRAMS = sorted(FOLDER.rglob("*.py"))


def list_imports(path):
    """Yield module and name of each import of the tool in a file."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("urdftool"):
            yield from ((node.module, name.name) for name in node.names)
        elif isinstance(node, ast.Import):
            yield from ((n.name, "") for n in node.names if n.name.startswith("urdftool"))


def has_name(module, name):
    """Tell whether a module has a name, or is absent for want of another package."""
    try:
        found = importlib.import_module(module)
        if not name or hasattr(found, name):
            return True
        importlib.import_module(f"{module}.{name}")
    except ModuleNotFoundError as error:
        return not (error.name or "").startswith("urdftool")
    return True


@pytest.mark.parametrize("path", PROGRAMS, ids=[str(p.relative_to(FOLDER)) for p in PROGRAMS])
def test_the_imports_of_a_program_exist(path):
    missing = [f"{m}: {name}" for m, name in list_imports(path) if not has_name(m, name)]
    assert not missing
