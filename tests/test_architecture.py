"""The architecture: who may import whom, one place for each library, no hidden state."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "urdftool"
MODULES = sorted(PACKAGE.rglob("*.py"))


@cache
def tree_of(path):
    """Parse a module, when the first test needs it: other tests are collected sooner."""
    return ast.parse(path.read_text("utf-8"))


@cache
def walk(tree):
    """Return the nodes of a module; several tests read them."""
    return tuple(ast.walk(tree))


def for_each_module(test):
    """Run a test for each module as one test, and name the modules for which it fails."""

    def run():
        found = []
        for path in MODULES:
            try:
                test(path)
            except AssertionError as error:
                found.append(f"{path.relative_to(PACKAGE)}: {error}")
        assert not found, "\n".join(found)

    run.__name__, run.__doc__ = test.__name__, test.__doc__
    return run


BASE = (
    *(
        "listing",
        "control_characters",
        "errors",
        "extras",
        "suggestions",
        "arguments",
        "mujoco_library",
        "parallel",
        "cluster",
    ),
    *("cluster_child", "landlock", "isolated", "resident_memory"),
    *(
        "limited",
        "exchange",
        "leftovers",
        "storage",
        "dependencies",
        "file_access",
        "memo",
        "collector",
    ),
    *("workspace", "projects", "git_command", "git_changes", "diagnostic", "standard_output"),
)
"""Modules that know nothing of robots, each of which may import those before it."""

# A package may import from the packages below it, never from one above or beside.
BELOW = {
    **{name: BASE[:index] for index, name in enumerate(BASE)},
    "source": BASE,
    "model": ("source", *BASE),
    "finding": ("source", "diagnostic"),
    "refusal": ("finding", "source", *BASE),
    "output": BASE,
    "terminal": ("control_characters",),
    "console": BASE,
    "configuration": ("source", *BASE),
    "geometry": ("model", "source", *BASE),
    "mechanics": ("model", "listing"),
    "drawing": ("geometry", "model", *BASE),
    "inertia": (
        *("lint", "rules", "finding", "mechanics", "geometry", "model", "source"),
        *BASE,
    ),
    "collision": ("drawing", "geometry", "inertia", "model", "output", "source", *BASE),
    "srdf": ("geometry", "model", "output", "source", *BASE),
    "viewer": ("drawing", "mechanics", "finding", "model", "source", *BASE),
    "rules": ("srdf", "finding", "mechanics", "model", "source", "geometry", *BASE),
    "lint": ("rules", "finding", "model", "source", "configuration", *BASE),
    "formats": (
        *("lint", "rules", "compare", "finding", "mechanics", "model", "source", "geometry"),
        *("refusal", "output", *BASE),
    ),
    "bundle": (
        *("collision", "drawing", "formats", "finding", "geometry", "model", "source", "output"),
        *("refusal", *BASE),
    ),
    "fmt": ("lint", "source", *BASE),
    "server": (
        *("edit", "fmt", "formats", "inertia", "lint", "rules", "finding", "model", "source"),
        *("configuration", *BASE),
    ),
    "graph": ("lint", "rules", "finding", "model", "source", *BASE),
    "simulation": (
        *("drawing", "finding", "lint", "mechanics", "geometry", "inertia", "model", "refusal"),
        *("rules", "source", *BASE),
    ),
    "report": (
        *("bundle", "graph", "info", "compare", "edit", "lint", "rules", "finding", "model"),
        *("formats", "srdf", "source"),
        *("collision", "inertia", "mechanics", *BASE),
    ),
    "info": ("model", "geometry", *BASE),
    "compare": ("geometry", "mechanics", "model", "source", *BASE),
    "edit": (
        *(
            "bundle",
            "compare",
            "mechanics",
            "lint",
            "rules",
            "finding",
            "geometry",
            "model",
            "source",
        ),
        *("output", *BASE),
    ),
    "api": (
        *(
            "bundle",
            "edit",
            "geometry",
            "compare",
            "formats",
            "simulation",
            "srdf",
            "collision",
            "inertia",
            "lint",
            "rules",
            "model",
            "source",
        ),
        *("finding", "output", *BASE),
    ),
}


# The only files that may import a library.
PLACES = {
    "multiprocessing": ("parallel.py",),
    "concurrent": (),
    "subprocess": (
        "isolated.py",
        "cluster.py",
        "limited.py",  # TimeoutExpired
        "source/expansion_process.py",
        "source/expansion_server.py",
        "git_command.py",
        "formats/sdf/verify/loader.py",  # gz sdf
    ),
    "xacro": (),  # source/xacro_copy.py loads a copy
    "lxml": ("formats/",),
    "trimesh": ("geometry/",),
    "yourdfpy": ("bundle/yourdfpy_reader.py",),
    "scipy": ("geometry/", "inertia/", "collision/", "bundle/surface_distance.py"),
    "manifold3d": ("geometry/hull.py", "simulation/solids.py"),
    "click": ("cli.py", "console.py", "commands/", "report/"),
    "rich": ("viewer/server.py",),
    "numpy": (
        *("mechanics/", "geometry/", "drawing/", "viewer/", "inertia/", "compare/", "formats/"),
        *("collision/", "simulation/", "srdf/", "bundle/mesh_formats.py", "bundle/collada_file.py"),
        *("bundle/yourdfpy_reader.py", "bundle/reduce.py", "bundle/surface_distance.py"),
    ),
    "coacd": ("collision/coacd_child.py",),
    "fcl": ("srdf/",),
    "distributed": ("cluster.py",),
    "pxr": ("formats/usd/",),
    "newton": ("formats/usd/newton_child.py",),
    "mujoco": ("mujoco_library.py",),
    "PIL": (
        *("drawing/", "formats/mjcf/texture.py", "geometry/scene.py", "geometry/image_file.py"),
        *("formats/mjcf/verify_looks.py", "formats/common/asset_filter.py", "bundle/textures.py"),
        "viewer/findings_picture.py",
    ),
    "pybullet": ("simulation/engines/pybullet/",),
    "matplotlib": ("simulation/plot.py",),
    "viser": ("viewer/server.py",),
    "websockets": ("viewer/server.py",),
    "pygraphviz": ("graph/graphviz.py",),
    "pygls": ("server/protocol.py", "server/features.py"),
    "lsprotocol": ("server/protocol.py", "server/features.py"),
}


@cache
def imports(path):
    """Return what a module imports: packages of urdftool, and libraries."""
    return set(_list_imports(path))


def _list_imports(path):
    relative = path.relative_to(PACKAGE)
    tree = tree_of(path)
    for_annotations = {
        inner
        for node in walk(tree)
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        for inner in ast.walk(node)
    }
    for node in walk(tree):
        if node in for_annotations:
            continue
        if isinstance(node, ast.ImportFrom) and node.level:
            above = relative.parts[: len(relative.parts) - node.level]
            target = (*above, *(node.module or "").split(".")) if node.module else above
            names = [target[0]] if target and target[0] else [alias.name for alias in node.names]
            yield from (("own", name) for name in names)
        elif isinstance(node, ast.ImportFrom):
            yield "library", (node.module or "").split(".")[0]
        elif isinstance(node, ast.Import):
            yield from (("library", alias.name.split(".")[0]) for alias in node.names)


@for_each_module
def test_imports_go_down(path):
    relative = path.relative_to(PACKAGE)
    package = relative.parts[0].removesuffix(".py")
    if package in ("commands", "cli", "__init__", "__main__"):
        return
    allowed = {package, *BELOW[package]}
    used = {name for kind, name in imports(path) if kind == "own"} - {"__version__"}
    assert used <= allowed, f"{relative} imports {sorted(used - allowed)}"


@for_each_module
def test_each_library_has_its_place(path):
    relative = str(path.relative_to(PACKAGE))
    for kind, name in imports(path):
        if kind == "library" and name in PLACES:
            assert relative.startswith(PLACES[name]), f"{relative} imports {name}"


@for_each_module
def test_only_commands_print_and_exit(path):
    relative = path.relative_to(PACKAGE)
    if relative.parts[0] in ("commands", "cli.py", "console.py", "output.py"):
        return
    for node in walk(tree_of(path)):
        if isinstance(node, ast.Call):
            assert ast.unparse(node.func) not in ("print", "sys.exit", "exit", "click.echo"), (
                relative
            )


@for_each_module
def test_a_file_is_one_idea(path):
    assert path.stem not in ("utils", "util", "common", "helpers", "misc", "core")
    text = path.read_text("utf-8")
    assert len(text.splitlines()) <= 500 or "Written by ``python -m" in text


# What may be called in one place only.
CALLS = {
    "os.replace": ("storage.py",),
    "os.rename": ("storage.py", "leftovers.py"),
    "os.link": ("storage.py",),
    "os.fork": (
        *("limited.py", "source/expansion_process.py", "source/expansion_server_child.py"),
    ),
    "get_close_matches": ("suggestions.py",),
}


@for_each_module
def test_each_deed_has_its_place(path):
    relative = str(path.relative_to(PACKAGE))
    for node in walk(tree_of(path)):
        if isinstance(node, ast.Call):
            called = ast.unparse(node.func)
            assert relative in CALLS.get(called, (relative,)), f"{relative} calls {called}"


LIBRARY = "the only way to change what a library does"
KNOWN_PATCHES = {
    "completion.py: click.STRING.shell_complete": LIBRARY,
    "terminal.py: sys": "streams of this process: a terminal obeys nothing that a file holds",
    "terminal.py: sys.stdin": "a standard stream that is closed leads nowhere",
}
"""Attributes of other modules that are set, with the reason."""

MUTATORS = {
    *("append", "appendleft", "add", "update", "pop", "popitem", "clear", "setdefault", "extend"),
    *("insert", "remove", "discard", "move_to_end"),
}
PLAIN = {"int", "float", "str", "bool", "bytes", "Vector", "SymmetricTensor", "tuple[str, ...]"}
"""Types of arguments that a function may remember its results by."""


def module_names(tree):
    """Return the names that a module assigns, outside of its functions and classes."""
    targets = []
    for node in tree.body:
        if isinstance(node, ast.Assign):
            targets += node.targets
        elif isinstance(node, ast.AnnAssign) and node.value is not None:
            targets.append(node.target)
    return {target.id for target in targets if isinstance(target, ast.Name)}


def local_names(function):
    arguments = function.args
    names = {a.arg for a in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)}
    names |= {
        node.id
        for node in ast.walk(function)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    }
    return names - {
        name for node in ast.walk(function) if isinstance(node, ast.Global) for name in node.names
    }


def state(tree):
    """Yield the module-level names that functions change, and functions that remember objects."""
    names = module_names(tree)
    for function in walk(tree):
        if not isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        shared = names - local_names(function)
        for node in ast.walk(function):
            owner = getattr(node, "value", None)
            if isinstance(node, ast.Global):
                yield from node.names
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                owner = node.func.value
                if node.func.attr in MUTATORS and getattr(owner, "id", None) in shared:
                    yield owner.id
            elif isinstance(node, ast.Subscript | ast.Attribute) and not isinstance(
                node.ctx, ast.Load
            ):
                if getattr(owner, "id", None) in shared:
                    yield owner.id
        for decorator in function.decorator_list:
            words = ast.unparse(decorator).partition("(")[0].rpartition(".")[2]
            types = {ast.unparse(a.annotation) for a in function.args.args if a.annotation}
            if words == "Remembered" or (words in ("cache", "lru_cache") and types - PLAIN):
                yield function.name


@for_each_module
def test_no_module_keeps_state(path):
    assert not set(state(tree_of(path)))


def patches(tree):
    """Yield the attributes of imported modules that a module sets."""
    imported = {
        alias.asname or alias.name.partition(".")[0]
        for node in walk(tree)
        if isinstance(node, ast.Import)
        for alias in node.names
    }
    for node in walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            if ast.unparse(node).partition(".")[0] in imported:
                yield ast.unparse(node)
        elif isinstance(node, ast.Call) and ast.unparse(node.func) == "setattr":
            target = ast.unparse(node.args[0])
            if target.partition(".")[0] in imported:
                yield target


@for_each_module
def test_no_function_of_another_module_is_replaced(path):
    found = {f"{path.name}: {name}" for name in patches(tree_of(path))}
    assert not found - set(KNOWN_PATCHES)


OUTPUTS = "output of this or an earlier run"
CHECKED = "the path comes from `Description.resolve` or a checked companion"
TEMPORARY = "a temporary file of this run"
OWN = "data of the package"
NAMED = "a file that the user names"
MEMORY = "an image in memory"
OPENERS = {
    "bundle/check.py": "a bundle that the user names; links in it are defects",
    "bundle/from_other.py": TEMPORARY,
    "bundle/manifest.py": "content of the bundle",
    "bundle/mesh_formats.py": CHECKED,
    "git_changes.py": "files of a repository, to compare them with a commit",
    "bundle/origin.py": "license files and package.xml around files that are read",
    "bundle/output.py": OUTPUTS,
    "bundle/presets.py": CHECKED,
    "bundle/store.py": CHECKED,
    "cli.py": "standard streams",
    "collision/cache.py": CHECKED,
    "collision/cluster.py": CHECKED,
    "collision/mesh_files.py": OUTPUTS,
    "commands/inertia_write.py": OUTPUTS,
    "dependencies.py": "digests of what the workspace read",
    "formats/common/actuator_config.py": NAMED,
    "formats/mjcf/verify_runs.py": TEMPORARY,
    "formats/common/asset_filter.py": CHECKED,
    "formats/common/directory.py": OUTPUTS,
    "formats/mjcf/cache.py": CHECKED,
    "formats/mjcf/convert.py": CHECKED,
    "formats/mjcf/home_contacts.py": TEMPORARY,
    "formats/mjcf/texture.py": MEMORY,
    "formats/mjcf/verify_looks.py": CHECKED,
    "formats/mjcf/write.py": "lists SRDF files, which the workspace opens",
    "formats/usd/files.py": OUTPUTS,
    "compare/mesh_measure.py": CHECKED,
    "compare/names.py": NAMED,
    "formats/written.py": "content of the export",
    "geometry/collada_scene.py": CHECKED,
    "geometry/gltf_file.py": CHECKED,
    "geometry/obj.py": CHECKED,
    "geometry/ply.py": CHECKED,
    "geometry/points.py": CHECKED,
    "geometry/stl.py": CHECKED,
    "geometry/stl_header.py": CHECKED,
    "geometry/thin.py": CHECKED,
    "geometry/image_file.py": CHECKED,
    "inertia/mass_file.py": NAMED,
    "leftovers.py": "names beside an output",
    "parallel.py": "memory of this process",
    "source/expansion_child.py": "the null device",
    "resident_memory.py": "memory of this process",
    "lint/baseline.py": NAMED,
    "lint/installed_code.py": OWN,
    "fmt/discover.py": "lists the folder that the user names",
    "lint/discover.py": "lists the folder that the user names",
    "lint/effect_kinds.py": OWN,
    "model/sdf_schema.py": OWN,
    "output.py": OUTPUTS,
    "report/findings_html.py": OWN,
    "viewer/server.py": OWN,
    "report/rule_pages.py": OWN,
    "report/schemas.py": OWN,
    "rules/file_rewrites.py": "the workspace materializes the path",
    "rules/mesh/files.py": "the workspace materializes the path",
    "simulation/engines/mujoco/scene.py": TEMPORARY,
    "simulation/hull_cache.py": CHECKED,
    "standard_output.py": "the null device",
    "storage.py": OUTPUTS,
    "terminal.py": "standard streams",
    "workspace.py": "the one place that opens files for a description",
}
"""Modules that open, list or copy files without the workspace, with the reason."""

_OPENS = {"open", "io.open", "os.open", "os.scandir", "os.listdir", "os.walk", "glob.glob"}
_OF_PATHS = {"read_bytes", "read_text", "glob", "rglob", "iterdir", "open"}
_VIEWS = ("workspace", "files", "_workspace", "_get_workspace(robot)", "webbrowser")


def openings(tree):
    """Yield the calls that open, list or copy files, except by a workspace."""
    for node in walk(tree):
        if not isinstance(node, ast.Call):
            continue
        called = ast.unparse(node.func)
        holder, _, name = called.rpartition(".")
        if (
            called in _OPENS
            or called.startswith(("shutil.copy", "trimesh.load"))
            or (holder and name in _OF_PATHS and holder.rpartition(".")[2] not in _VIEWS)
        ):
            yield called


@for_each_module
def test_files_are_opened_through_the_workspace(path):
    name = path.relative_to(PACKAGE).as_posix()
    assert name in OPENERS or not list(openings(tree_of(path)))


def test_listed_openers_open():
    for name in OPENERS:
        assert list(openings(tree_of(PACKAGE / name))), name


@pytest.mark.parametrize(
    "code",
    [
        *("open(path)", "path.open()", "path.read_bytes()", "Path(a).read_text()", "os.listdir(a)"),
        *("shutil.copyfile(a, b)", "Image.open(path)", "trimesh.load(path)", "folder.rglob('*')"),
    ],
)
def test_openings_are_seen(code):
    assert list(openings(ast.parse(code)))
    assert not list(openings(ast.parse("self.workspace.open(a); files.read_bytes(b)")))


def dotted(path):
    parts = path.relative_to(PACKAGE).with_suffix("").parts
    return parts[:-1] if parts[-1] == "__init__" else parts


NAMES = {dotted(path): path for path in MODULES}


def own_imports(path):
    """Yield the modules of urdftool that a module imports, also for types and in functions.

    The version of the package, which its first module defines, is no part of a cycle.
    """
    package = dotted(path) if path.name == "__init__.py" else dotted(path)[:-1]
    for node in walk(tree_of(path)):
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        base = package[: len(package) - node.level + 1]
        base += tuple(node.module.split(".")) if node.module else ()
        for alias in node.names:
            target = NAMES.get((*base, alias.name)) or NAMES.get(base)
            if target not in (None, path) and alias.name != "__version__":
                yield target


def cycles(graph):
    """Return the sets of modules that reach each other."""
    reached = {}
    for start in graph:
        seen, waiting = set(), list(graph[start])
        while waiting:
            path = waiting.pop()
            if path not in seen:
                seen.add(path)
                waiting += graph[path]
        reached[start] = seen
    return {
        frozenset(other.stem for other in reached[path] if path in reached[other])
        for path in graph
        if path in reached[path]
    }


def test_imports_have_no_cycle():
    assert not cycles({path: set(own_imports(path)) for path in MODULES})


SAMPLE = """
import os
from functools import lru_cache
TABLE = {}
LAST = []
COUNT = 0

