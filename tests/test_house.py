"""The house's laws: who may import whom, and which library has which door."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "urdftool"
MODULES = sorted(PACKAGE.rglob("*.py"))

# A room may import from the rooms below it, never from one above or beside.
BELOW = {
    "errors": (),
    "suggestions": (),
    "extras": (
        "errors",
        "suggestions",
    ),
    "parallel": (
        "errors",
        "suggestions",
    ),
    "isolated": ("parallel", "errors", "suggestions"),
    "inputs": (),
    "storage": (
        "errors",
        "suggestions",
    ),
    "source": ("inputs", "errors", "suggestions"),
    "model": ("source", "errors", "suggestions"),
    "finding": ("source",),
    "output": ("storage", "errors", "suggestions"),
    "terminal": (),
    "console": ("terminal", "errors", "suggestions"),
    "configuration": (
        "errors",
        "suggestions",
    ),
    "meshes": (
        "extras",
        "extras",
        "errors",
        "suggestions",
    ),
    "drawing": ("meshes", "model", "source", "errors", "suggestions"),
    "inertia": ("meshes", "model", "source", "parallel", "errors", "suggestions"),
    "collision": (
        *(
            "storage",
            "drawing",
            "meshes",
            "inertia",
            "model",
            "source",
            "parallel",
            "isolated",
            "extras",
            "errors",
            "suggestions",
        ),
    ),
    "viewer": (
        "drawing",
        "inertia",
        "meshes",
        "finding",
        "model",
        "source",
        "extras",
        "extras",
        "errors",
        "suggestions",
    ),
    "rules": ("finding", "model", "source", "meshes", "inputs", "errors", "suggestions"),
    "lint": (
        *("rules", "finding", "model", "source", "configuration", "parallel"),
        *("inputs", "storage", "extras", "errors", "suggestions"),
    ),
    "formats": (
        "finding",
        "model",
        "source",
        "meshes",
        "inertia",
        "output",
        "parallel",
        "storage",
        "extras",
        "extras",
        "errors",
        "suggestions",
    ),
    "graph": ("isolated", "finding", "model", "source", "extras", "errors", "suggestions"),
    "simulation": (
        *("drawing", "formats", "finding", "lint", "meshes", "inertia", "model", "rules", "source"),
        *("parallel", "isolated", "storage", "extras", "errors", "suggestions"),
    ),
    "report": (
        *("graph", "info", "compare", "lint", "rules", "finding", "model", "source", "formats"),
        *("collision", "simulation", "inertia", "extras", "errors", "suggestions"),
    ),
    "info": ("model", "source", "meshes", "errors", "suggestions"),
    "compare": ("model", "source", "errors", "suggestions"),
    "api": (
        *("formats", "simulation", "collision", "inertia", "lint", "rules", "model", "source"),
        *("finding", "output", "storage", "extras", "errors", "suggestions"),
    ),
}


# The only files that may import a library.
DOORS = {
    "xacro": ("source/xacro_hooks.py",),
    "lxml": ("formats/",),
    "trimesh": ("meshes/",),
    "collada": ("meshes/",),
    "scipy": ("meshes/", "inertia/", "collision/"),
    "manifold3d": ("meshes/hull.py", "simulation/solid.py"),
    "click": ("cli.py", "console.py", "commands/", "report/findings.py"),
    "rich": ("report/", "commands/", "formats/", "viewer/server.py"),
    "numpy": (
        *("meshes/", "drawing/", "viewer/", "inertia/", "formats/", "collision/", "simulation/"),
    ),
    "coacd": ("collision/coacd_child.py",),
    "distributed": ("collision/cluster.py",),
    "mujoco": ("formats/mjcf/", "simulation/mj.py"),
    "PIL": (
        *("drawing/", "viewer/glb.py", "formats/mjcf/texture.py"),
        "formats/mjcf/verify_looks.py",
    ),
    "pybullet": ("simulation/bullet",),
    "viser": ("viewer/server.py",),
    "websockets": ("viewer/server.py",),
    "pygraphviz": ("graph/draw.py",),
}


def imports(path):
    """What a module imports: rooms of the package, and libraries."""
    relative = path.relative_to(PACKAGE)
    tree = ast.parse(path.read_text("utf-8"))
    for_annotations = {
        inner
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        for inner in ast.walk(node)
    }
    for node in ast.walk(tree):
        if node in for_annotations:
            continue
        if isinstance(node, ast.ImportFrom) and node.level:
            above = relative.parts[: len(relative.parts) - node.level]
            target = (*above, *(node.module or "").split(".")) if node.module else above
            names = [target[0]] if target and target[0] else [alias.name for alias in node.names]
            yield from (("room", name) for name in names)
        elif isinstance(node, ast.ImportFrom):
            yield "library", (node.module or "").split(".")[0]
        elif isinstance(node, ast.Import):
            yield from (("library", alias.name.split(".")[0]) for alias in node.names)


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_data_walks_one_way(path):
    relative = path.relative_to(PACKAGE)
    room = relative.parts[0].removesuffix(".py")
    if room in ("commands", "cli", "__init__", "__main__"):
        return
    allowed = {room, *BELOW[room]}
    used = {name for kind, name in imports(path) if kind == "room"} - {"__version__"}
    assert used <= allowed, f"{relative} imports {sorted(used - allowed)}"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_each_library_has_its_door(path):
    relative = str(path.relative_to(PACKAGE))
    for kind, name in imports(path):
        if kind == "library" and name in DOORS:
            assert relative.startswith(DOORS[name]), f"{relative} imports {name}"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_rooms_neither_print_nor_exit(path):
    relative = path.relative_to(PACKAGE)
    if relative.parts[0] in ("commands", "cli.py", "console.py", "output.py"):
        return
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Call):
            assert ast.unparse(node.func) not in ("print", "sys.exit", "exit", "click.echo"), (
                relative
            )


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_file_is_one_idea(path):
    assert path.stem not in ("utils", "util", "common", "helpers", "misc", "core")
    text = path.read_text("utf-8")
    assert len(text.splitlines()) <= 500 or "Written by ``python -m" in text
