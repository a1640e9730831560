"""The library MuJoCo, imported without a program that runs files of the current folder.

For rendering, ``mujoco`` imports ``glfw``, which starts ``python -c``; that imports modules of the
current folder, such as a ``ctypes.py`` of a cloned repository.
"""

from __future__ import annotations

import os
import sys
from typing import Any

from .extras import make_missing_error

WITHOUT_RENDERING = {"MUJOCO_GL": "disable", "PYTHONSAFEPATH": "1"}
"""Variables with which MuJoCo imports no library for rendering, and Python, from 3.11 on, does not
import modules of the current folder."""


def import_mujoco(purpose: str = "reading an MJCF") -> Any:
    """Import and return MuJoCo; a program that calls urdftool can still render with it.

    Raises:
        MissingDependency: It is not installed, which ``purpose`` requires.
    """
    if "mujoco" not in sys.modules:
        wanted = dict(WITHOUT_RENDERING)
        if sys.version_info >= (3, 11):
            del wanted["MUJOCO_GL"]  # unless the command line has set it
        before = {name: os.environ.get(name) for name in wanted}
        os.environ.update(wanted)
        try:
            import mujoco
        except ImportError as error:
            raise make_missing_error("mujoco", purpose) from error
        finally:
            for name, value in before.items():
                if value is None:
                    del os.environ[name]
                else:
                    os.environ[name] = value
    import mujoco  # type: ignore[import-untyped,unused-ignore,no-redef]

    return mujoco
