"""The calls that change PyBullet in a simulation, to be made again without looking at anything."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest import mock

from urdftool.model.load import load
from urdftool.simulation.checks.thresholds import Thresholds
from urdftool.simulation.engines import driver
from urdftool.simulation.engines.pybullet import world
from urdftool.simulation.engines.pybullet.urdf import write_folder
from urdftool.simulation.prepare import prepare
from urdftool.simulation.settings import Settings

LOOKING = ("get", "calculate", "invert", "multiply")
"""How the names of functions begin that change nothing."""

REPLAY = """
import pickle, sys
import pybullet
for name, arguments, options in pickle.load(open(sys.argv[1], "rb")):
    getattr(pybullet, name)(*arguments, **options)
"""
"""Makes them, in a process of its own."""


class Recorder:
    """PyBullet, and what was called of it."""

    def __init__(self, p: Any) -> None:
        """Take the library."""
        self._p = p
        self.calls: list[tuple[str, tuple[Any, ...], dict[str, Any]]] = []

    def __getattr__(self, name: str) -> Any:
        """A function that is noted if it changes something, or a constant."""
        found = getattr(self._p, name)
        if not callable(found) or isinstance(found, type) or name.startswith(LOOKING):
            return found
        return self._noted(name, found)

    def _noted(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **options: Any) -> Any:
            self.calls.append((name, arguments, options))
            return function(*arguments, **options)

        return call


def write_calls(path: Path, settings: Settings, folder: Path) -> Path:
    """Simulate a robot in this process; the file of its calls, beside the URDF that they load."""
    bodies = prepare(load(path), settings)
    write_folder(bodies, folder)
    module = world.import_pybullet()
    recorder = Recorder(module)
    with mock.patch.object(world, "import_pybullet", return_value=recorder):
        driver.run("pybullet", bodies, settings, folder, Thresholds())
    module.disconnect()
    target = folder / "calls"
    target.write_bytes(pickle.dumps(recorder.calls))
    return target