def read(robot: Robot):
    global COUNT
    TABLE[robot] = 1
    LAST.append(robot)
    os.stat = None

def fine(robot):
    LAST = []
    LAST.append(robot)
    return TABLE[robot]

@lru_cache(1)
def volume(robot: Robot): ...

@lru_cache(1)
def square(number: float): ...
"""


def test_the_laws_see_what_they_forbid():
    tree = ast.parse(SAMPLE)
    assert set(state(tree)) == {"COUNT", "TABLE", "LAST", "volume"}
    assert set(patches(tree)) == {"os.stat"}
    assert cycles({Path("a"): {Path("b")}, Path("b"): {Path("a")}, Path("c"): {Path("a")}}) == {
        frozenset("ab")
    }


TEXTS = frozenset(("message", "sentence", "hint", "note", "notes", "note_texts"))
"""Attributes and variables that hold text of urdftool for people."""

QUESTIONS = frozenset(
    (
        *("startswith", "endswith", "removeprefix", "removesuffix", "partition", "rpartition"),
        *("split", "find", "index", "count", "setdefault", "get"),
        *("search", "match", "fullmatch", "findall", "finditer", "sub"),
    )
)
"""Methods that a program decides with, on a text or with one as an argument."""

READ_TEXTS = {
    ("formats/mjcf/meshes.py", "_report_notes"): "reports equal records of a file once",
    ("lint/group.py", "_combine_fixes"): "chooses between two wordings of the combined fix",
    ("report/expansion.py", "format_warnings"): "removes line breaks",
    ("rules/xacro/expansion_warnings.py", "_match_warnings"): "warnings of the library xacro",
}
"""Functions that compare texts: for the page only, or texts of another library."""


def _is_text(node):
    if isinstance(node, ast.Tuple):
        return any(map(_is_text, node.elts))
    name = node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")
    return name in TEXTS


def _decides_by_text(node):
    """Tell whether an expression compares or searches a text, or uses it as a key."""
    if isinstance(node, ast.Compare):
        sides = (node.left, *node.comparators)
        nothing = all(isinstance(op, ast.Is | ast.IsNot) for op in node.ops)
        return not nothing and any(map(_is_text, sides))
    if isinstance(node, ast.Subscript):
        return _is_text(node.slice)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        of_text = _is_text(node.func.value) or any(map(_is_text, node.args[:1]))
        return node.func.attr in QUESTIONS and of_text
    return False


def _text_decisions(tree, function="module"):
    for child in ast.iter_child_nodes(tree):
        if isinstance(child, ast.FunctionDef):
            yield from _text_decisions(child, child.name)
            continue
        if _decides_by_text(child):
            yield function, child.lineno
        yield from _text_decisions(child, function)


@for_each_module
def test_no_code_decides_by_the_text_of_a_message(path):
    name = path.relative_to(PACKAGE).as_posix()
    found = [
        f"{name}:{line}: {function} compares a text; compare codes and data"
        for function, line in _text_decisions(tree_of(path))
        if (name, function) not in READ_TEXTS
    ]
    assert not found


@pytest.mark.parametrize(
    "code",
    [
        "if note.startswith('CoACD'): pass",
        "'millimetre' in piece.note",
        "one.message == other.message",
        "groups.setdefault((finding.code, finding.message), [])",
        "known[finding.message]",
        "pattern.search(error.message)",
    ],
)
def test_decisions_by_text_are_seen(code):
    assert list(_text_decisions(ast.parse(code)))


def test_listed_readers_of_texts_exist():
    for name, function in READ_TEXTS:
        assert function in [found for found, _ in _text_decisions(tree_of(PACKAGE / name))]


FORMS_WITH_CODE = frozenset(("pickle", "cPickle", "marshal", "shelve", "dill", "joblib"))
"""Libraries whose files may run code when they are read."""

BETWEEN_PROCESSES = ("isolated.py", "parallel.py", "cluster.py", "cluster_child.py")
"""Modules that pickle what another process of urdftool reads from a pipe."""


def forms_with_code(tree):
    """Yield the uses of forms that may run code: imports, and arrays in files of numpy."""
    for node in walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            names = [getattr(node, "module", None) or "", *(alias.name for alias in node.names)]
            yield from FORMS_WITH_CODE.intersection(name.partition(".")[0] for name in names)
        elif isinstance(node, ast.Call):
            called = ast.unparse(node.func)
            words = {word.value for word in node.args if isinstance(word, ast.Constant)}
            if called in ("np.load", "numpy.load") or (
                called.endswith("import_module") and words & FORMS_WITH_CODE
            ):
                yield called


@for_each_module
def test_no_file_is_read_in_a_form_that_runs_code(path):
    if path.relative_to(PACKAGE).as_posix() not in BETWEEN_PROCESSES:
        assert not list(forms_with_code(tree_of(path)))


def test_forms_that_run_code_are_seen():
    code = "import pickle\nfrom marshal import loads\nnp.load(f)\nimport_module('shelve')"
    assert sorted(forms_with_code(ast.parse(code))) == [
        *("import_module", "marshal", "np.load", "pickle"),
    ]


BLOCKS = re.compile(r"robot\.(gazebo|extensions)\b")

MOST_THAT_OPEN_BLOCKS = 12
"""Modules of ``model/`` and ``rules/gazebo/`` that open blocks; the number only becomes smaller."""

OPEN_BLOCKS: set[str] = set()
"""Modules that open ``<gazebo>`` blocks themselves; what a block means belongs into the model.

