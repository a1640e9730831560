"""The calls that change PyBullet in a simulation, to be made again without looking at anything."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest import mock

from urdftool.model.load import load
from urdftool.simulation import bullet
from urdftool.simulation.prepare import prepare
from urdftool.simulation.settings import Settings
from urdftool.simulation.urdf import write_folder

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
    module = bullet.bullet_module()
    recorder = Recorder(module)
    with mock.patch.object(bullet, "bullet_module", return_value=recorder):
        bullet.run(bodies, settings, folder)
    module.disconnect()
    target = folder / "calls"
    target.write_bytes(pickle.dumps(recorder.calls))
    return target
