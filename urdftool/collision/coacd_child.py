"""A process of its own for CoACD, which on some inputs ends the process it runs in.

Reads the mesh and the options from standard input and writes the pieces to standard output, both
as an archive of arrays; what the library prints goes to standard error.
"""

from __future__ import annotations

import ctypes
import io
import json
import os
import signal
import sys
from typing import Any

import numpy as np

_PARENT_ENDED = 1  # PR_SET_PDEATHSIG of prctl(2)


def main() -> None:
    """Decompose one mesh."""
    if sys.platform == "linux":  # end with the parent, however it ends
        ctypes.CDLL(None).prctl(_PARENT_ENDED, signal.SIGKILL)
    result = os.dup(1)
    os.dup2(2, 1)
    with np.load(io.BytesIO(sys.stdin.buffer.read())) as given:
        vertices, faces = given["vertices"], given["faces"]
        options = json.loads(bytes(given["options"]))
    limit_time(options.pop("time_limit"))
    import coacd

    coacd.set_log_level("error")
    parts = coacd.run_coacd(coacd.Mesh(vertices, faces), **options)
    arrays: Any = {}
    for index, (points, triangles) in enumerate(parts):
        arrays[f"v{index}"] = np.asarray(points, dtype=np.float64)
        arrays[f"f{index}"] = np.asarray(triangles, dtype=np.int64)
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    with os.fdopen(result, "wb") as out:
        out.write(stream.getvalue())


def limit_time(seconds: float) -> None:
    """End the process after so much processor time [s], which load does not change."""
    try:
        import resource
    except ImportError:  # Windows: the parent's watch is all there is
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))


if __name__ == "__main__":
    main()
