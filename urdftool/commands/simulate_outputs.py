"""What ``urdftool simulate`` draws: a picture, a film and curves of a run."""

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
    """Files that are asked for.

    Attributes:
        plot: Curves over time.
        picture: The robot where it came to rest.
        video: The run as a film.
        shapes: What is drawn, once it is read.
    """

    plot: str | None = None
    picture: str | None = None
    video: str | None = None
    shapes: Shapes | None = field(default=None, repr=False)

    @property
    def wanted(self) -> bool:
        """Whether any is."""
        return bool(self.plot or self.picture or self.video)

    def check(self) -> None:
        """Refuse files that cannot be written, before the robot is even read.

        Raises:
            UsageError: One has another ending, or no place to be written to.
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
            raise click.UsageError("--plot, --picture and --video want a file each")

    def read(self, console: Console, robot: Robot) -> None:
        """Read what is to be drawn, before anything is simulated.

        Raises:
            ModelError: There is nothing.
        """
        if not (self.picture or self.video):
            return
        from ..drawing.shapes import robot_shapes
        from ..errors import ModelError

        for show in ("visual", "collision"):
            with Progress(console, "meshes") as progress:
                self.shapes = robot_shapes(robot, show=show, progress=progress)
            for problem in self.shapes.problems:
                console.error(problem)
            if len(self.shapes):
                if show == "collision":
                    console.note("the robot has no visual that could be drawn: collisions are")
                return
        raise ModelError("the robot has nothing that could be drawn", at=robot.place)

    def write(self, console: Console, robot: Robot, runs: Sequence[Run]) -> None:
        """Draw a trial, which was run in one engine or two, and write the files.

        Raises:
            OutputError: One cannot be written.
        """
        if not self.wanted:
            return
        from ..drawing.png_file import png
        from ..simulation.animation import render_animation, render_final_state
        from ..simulation.plot import plot

        if self.plot:
            write_picture(plot(robot.name or "the robot", runs), self.plot, robot)
            console.note(f"wrote {self.plot}")
        if self.picture and self.shapes is not None:
            write_picture(png(render_final_state(runs[0], self.shapes)), self.picture, robot)
            console.note(f"wrote {self.picture}")
        if self.video and self.shapes is not None:
            with Progress(console, "pictures") as progress:
                data = render_animation(
                    runs[0], self.shapes, progress=lambda n, count: progress(n, count, robot.name)
                )
            write_picture(data, self.video, robot)
            console.note(f"wrote {self.video}, {len(data) / 1e6:.2g} MB")


def check_output(option: str, path: str, ending: str) -> None:
    """Refuse a file that cannot be written.

    Args:
        option: That names it.
        path: The file.
        ending: Of its name.

    Raises:
        UsageError: With the reason.
        OutputError: Its folder cannot be made.
    """
    if ending and not path.lower().endswith(ending):
        raise click.UsageError(f"{option} wants a name that ends in {ending}, not {path}")
    from ..extras import require
    from ..output import check_folder

    if ending:
        require(option, "PIL")
    file = Path(path)
    check_folder(file.resolve().parent, path)
    if file.is_dir():
        raise click.UsageError(f"{path} is a folder; the name of a file is wanted")
    folder = file.resolve().parent
    if folder.is_dir() and not os.access(file if file.exists() else folder, os.W_OK):
        raise click.UsageError(f"{path} may not be written")
