"""Process of a Dask worker that runs tasks one after the other: see :mod:`urdftool.cluster`."""

from __future__ import annotations

import gc
import os
import pickle
import sys
from contextlib import suppress
from importlib import import_module
from typing import Any

from . import __version__
from .cluster import ENVIRONMENT, Job
from .errors import UrdftoolError
from .parallel import Loss, ignore_interrupts, make_picklable, map_tasks


def serve() -> None:
    """Run the tasks that come on standard input until it ends, and send their outcomes."""
    ignore_interrupts()
    gc.set_threshold(500_000, 50, 50)  # as in cli.run
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is not an answer
    jobs: dict[bytes, Job] = {}
    while True:
        try:
            sent, task = pickle.load(sys.stdin.buffer)
        except EOFError:
            os._exit(0)  # a library may crash while it is unloaded
        answer = pickle.dumps(_run(jobs, sent, task))
        try:
            pickle.dump(answer, answers)
            answers.flush()
        except BrokenPipeError:  # the worker was killed
            os._exit(1)


def _run(jobs: dict[bytes, Job], sent: bytes, task: bytes) -> Any:
    """Return the result of a task, the exception that it raised, or a :class:`Loss`."""
    try:
        if sent not in jobs:
            jobs.clear()
            jobs[sent] = _begin(pickle.loads(sent))
        job = jobs[sent]
        results = map_tasks(
            job.function,
            [pickle.loads(task)],
            workers=1,
            on_lost=_return_loss,
            time_limit=job.time_limit,
            tries=1,
            isolate=job.isolate,
        )
        return next(results)[1]
    except Exception as error:
        return make_picklable(error)


def _return_loss(_: Any, loss: Loss) -> Any:
    return loss


def _begin(job: Job) -> Job:
    """Prepare this process for a job.

    Raises:
        UrdftoolError: The version of urdftool differs, or the working directory does not exist.
    """
    if job.version != __version__:
        raise UrdftoolError(
            f"a worker of the cluster has urdftool {__version__}, but this is {job.version}"
        )
    try:
        os.chdir(job.folder)
    except OSError as error:
        raise UrdftoolError(
            f"a worker of the cluster does not have the folder {job.folder}; "
            "workers require the same files at the same paths"
        ) from error
    for name in ENVIRONMENT:
        os.environ.pop(name, None)
    os.environ.update(job.environment)
    for module in job.preload:
        with suppress(ImportError):
            import_module(module)
    sys.argv[1:] = []
    return job
