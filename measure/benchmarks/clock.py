"""Run one command; print its seconds, its peak of memory and how it ended, as JSON.

    python -I -S clock.py LIMIT COMMAND …

A process of its own, and a small one: the peak that Linux reports of a child is never below that
of the process that started it. The peak is that of the largest process, not the sum of all.
"""

import json
import os
import signal
import sys
import tempfile
import time


def main(limit, command):
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        begin = time.perf_counter()
        try:
            child = os.posix_spawnp(
                command[0],
                command,
                os.environ,
                file_actions=[
                    (os.POSIX_SPAWN_OPEN, 0, os.devnull, os.O_RDONLY, 0),
                    (os.POSIX_SPAWN_DUP2, out.fileno(), 1),
                    (os.POSIX_SPAWN_DUP2, err.fileno(), 2),
                ],
                setpgroup=0,
            )
        except OSError as error:
            return {"seconds": 0.0, "peak": 0, "code": 127, "out": "", "err": str(error)}
        late = []

        def stop(*_):
            late.append(True)
            os.killpg(child, signal.SIGKILL)

        signal.signal(signal.SIGALRM, stop)
        signal.setitimer(signal.ITIMER_REAL, limit)
        _, status, usage = os.wait4(child, 0)
        seconds = time.perf_counter() - begin
        signal.setitimer(signal.ITIMER_REAL, 0)
        unit = 1 if sys.platform == "darwin" else 1024
        return {
            "seconds": seconds,
            "peak": usage.ru_maxrss * unit,
            "code": None if late else os.waitstatus_to_exitcode(status),
            "out": _end(out),
            "err": _end(err),
        }


def _end(stream, length=4000):
    size = stream.seek(0, os.SEEK_END)
    stream.seek(max(0, size - length))
    return stream.read().decode("utf-8", "replace")


if __name__ == "__main__":
    print(json.dumps(main(float(sys.argv[1]), sys.argv[2:])))
