"""Options of a check."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from ..configuration import Configuration
from ..workspace import Workspace
from .settings import Settings

if TYPE_CHECKING:
    from ..finding import Finding
    from ..model.elements import Robot
    from ..rules.fix import ComputeInertia
    from ..source.description import Description, GltfUp
    from ..source.location import SourceFile
    from ..source.packages import Packages
    from .cache import Cache

ReadOther = Callable[["SourceFile", "Packages"], "Robot | None"]


class Observer(Protocol):
    """Observer of a check, in the process that checks."""

    def receive_description(
        self, description: Description, robot: Robot | None, errors: list[Finding]
    ) -> object:
        """Receive a description before the rules run.

        The robot is None if it could not be read, and errors say why.
        """

    def check_progress(self) -> object:
        """Raise an exception to end the check; called before each rule."""


@dataclass
class Options:
    """Options of the command line for every file.

    Attributes:
        settings: Rules, targets, severities.
        arguments: xacro arguments.
        packages: Folders by package name.
        package_paths: Folders that contain packages.
        config: Configuration file named by the user.
        cache: Cache of reports; None disables it.
        expand: Whether to expand xacro; otherwise only its source is checked, and no expression is
            evaluated.
        fixes: Whether to compute fixes for findings.
        compute_inertia: Function for fixes that fill in inertia: returns (mass [kg], center of mass
            [m], six tensor elements [kg·m²]) by link, in the link frame, for a robot and link
            names.
        read_other: Function that reads a file in a format other than URDF, with its packages, and
            returns None for URDF; None reads every file as URDF.
        gltf_up: Up axis of glTF meshes; None uses the configuration.
        workspace: Access to the files of the run.
        variants: Sets of xacro arguments that launch files pass, by resolved path of the robot.
        observer: Observer of the check, if any.
    """

    settings: Settings = field(default_factory=Settings)
    arguments: Mapping[str, str] = field(default_factory=dict)
    packages: Mapping[str, str | Path] = field(default_factory=dict)
    package_paths: Iterable[str | Path] = ()
    config: str | None = None
    cache: Cache | None = None
    expand: bool = True
    fixes: bool = False
    compute_inertia: ComputeInertia | None = None
    read_other: ReadOther | None = None
    gltf_up: GltfUp | None = None
    workspace: Workspace = field(default_factory=Workspace)
    variants: Mapping[str, list[dict[str, str]]] = field(default_factory=dict)
    observer: Observer | None = None

    def get_key(
        self, cache: Cache, path: str | Path, configuration: Configuration, settings: Settings
    ) -> str:
        """Return the key of a check in a cache."""
        return cache.get_key(
            path,
            [
                *(sorted(self.arguments.items()), _list_folders(self.packages)),
                [str(path) for path in self.package_paths],
                *(configuration.path, _list_folders(configuration.packages)),
                *(_list_settings(settings), self.fixes, self.gltf_up or configuration.gltf_up),
                self.expand,
            ],
        )


def _list_folders(packages: Mapping[str, object]) -> list[tuple[str, str]]:
    return sorted((name, str(folder)) for name, folder in packages.items())


def _list_settings(settings: Settings) -> list[Any]:
    """Return the settings as a list, sorted where order is irrelevant."""
    return [
        *(settings.select, settings.extend_select, settings.ignore),
        None if settings.targets is None else sorted(settings.targets),
        sorted((name, level and level.label) for name, level in settings.severity.items()),
        sorted((name, sorted(table.items())) for name, table in settings.thresholds.items()),
    ]
