"""The robots of a repository: which files are robots, and which files belong to them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field


@dataclass
class RobotFile:
    """A file that is a robot.

    Attributes:
        path: Its path.
        why: Why it is one.
        variants: Sets of arguments that launch files and builds pass.
        places: Place of each variant.
        computed: Arguments whose values a launch file computes, with its place.
    """

    path: str
    why: str
    variants: list[dict[str, str]] = field(default_factory=list)
    places: list[str] = field(default_factory=list)
    computed: dict[str, str] = field(default_factory=dict)


@dataclass
class Repository:
    """Robots and parts below folders.

    Attributes:
        robots: Robots by resolved path.
        includes: Files that each xacro file includes, by resolved path.
        computes: Resolved paths of files that include a file with a computed name.
        parts: Resolved paths of URDF files that use arguments and declare none, so that only a file
            that includes them by a computed name can use them.
        paths: Path as found of each xacro and URDF file, by resolved path.
        unknown: Places of launch files and builds that compute the path of a description.
        links: Links out of the folders or to nowhere, which the search does not follow.
    """

    robots: dict[str, RobotFile] = field(default_factory=dict)
    includes: dict[str, list[str]] = field(default_factory=dict)
    computes: set[str] = field(default_factory=set)
    parts: set[str] = field(default_factory=set)
    paths: dict[str, str] = field(default_factory=dict)
    unknown: list[str] = field(default_factory=list)
    links: list[str] = field(default_factory=list)

    def list_files(self, robot: str) -> set[str]:
        """Return the resolved paths of a robot and of all that it includes."""
        todo, found = [robot], {robot}
        while todo:
            for path in self.includes.get(todo.pop(), ()):
                if path not in found:
                    found.add(path)
                    todo.append(path)
        return found

    def list_belonging(self, robot: str) -> set[str]:
        """Return the files of a robot, and all parts if it includes files by computed names."""
        files = self.list_files(robot)
        return files | self.parts if files & self.computes else files

    def select(self, changed: Iterable[str]) -> list[str]:
        """Return the robots that changed files belong to, by resolved path.

        A robot that includes a file by a computed name may include any of them.
        """
        changed_paths = set(changed)
        return [
            real
            for real in self.robots
            if (files := self.list_files(real)) & changed_paths or files & self.computes
        ]
