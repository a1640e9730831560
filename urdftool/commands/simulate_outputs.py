"""Output files of ``urdftool simulate``: picture, animation and plot."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..console import Console
from .picture_file import write_picture
from .progress import Progress

if TYPE_CHECKING:
    from ..drawing.shapes import Shapes
    from ..model.elements import Robot
    from ..simulation.run import Run


@dataclass
class Outputs:
    """Requested output files."""

    plot: str | None = None
    picture: str | None = None
    video: str | None = None
    shapes: Shapes | None = field(default=None, repr=False)

    @property
    def is_requested(self) -> bool:
        """Whether a file is requested."""
        return bool(self.plot or self.picture or self.video)

    def check(self) -> None:
        """Refuse files that cannot be written, before the robot is read.

        Raises:
            UsageError: A file has the wrong suffix, is a folder or read-only, or two are the same.
            MissingDependency: --plot requires Matplotlib.
        """
        from ..extras import require

        if self.plot is not None:
            require("--plot", "matplotlib")
        for option, path, ending in (
            ("--plot", self.plot, ".png"),
            ("--picture", self.picture, ".png"),
            ("--video", self.video, ".gif"),
        ):
            if path is not None:
                check_output(option, path, ending)
        paths = [os.path.realpath(p) for p in (self.plot, self.picture, self.video) if p]
        if len(set(paths)) < len(paths):
            raise click.UsageError("--plot, --picture and --video require different files")

    def read(self, console: Console, robot: Robot) -> None:
        """Read the geometry to draw, before the simulation.

        Raises:
            ModelError: The robot has no geometry.
        """
        if not (self.picture or self.video):
            return
        from ..drawing.shapes import read_robot_shapes
        from ..errors import ModelError

        for show in ("visual", "collision"):
            with Progress(console, "meshes") as progress:
                self.shapes = read_robot_shapes(robot, show=show, progress=progress)
            for problem in self.shapes.problems:
                console.print_error(problem)
            if len(self.shapes):
                if show == "collision":
                    console.print_note(
                        "the robot has no visual geometry; drawing collision geometry"
                    )
                return
        raise ModelError("the robot has no geometry to draw", at=robot.place)

    def write(self, console: Console, robot: Robot, runs: Sequence[Run]) -> None:
        """Draw a trial, which was run in one or two engines, and write the files.

        Raises:
            OutputError: A file cannot be written.
        """
        if not self.is_requested:
            return
        from ..drawing.png_file import encode_png
        from ..simulation.animation import render_animation, render_final_state
        from ..simulation.plot import plot

        if self.plot:
            write_picture(plot(robot.name or "the robot", runs), self.plot, robot)
            console.print_note(f"wrote {self.plot}")
        if self.picture and self.shapes is not None:
            write_picture(encode_png(render_final_state(runs[0], self.shapes)), self.picture, robot)
            console.print_note(f"wrote {self.picture}")
        if self.video and self.shapes is not None:
            with Progress(console, "pictures") as progress:
                data = render_animation(
                    runs[0], self.shapes, progress=lambda n, count: progress(n, count, robot.name)
                )
            write_picture(data, self.video, robot)
            console.print_note(f"wrote {self.video}, {len(data) / 1e6:.2g} MB")


def check_output(option: str, path: str, ending: str) -> None:
    """Refuse a file that cannot be written, or has another suffix than a required one.

    Raises:
        UsageError: The suffix is wrong, or the path is a folder or read-only.
        OutputError: The folder cannot be created.
    """
    if ending and not path.lower().endswith(ending):
        raise click.UsageError(f"{option} requires a file that ends in {ending}, not {path}")
    from ..extras import require
    from ..output import check_folder

    if ending:
        require(option, "PIL")
    file = Path(path)
    check_folder(file.resolve().parent, path)
    if file.is_dir():
        raise click.UsageError(f"{path} is a folder; {option} requires a file")
    folder = file.resolve().parent
    if folder.is_dir() and not os.access(file if file.exists() else folder, os.W_OK):
        raise click.UsageError(f"{path} is not writable")