The list only becomes shorter: friction, contact, springs, flags and names of materials are read by
``model/settings.py``.
"""


def test_blocks_are_opened_by_the_model_and_its_rules():
    found = {
        path.relative_to(PACKAGE).as_posix()
        for path in MODULES
        if BLOCKS.search(path.read_text("utf-8"))
    }
    allowed = {name for name in found if name.startswith(("model/", "rules/gazebo/"))}
    assert found - allowed == OPEN_BLOCKS
    assert len(allowed) <= MOST_THAT_OPEN_BLOCKS, sorted(allowed)


def elements_used(path):
    """Yield the rules for several formats that use ``element``, also in functions they call."""
    functions = {f.name: f for f in tree_of(path).body if isinstance(f, ast.FunctionDef)}
    for name, function in functions.items():
        if not any("formats=" in ast.unparse(mark) for mark in function.decorator_list):
            continue
        reached, following = set(), [name]
        while following:
            reached.add(one := following.pop())
            inside = list(ast.walk(functions[one]))
            if any(isinstance(node, ast.Attribute) and node.attr == "element" for node in inside):
                yield name
            called = {node.id for node in inside if isinstance(node, ast.Name)}
            following += (called & functions.keys()) - reached


ELEMENT_OF_URDF = {
    "incomplete_inertial": "its other branch is that of SDF",
    "invalid_sdf_value": "<gazebo> is an element of URDF",
}
"""Rules for several formats that use ``element``, with the reason."""


def test_rules_for_several_formats_use_no_element_of_urdf():
    using = {rule for path in MODULES for rule in elements_used(path)}
    assert using == set(ELEMENT_OF_URDF)
