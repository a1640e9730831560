"""Hostile files, and the commands that read them: the runs of ``tests.hostile.run``."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from itertools import chain
from typing import Any, NamedTuple

from tests.conftest import FIXTURES
from tests.hostile import description_files as given
from tests.hostile import mesh_files
from tests.hostile.place import Place

Words = tuple[str | bytes, ...]


class Case(NamedTuple):
    """A hostile file, which is written into a place, and the commands that read it.

    Attributes:
        category: Kind of the file.
        name: What is hostile about it.
        write: Writes it into the project; gives the name of the file that a command reads.
        commands: Command lines, in which ``IN`` is the file and ``OUT`` a folder.
        runs: How many of the commands are run on it, one after another in turn.
    """

    category: str
    name: str
    write: Callable[[Place], str | bytes]
    commands: tuple[str, ...]
    runs: int = 1


LIGHT = (
    *("lint IN --no-cache", "info IN", "graph IN -o -", "inertia robot IN"),
    *("lint IN --no-cache --format json", "diff IN good.urdf", "verify IN good.urdf"),
)
EXPORTS = (
    *("export sdf IN -o OUT/s --force", "export mjcf IN -o OUT/m --force"),
    *("bundle IN -o OUT/b --force", "export usd IN -o OUT/u.usda --force"),
    *("bundle IN -o OUT/b.zip --force", "bundle IN -o OUT/b --for mujoco --force"),
)
HEAVY = (
    *("view IN --picture OUT/a.png --size 64x48", "simulate IN --duration 0.1"),
    *("collision IN --check -j 1 --no-cache", "collision IN -o OUT/c.urdf --method hull -j 1"),
)
ROBOT = tuple(chain(*zip(LIGHT, EXPORTS, strict=False), HEAVY))
LARGE = (
    *("links at one place", "links in a tree", "links in a star", "links that overlap"),
    *("links in a chain", "links that turn in a chain"),
)
"""Robots of 2,000 to 10,000 links, of which each takes its time to be drawn or simulated."""
XML = (*LIGHT, "expand IN", *EXPORTS[:2])
WITH_MESH = (
    *("export mjcf IN -o OUT/m --force", "lint IN --no-cache", "bundle IN -o OUT/b --force"),
    *("inertia robot IN", "view IN --picture OUT/a.png --size 64x48", "info IN"),
    *("export usd IN -o OUT/u.usda --force", "bundle IN -o OUT/b --max-triangles 9 --force"),
    *("inertia mesh MESH --mass 1", "export sdf IN -o OUT/s --force", "view MESH --picture OUT/p"),
    *("collision mesh MESH --no-cache --method hull", "collision IN --check -j 1 --no-cache"),
    *("bundle IN -o OUT/b --meshes glb --force", "simulate IN --duration 0.1"),
)
WITH_IMAGE = (
    *("view IN --picture OUT/a.png --size 64x48", "export mjcf IN -o OUT/m --force"),
    *("bundle IN -o OUT/b --force", "export usd IN -o OUT/u.usda", "export sdf IN -o OUT/s"),
    *("bundle IN -o OUT/b --max-texture 16 --force", "lint IN --no-cache"),
)
READ = (
    *("lint IN --no-cache", "export urdf IN -o OUT/r.urdf --force", "info IN", "graph IN -o -"),
    *("verify IN good.urdf", "view IN --picture OUT/a.png --size 64x48", "bundle IN -o OUT/b"),
    *("simulate IN --duration 0.1", "export mjcf IN -o OUT/m --force", "lint . -j 1 --no-cache"),
)
ARCHIVE = ("bundle IN --check",)
NAMED = (
    *("lint IN --no-cache", "expand IN", "info IN", "graph IN -o -", "graph IN -o OUT/a.svg"),
    *("diff IN good.urdf", "verify IN good.urdf", "inertia robot IN", "export sdf IN -o OUT/s"),
    *("export mjcf IN -o OUT/m", "bundle IN -o OUT/b", "bundle IN --check", "export urdf IN"),
    *("collision IN --check -j 1 --no-cache", "view IN --picture OUT/a.png --size 64x48"),
    *("simulate IN --duration 0.1", "inertia mesh IN --mass 1", "export usd IN -o OUT/u.usda"),
    *("collision mesh IN --no-cache --method hull", "lint IN --fix", "lint IN --format html"),
)

GOOD = given.robot(given.SOLID_LINK.format("a"))
XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'


def write_files(place: Place, files: Mapping[str, bytes | str]) -> str:
    """Write files into the project; gives the name of the first."""
    for name, data in files.items():
        path = place.project / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(data, str):
            text = place.fill(data.replace("@BESIDEDIR@", str(place.beside)))
            path.write_bytes(text.encode("utf-8", "surrogatepass"))
        else:
            path.write_bytes(data)
    return next(iter(files))


def prepare(place: Place) -> None:
    """Clear a project and put into it what is there in each run: links, a pipe, a good robot."""
    place.clear()
    project = place.project
    (project / "good.urdf").write_text(GOOD)
    if os.name == "posix":
        os.mkfifo(project / "fifo.stl")
    links = {
        "zero.stl": "/dev/zero",
        "loop.stl": "loop.stl",
        "link.stl": "../beside/secret.stl",
        "cookies.stl": "../beside/cookies.sqlite",
        "link.png": "../beside/secret.png",
        "linked_obj.obj": "../beside/secret.obj",
        "linked_gltf.gltf": "../beside/secret.json",
        "linked.dae": "../beside/secret.xml",
        "linked": "../beside",
    }
    for name, target in links.items():
        (project / name).symlink_to(target)
    (project / "folder.stl").mkdir()


def of_files(
    category: str,
    cases: Mapping[str, Mapping[str, bytes | str]],
    commands: tuple[str, ...],
    runs: int,
) -> Iterator[Case]:
    """Yield cases of files that commands are given."""
    for name, files in cases.items():
        yield Case(category, name, lambda p, f=files: write_files(p, f), commands, runs)  # type: ignore[misc]


def of_meshes() -> Iterator[Case]:
    """Yield robots with a hostile mesh."""
    for name, files in mesh_files.MESHES.items():
        mesh = next(iter(files))
        commands = tuple(command.replace("MESH", mesh) for command in WITH_MESH)
        named = {"r.urdf": given.mesh(mesh), **files}
        yield Case("mesh", name, lambda p, f=named: write_files(p, f), commands, 2)  # type: ignore[misc]


def of_images() -> Iterator[Case]:
    """Yield robots with a hostile image, named by themselves or by a mesh."""
    for name, make in mesh_files.IMAGES.items():

        def of_robot(place: Place, name: str = name, make: Any = make) -> str:
            return write_files(place, {"r.urdf": given.mesh("", name), name: make()})

        def of_mesh(place: Place, name: str = name, make: Any = make) -> str:
            material = mesh_files.with_material(f"newmtl m\nmap_Kd {name}\n")
            return write_files(place, {"r.urdf": given.mesh("a.obj"), **material, name: make()})

        yield Case("image", name, of_robot, WITH_IMAGE, 2)
        yield Case("image", f"{name} of a mesh", of_mesh, WITH_IMAGE)


def of_archives() -> Iterator[Case]:
    """Yield hostile bundles."""
    for name, make in given.ZIP.items():
        yield Case("zip", name, lambda p, n=name, m=make: write_files(p, {n: m()}), ARCHIVE)  # type: ignore[misc]


def of_yaml() -> Iterator[Case]:
    """Yield hostile YAML that xacro loads, and that has the controllers."""
    xacro = XACRO.format("<link name=\"${xacro.load_yaml('a.yaml')}\"/>")
    controllers = ("simulate IN --duration 0.1 --controllers a.yaml", "lint . -j 1 --no-cache")
    for name, text in given.YAML.items():
        files = {"r.xacro": xacro, "a.yaml": text}
        commands = ("expand IN", "lint IN --no-cache", "info IN", "export sdf IN -o OUT/s")
        yield Case("YAML of xacro", name, lambda p, f=files: write_files(p, f), commands, 1)  # type: ignore[misc]
        files = {"r.urdf": GOOD, "a.yaml": text, "config/ros2_controllers.yaml": text}
        yield Case("YAML", name, lambda p, f=files: write_files(p, f), controllers, 1)  # type: ignore[misc]


def of_surroundings() -> Iterator[Case]:
    """Yield files around a robot: its configuration and its package."""
    find = XACRO.format("<link name=\"${xacro.load_yaml('$(find beside)/secret.yaml')}\"/>")
    commands = ("lint IN --no-cache", "expand IN", "info IN", "lint . -j 1", "bundle IN -o OUT/b")
    for name, text in given.TOML.items():
        files = {"r.xacro": find, "urdftool.toml": text}
        yield Case("urdftool.toml", name, lambda p, f=files: write_files(p, f), commands)  # type: ignore[misc]
    for name, text in given.PACKAGE_XML.items():
        files = {"r.xacro": find, "package.xml": text}
        yield Case("package.xml", name, lambda p, f=files: write_files(p, f), commands)  # type: ignore[misc]
    srdf = ("bundle good.urdf --srdf IN -o OUT/b", "lint . -j 1 --no-cache", "lint IN --no-cache")
    yield from of_files("SRDF", given.SRDF, srdf, 1)
    for name in ("urdftool.toml", "package.xml", "a.yaml", "r.mtl", "CMakeLists.txt", "r.srdf"):
        for kind in ("pipe", "device", "folder", "loop", "link out"):

            def special(place: Place, name: str = name, kind: str = kind) -> str:
                load = "<link name=\"${xacro.load_yaml('a.yaml')}\"/>"
                mesh = given.mesh("a.obj")
                obj = "mtllib r.mtl\n" + mesh_files.TRIANGLE + mesh_files.SOLID
                main = {"a.yaml": ("r.xacro", XACRO.format(load)), "r.mtl": ("r.urdf", mesh)}
                main_name, text = main.get(name, ("r.xacro", find))
                write_files(place, {main_name: text, "a.obj": obj})
                make_special(place.project / name, kind)
                return main_name

            yield Case(f"special {name}", kind, special, commands, 2)


def make_special(path: Any, kind: str) -> None:
    """Put something at a path that is not a regular file."""
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    else:
        targets = {"device": "/dev/zero", "loop": path.name, "link out": "../beside/secret.xml"}
        path.symlink_to(targets[kind])


INPUTS = {
    "device": "/dev/zero",
    "random device": "/dev/urandom",
    "no device": "/dev/null",
    "standard input": "/dev/stdin",
    "memory": "/proc/self/mem",
    "environment": "/proc/self/environ",
    "pipe": "fifo.stl",
    "link to a device": "zero.stl",
    "link to itself": "loop.stl",
    "folder": "folder.stl",
    "nothing": "absent.urdf",
    "long path": "a" * 5000,
    "many folders": "a/" * 3000 + "b",
}


def of_inputs() -> Iterator[Case]:
    """Yield paths given to commands that are not regular files; links with a usual suffix."""
    for name, path in INPUTS.items():
        yield Case("input", name, lambda place, path=path: path, NAMED, 4)  # type: ignore[misc]
    for suffix in ("urdf", "xacro", "sdf", "xml", "usda", "stl", "obj", "zip"):
        for kind in ("pipe", "device", "folder"):

            def special(place: Place, suffix: str = suffix, kind: str = kind) -> str:
                make_special(place.project / f"special.{suffix}", kind)
                return f"special.{suffix}"

            commands = (*NAMED, "lint . -j 1 --no-cache", "collision . --check -j 1")
            yield Case(f"special .{suffix}", kind, special, commands, 2)


NAMES: dict[str, bytes] = {
    "escape": b"a\x1b]0;x\x07.urdf",
    "control characters": b"a\x01\x08\x7f.urdf",
    "line end": b"a\nb.urdf",
    "carriage return": b"a\rb.urdf",
    "not UTF-8": b"bad\xff\xfename.urdf",
    "surrogate": b"a\xed\xa0\x80b.urdf",
    "direction": "a\u202eb.urdf".encode(),
    "C1 control": "a\x9b31mb.urdf".encode(),
    "option": b"-rf.urdf",
    "long": b"a" * 250 + b".urdf",
    "blank": b" .urdf",
    "quotes": b"a\"'`<>&.urdf",
    "command": b"$(touch mark);`touch mark`|touch mark.urdf",
    "format": b"%s%n{0.__class__}.urdf",
    "markup": b"[bold red]a[link=x].urdf",
    "dots": b"....urdf",
    "no suffix": b"a",
    "two suffixes": b"a.urdf.xacro",
    "backslash": b"a\\..\\b.urdf",
    "colon": b"HEAD:a.urdf",
    "argument": b"a:=b.urdf",
    "star": b"*[a-z]?.urdf",
}


def of_names() -> Iterator[Case]:
    """Yield robots whose file, mesh or texture has an odd name."""
    for name, file in NAMES.items():

        def write(place: Place, file: bytes = file) -> bytes:
            path = os.fsencode(place.project) + b"/" + file
            with open(path, "w") as stream:
                stream.write(GOOD)
            return b"./" + file if file.startswith(b"-") else file

        yield Case("name", name, write, NAMED, 3)

        def with_mesh(place: Place, file: bytes = file) -> str:
            source = FIXTURES / "meshes" / "cube.stl"
            target = file.replace(b".urdf", b".stl").replace(b"/", b"_")
            shutil.copyfile(source, os.fsencode(place.project) + b"/" + target)
            from xml.sax.saxutils import escape

            text = target.decode("utf-8", "replace")
            shown = "".join(c if c >= " " else "_" for c in escape(text, {'"': "&quot;"}))
            return write_files(place, {"r.urdf": given.mesh(shown)})

        yield Case("name of a mesh", name, with_mesh, (*EXPORTS, *LIGHT), 2)


def of_bundles() -> Iterator[Case]:
    """Yield the bodies of ``escape_bodies`` in other commands than ``expand``."""
    from tests.hostile import escape_bodies

    commands = ("lint IN --no-cache", "info IN", "bundle IN -o OUT/b", "export sdf IN -o OUT/s")
    for group, bodies in escape_bodies.GROUPS.items():
        for name, body in bodies.items():
            if not body.arguments:
                files = {"r.xacro": XACRO.format(body.text), **body.files}
                yield Case(f"xacro {group}", name, lambda p, f=files: write_files(p, f), commands)  # type: ignore[misc]


@lru_cache(maxsize=1)
def list_cases() -> list[Case]:
    """Return all cases."""
    large = {name: given.URDF[name] for name in LARGE}
    some = {name: files for name, files in given.URDF.items() if name not in LARGE}
    return [
        *of_files("URDF", some, ROBOT, 3),
        *of_files("URDF", large, LIGHT + EXPORTS, 3),
        *of_files("reach", given.REACH, WITH_IMAGE + EXPORTS, 2),
        *of_files("SDF", given.SDF, READ, 2),
        *of_files("MJCF", given.MJCF, READ, 2),
        *of_files("USD", given.USD, READ, 2),
        *of_meshes(),
        *of_images(),
        *of_archives(),
        *of_yaml(),
        *of_surroundings(),
        *of_inputs(),
        *of_names(),
        *of_bundles(),
    ]


class Run(NamedTuple):
    """A command on a hostile file."""

    case: Case
    command: str

    def words(self, place: Place, file: str | bytes) -> Words:
        """Return its command line."""
        out = str(place.out)
        return tuple(
            file if word == "IN" else word.replace("OUT", out) for word in self.command.split()
        )


def list_runs(*, every: bool = False) -> list[Run]:
    """Return the runs: the commands of each case in turn, or every command on every file."""
    found = []
    turn: dict[str, int] = {}
    for case in list_cases():
        count = len(case.commands) if every else case.runs
        start = turn.get(case.category, 0)
        turn[case.category] = start + count
        for number in range(start, start + count):
            found.append(Run(case, case.commands[number % len(case.commands)]))
    return found


def execute(run: Run, place: Place, start: Any) -> tuple[Any, list[str]]:
    """Make a run in a place.

    Args:
        run: The run.
        place: Where.
        start: Runs a command line there, as ``Zygote.run``.

    Returns:
        What came of it, and what is wrong with that.
    """
    prepare(place)
    file = run.case.write(place)
    outcome = start(run.words(place, file), place)
    problems = place.find_problems(outcome)
    strays = [
        path
        for path in (place.beside, place.home)
        for path in path.iterdir()
        if path not in place.secrets()
        and path.name not in ("work", "Documents", ".ssh", "written")
        and not path.name.startswith(("secret.", "cookies."))
    ]
    problems += [f"it wrote {path.name} outside of its outputs" for path in strays]
    for path in strays:
        shutil.rmtree(path, ignore_errors=True)
        path.unlink(missing_ok=True)
    return outcome, problems
