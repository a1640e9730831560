"""Calls of git that start no program that a repository configures."""

from __future__ import annotations

import os
import subprocess

_VARIABLES = {
    "GIT_ALLOW_PROTOCOL": "none",  # a missing object of a partial clone would be fetched
    "GIT_NO_LAZY_FETCH": "1",
    "GIT_TERMINAL_PROMPT": "0",
    "GIT_OPTIONAL_LOCKS": "0",
}
_SETTINGS = ("safe.bareRepository=explicit", "core.fsmonitor=false", "core.hooksPath=/dev/null")


def run_git(
    folder: str | os.PathLike[str], *words: str, given: bytes | None = None
) -> subprocess.CompletedProcess[bytes]:
    """Run git in a folder and return its result.

    Raises:
        OSError: Git is not installed.
    """
    options = [word for setting in _SETTINGS for word in ("-c", setting)]
    return subprocess.run(
        ["git", "-C", os.fspath(folder), *options, *words],
        input=given,
        capture_output=True,
        check=False,
        env={**os.environ, **_VARIABLES},
    )
