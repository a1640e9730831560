"""A light core: what is installed without an extra, and what is said where a library is missing."""

import ast
import re
import subprocess
import sys

import pytest
import yaml

from tests.conftest import FIXTURES, ROOT
from urdftool import __version__, extras
from urdftool.commands.version import CORE

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
OPTIONAL = PROJECT["optional-dependencies"]
ARM = str(FIXTURES / "robots" / "demo_arm" / "urdf" / "arm_sound.urdf.xacro")
DAE = str(FIXTURES / "rules" / "dae-as-collision" / "bad.urdf")
FORK = str(FIXTURES / "rules" / "nonconvex-collision-mesh" / "bad.urdf")
CUBE = str(FIXTURES / "meshes" / "cube.stl")

HIDE = """
import sys
from importlib.machinery import PathFinder

class Hiding:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name.partition(".")[0] in {hidden!r}:
            return None
        return PathFinder.find_spec(name, path, target)

sys.meta_path[sys.meta_path.index(PathFinder)] = Hiding
from urdftool import cli
cli.run(sys.argv[1:])
"""


def without(hidden, *words, cwd):
    """Run a command as if some libraries were not installed."""
    code = HIDE.format(hidden=tuple(hidden))
    return subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, cwd=cwd
    )


def distribution(requirement):
    return re.match(r"[\w-]+", requirement)[0].lower()


def installed_by(extra):
    """The distributions of an extra, those of the extras that it names included."""
    found = set()
    for requirement in OPTIONAL[extra]:
        inner = re.fullmatch(r"urdftool\[(.*)\]", requirement)
        if inner:
            found = found.union(*(installed_by(name) for name in inner[1].split(",")))
        else:
            found.add(distribution(requirement))
    return found


def test_each_optional_library_is_in_its_extra():
    for library, extra in extras.EXTRA_OF.items():
        name = extras.DISTRIBUTION_OF.get(library, library).lower()
        assert name in installed_by(extra), library
        left_out = extra in ("dask", "usd-verify", "robots") or library == "pybullet"
        assert left_out or name in installed_by("all"), library


def test_the_core_is_what_is_imported_without_an_extra():
    core = {distribution(requirement) for requirement in PROJECT["dependencies"]}
    assert core == {name.lower() for name in CORE} | {"tomli"}
    imports = {"pyyaml": "yaml"}
    known = {imports.get(name, name) for name in core} | set(extras.EXTRA_OF)
    known |= {"rich", "websockets"}  # come with viser
    for path in (ROOT / "urdftool").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and not node.level:
                names = [node.module]
            for name in names:
                top = name.partition(".")[0]
                assert top in known or top in sys.stdlib_module_names, f"{path}: {name}"


def test_the_recipe_of_conda_requires_what_the_core_does():
    recipe = yaml.safe_load((ROOT / "packaging/conda/recipe.yaml").read_text("utf-8"))
    context = recipe["context"]
    assert context["version"] == __version__
    assert PROJECT["requires-python"] == ">=" + context["python_min"]
    needed = {one.split(";")[0].replace(" ", "") for one in PROJECT["dependencies"]}
    python, *others = recipe["requirements"]["run"]
    assert python == "python >=${{ python_min }}"
    assert {one.replace(" ", "") for one in others} == needed
    (program,) = recipe["build"]["python"]["entry_points"]
    assert program == f"urdftool = {PROJECT['scripts']['urdftool']}"


def test_every_extra_that_is_named_exists():
    sources = [*ROOT.glob("*.md"), *ROOT.glob("*.yml"), ROOT / "noxfile.py", ROOT / "Makefile"]
    for folder, suffix in (("urdftool", "py"), ("docs", "md"), ("tests", "py"), ("docs", "py")):
        sources += (ROOT / folder).rglob(f"*.{suffix}")
    for path in sources:
        if path == ROOT / "CHANGELOG.md":
            continue
        for named in re.findall(r"(?:urdftool|\.)\[([a-z][\w,-]*)\]'", path.read_text("utf-8")):
            for extra in named.split(","):
                assert extra in OPTIONAL, f"{path} names the extra '{extra}'"


def test_every_version_of_python_has_a_classifier():
    lowest = int(PROJECT["requires-python"].partition("3.")[2])
    named = [c for c in PROJECT["classifiers"] if re.search(r":: 3\.\d+$", c)]
    assert int(named[0].rpartition(".")[2]) == lowest


