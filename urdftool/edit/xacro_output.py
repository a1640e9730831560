"""The result of ``attach`` and ``prefix`` as a xacro file that includes the sources."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator, Sequence
from itertools import product
from pathlib import Path

from ..compare.compare import compare_robots
from ..compare.rows import ROWS, narrow_tolerances
from ..diagnostic import Severity
from ..errors import AccessError, ModelError, PackageNotFound, SourceError
from ..finding import Finding
from ..model.elements import Robot
from ..model.load import make_robot
from ..model.world import WORLD
from ..source.description import read_description
from ..source.document import STDIN, Element
from ..source.location import SourceFile
from ..source.packages import Packages
from .attach import Mount, format_joint
from .finish import TOLERANCE, Edited, prove_again
from .inclusion import Inclusion, Wish, insert_values, list_clashes, list_inclusions, quote
from .numbers import format_vector
from .prefix import list_fixing_names
from .references import list_others

Make = Callable[[str, frozenset[str]], Edited]
"""Function that makes the URDF of the same operation.

Its arguments are the name of the joint between two robots, and names that get no prefix.
"""


def attach_in_xacro(
    robots: tuple[Robot, Robot], mount: Mount, prefix: str, make: Make, output: str | Path
) -> Edited:
    """Return the xacro file that includes two descriptions, or calls the macros of the second.

    Raises:
        ModelError: No way to write it gives the robot of the URDF.
    """
    _check_sources(robots, output)
    twin = make(mount.joint, frozenset())
    first = next(words[2] for words in twin.proofs[1].lines if words[0] == "branch")
    dropped = any(note.rule == "edit-world" for note in twin.notes)
    xyz, rpy = format_vector(mount.xyz), format_vector(mount.rpy)
    wish = Wish(prefix, mount.to if dropped else "", f'xyz="{xyz}" rpy="{rpy}"')

    def list_ways() -> Iterator[list[Inclusion]]:
        ways = (
            list_inclusions(robots[0], Wish(), _make_refer(robots[0], output)),
            list_inclusions(robots[1], wish, _make_refer(robots[1], output)),
        )
        for arm, part in product(*map(list, ways)):
            insert_values(part, arm.arguments)
            joint = (
                []
                if dropped
                else format_joint(mount, mount.joint or f"{mount.to}_to_{first}", first)
            )
            yield [arm, Inclusion(**{**vars(part), "lines": [*part.lines, *joint]})]

    def remake(result: Robot) -> Edited:
        joint = None if mount.joint else result.tree.get_parent_joint(first)
        name = mount.joint if joint is None or joint.name in robots[0].joint else joint.name
        return make(name, _list_kept(robots[1], result) - {WORLD})

    return _choose(twin, list_ways(), remake, robots, output)


def prefix_in_xacro(robot: Robot, prefix: str, make: Make, output: str | Path) -> Edited:
    """Return the xacro file that includes a description, or calls its macros, with a prefix.

    A link ``world`` keeps its name if the description gives it none.

    Raises:
        ModelError: No way to write it gives the robot of the URDF.
    """
    _check_sources((robot,), output)
    twin = make("", list_fixing_names(robot))
    ways = list_inclusions(robot, Wish(prefix), _make_refer(robot, output))

    def remake(result: Robot) -> Edited:
        return make("", _list_kept(robot, result))

    return _choose(twin, ([way] for way in ways), remake, (robot,), output)


def _list_kept(source: Robot, result: Robot) -> frozenset[str]:
    """Return the world and the hardware components of a source that get no prefix in xacro."""
    before = {_get_name(element) for element in list_others(source.element)}
    after = {_get_name(element) for element in list_others(result.element)}
    worlds = {WORLD} & source.link.keys() & result.link.keys()
    return frozenset((before & after) | worlds)


def _check_sources(robots: Sequence[Robot], output: str | Path) -> None:
    """Check that the sources are files whose relative paths keep their meaning.

    Raises:
        ModelError: They are not.
    """
    folder = Path(os.path.abspath(output)).parent
    for robot in robots:
        path = "-" if robot.source is None else robot.source.path
        if path in ("-", STDIN):
            raise ModelError("standard input cannot be included; write a URDF", path=STDIN)
        if Path(os.path.abspath(path)).parent.resolve() == folder.resolve():
            continue
        for element in robot.element.walk():
            uri = element.get("filename") or ""
            if element.tag in ("mesh", "texture") and uri and not _is_absolute(uri):
                raise ModelError(
                    f"path '{uri}' would refer to the folder of {output}; write that file next to "
                    "this one, or write package:// paths",
                    at=element.place,
                )


def _is_absolute(uri: str) -> bool:
    return "://" in uri or uri.startswith("/")


def _make_refer(robot: Robot, output: str | Path) -> Callable[[Path], str]:
    """Return how an included file is named: relative in its package, else by ``$(find …)``."""
    assert robot.source is not None
    packages = robot.source.packages
    target = Path(os.path.abspath(output))

    def refer(path: Path) -> str:
        path = Path(os.path.abspath(path))
        owner, own = packages.find_owner(path), packages.find_owner(target)
        if owner is None or owner == own:
            return Path(os.path.relpath(path, target.parent)).as_posix()
        return f"$(find {owner[0]})/{path.relative_to(owner[1]).as_posix()}"

    return refer


def _choose(
    twin: Edited,
    ways: Iterator[list[Inclusion]],
    remake: Callable[[Robot], Edited],
    robots: Sequence[Robot],
    output: str | Path,
) -> Edited:
    """Return the first file whose expansion is equal to the URDF of the operation."""
    failures: list[str] = []
    for inclusions in ways:
        how = ", ".join(inclusion.what for inclusion in inclusions)
        arguments = [inclusion.arguments for inclusion in inclusions]
        if clashes := list_clashes(arguments[0], arguments[-1]):
            values = " and ".join(f"'{known[clashes[0]]}'" for known in arguments)
            failures.append(f"{how}: both declare xacro argument '{clashes[0]}': {values}")
            continue
        data = _write(twin.robot.name, inclusions)
        try:
            result = _expand(data, robots, output)
            expected = remake(result)
        except (PackageNotFound, AccessError):
            raise
        except (SourceError, ModelError) as error:
            failures.append(f"{how}: {error}")
            continue
        if reason := _find_difference(expected.robot, result):
            failures.append(f"{how}: {reason}")
            continue
        return _replace(expected, data, result, _list_kept(robots[-1], result))
    raise _explain(failures, robots, output)


def _write(name: str, inclusions: Sequence[Inclusion]) -> bytes:
    spaces = {key: v for inclusion in inclusions for key, v in inclusion.namespaces.items()}
    head = "".join(f' {key}="{quote(value)}"' for key, value in spaces.items())
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<robot name="{quote(name)}" xmlns:xacro="http://www.ros.org/wiki/xacro"{head}>',
    ]
    for inclusion in inclusions:
        lines += [
            f'  <xacro:arg name="{quote(key)}" default="{quote(value)}"/>'
            for key, value in inclusion.given.items()
        ]
    for inclusion in inclusions:
        lines += ["  " + line.replace("\t", "  ") for line in inclusion.lines]
    return "\n".join([*lines, "</robot>", ""]).encode("utf-8")


def _expand(data: bytes, robots: Sequence[Robot], output: str | Path) -> Robot:
    """Return the robot of the new file, as its readers find packages."""
    known = [robot.source.packages for robot in robots if robot.source is not None]
    finder = Packages(
        output,
        named={name: folder for packages in known for name, folder in packages.named.items()},
        paths=dict.fromkeys(path for packages in known for path in packages.paths),
        configured={n: folder for packages in known for n, folder in packages.configured.items()},
        workspace=known[0].files,
    )
    file = SourceFile(str(output), data)
    return make_robot(read_description(output, file=file, finder=finder))


def _find_difference(expected: Robot, result: Robot) -> str:
    """Return what differs from the URDF of the operation; empty for nothing."""
    kinds = (("link", expected.link, result.link), ("joint", expected.joint, result.joint))
    for kind, one, two in kinds:
        for name in (*one, *two):
            if name not in two:
                return f"{kind} '{name}' is missing"
            if name not in one:
                return f"{kind} '{name}' has another name or should not exist"
    names = [_get_name(element) for element in list_others(result.element)]
    for name in names:
        if name and names.count(name) > 1 and _count(expected, name) < names.count(name):
            return f"'{name}' in <transmission> or <ros2_control> occurs twice"
    rows = narrow_tolerances(ROWS, TOLERANCE)
    differences = compare_robots(expected, result, rows=rows).differences
    serious = [difference for difference in differences if not difference.is_convention]
    return f"{serious[0].title} differs" if serious else ""


def _get_name(element: Element) -> str:
    return element.get("name") or ""


def _count(robot: Robot, name: str) -> int:
    return [_get_name(element) for element in list_others(robot.element)].count(name)


def _replace(expected: Edited, data: bytes, result: Robot, kept: Collection[str]) -> Edited:
    """Return the result of the operation with the xacro file in place of the URDF."""
    made = prove_again(expected, result)
    made.data = data
    made.notes = [*made.notes, *_list_kept_names(result, kept)]
    return made


def _list_kept_names(result: Robot, kept: Collection[str]) -> Iterator[Finding]:
    for element in list_others(result.element):
        if (name := _get_name(element)) in kept and name:
            message = f"<{element.tag}> '{name}' gets no prefix in its source, and keeps its name"
            yield Finding("edit-name", Severity.WARNING, message, element.place)


def _explain(failures: list[str], robots: Sequence[Robot], output: str | Path) -> ModelError:
    """Return the error for sources that cannot be used as they are."""
    source = robots[-1].source
    urdf = Path(output).name.split(".")[0] + ".urdf"
    return ModelError(
        "no xacro argument and no macro parameter sets prefix and parent link as asked; declare "
        '<xacro:arg name="prefix" default=""/> and write $(arg prefix) before each name, or write '
        f"a URDF: -o {urdf}",
        path=None if source is None else source.path,
        notes=[f"tried: {failure}" for failure in failures],
    )