@pytest.mark.parametrize(
    ("words", "library", "extra"),
    [
        (("collision", ARM, "-o", "OUT.urdf"), "scipy", "mesh"),
        (("collision", "mesh", CUBE, "-o", "OUT.stl"), "scipy", "mesh"),
        (("inertia", "mesh", CUBE, "--mass", "1"), "scipy", "mesh"),
        (("graph", ARM, "-o", "OUT.svg"), "pygraphviz", "draw"),
        (("view", ARM, "--contact-sheet", "OUT.png"), "Pillow", "draw"),
        (("view", ARM, "--picture", "OUT.png"), "Pillow", "draw"),
        (("view", ARM), "viser", "view"),
        (("simulate", ARM), "engine", "simulate"),
        (("simulate", ARM, "--engine", "mujoco"), "mujoco", "mujoco"),
        (("simulate", ARM, "--engine", "mujoco", "--plot", "a.png"), "Matplotlib", "draw"),
        (("export", "mjcf", ARM, "-o", "OUT", "--verify"), "mujoco", "mujoco"),
    ],
    ids=lambda value: "_".join(value[:2]).rpartition("/")[0] if isinstance(value, tuple) else value,
)
def test_a_missing_library_is_one_message(tmp_path, words, library, extra):
    done = without(extras.EXTRA_OF, *words, cwd=tmp_path)
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert library in line
    if extra == "simulate" and sys.platform != "linux":
        return  # there the advice names MuJoCo
    assert line.endswith(f"pip install 'urdftool[{extra}]'")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "words",
    [
        ("expand", ARM),
        ("info", DAE),
        ("graph", ARM, "-o", "-"),
        ("graph", ARM, "-o", "OUT.mmd"),
        ("graph", ARM, "-o", "OUT.gv"),
        ("diff", ARM, ARM),
        ("inertia", "robot", ARM),
        ("inertia", "box", "--mass", "1", "--size", "1", "1", "1"),
        ("lint", ARM, "--exit-zero"),
        ("export", "sdf", DAE, "-o", "OUT"),
        ("export", "mjcf", DAE, "-o", "OUT"),
        ("export", "mjcf", ARM, "-o", "OUT"),
        ("--version", "-v"),
    ],
    ids=lambda words: "_".join(words[:2]).rpartition("/")[0],
)
def test_what_needs_no_extra_is_done_without(tmp_path, words):
    done = without(extras.EXTRA_OF, *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr


def test_a_graph_without_graphviz_is_its_text(tmp_path):
    done = without(["pygraphviz"], "graph", ARM, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout == "Created file demo_arm.gv\n"
    assert "demo_arm.pdf requires pygraphviz" in done.stderr


def test_lint_names_the_rules_it_skipped(tmp_path):
    words = ("lint", FORK, "--select", "nonconvex-collision-mesh")
    done = without(extras.EXTRA_OF, *words, cwd=tmp_path)
    assert (
        "not checked: rule nonconvex-collision-mesh requires manifold3d, which is not installed: "
        "pip install 'urdftool[mesh]'"
    ) in done.stderr.splitlines()
    if extras.is_installed("manifold3d"):
        assert "nonconvex-collision-mesh" in without([], *words, cwd=tmp_path).stdout


def test_a_collada_mesh_is_converted_without_an_extra(tmp_path):
    words = ("lint", DAE, "--fix", "--unsafe-fixes", "--fix-meshes", "--diff")
    words += ("--select", "dae-as-collision")
    done = without(extras.EXTRA_OF, *words, cwd=tmp_path)
    assert ".stl" in done.stdout
    assert "requires" not in done.stderr


def test_the_report_of_an_engine_that_has_no_wheel_here(monkeypatch):
    from urdftool.errors import MissingDependency
    from urdftool.simulation.engines import registry as engines

    def here(system, machine, python, installed=()):
        monkeypatch.setattr(engines.sys, "platform", system)
        monkeypatch.setattr(engines.platform, "machine", lambda: machine)
        monkeypatch.setattr(engines.sys, "version_info", (*python, 0))
        monkeypatch.setattr(engines, "is_installed", lambda name: name in installed)

    def message(call):
        with pytest.raises(MissingDependency) as found:
            call()
        return str(found.value)

    here("linux", "x86_64", (3, 11))
    assert message(engines.choose_default_engine).endswith("pip install 'urdftool[simulate]'")
    here("linux", "x86_64", (3, 13))
    said = message(lambda: engines.check_engines(("pybullet",)))
    assert "not for Python 3.13" in said
    assert said.endswith("use --engine mujoco, after pip install 'urdftool[simulate]'")
    here("darwin", "arm64", (3, 11), installed=("mujoco",))
    assert engines.choose_default_engine() == "mujoco"
    assert message(lambda: engines.check_engines(("pybullet", "mujoco"))).endswith(
        "use --engine mujoco"
    )
    here("linux", "armv7l", (3, 12))
    assert "neither PyBullet nor MuJoCo has a wheel for" in message(engines.choose_default_engine)
