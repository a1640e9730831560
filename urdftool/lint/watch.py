"""Checks that are repeated when a file changes on which they depend.

Files are compared by their stamps (:mod:`urdftool.dependencies`), a few times a second: that works
on each file system, also where a system does not notify of changes.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from ..dependencies import Dependencies, Question, Stamp, read_stamp
from ..source.description_formats import XML_SUFFIXES
from .discover import list_files
from .options import Options
from .outcome import Report
from .run import check_file

_PERIOD = 0.3
"""Time between two comparisons [s]; chosen, a person does not notice it."""

_SHARE = 0.05
"""Share of the time that comparisons may take; chosen. More files are compared less often."""

_ENDINGS = (
    *(*XML_SUFFIXES, ".srdf", ".toml"),
    *(".launch", ".launch.py", ".launch.xml", "CMakeLists.txt"),
)
"""Files below a named folder that make a robot, or say which files are robots."""

Stamps = dict[Question, "Stamp | None"]


class _Known(NamedTuple):
    """Last report of a robot."""

    report: Report
    stamps: Stamps
    variants: object


class Watch:
    """Robots with what their last reports depend on."""

    def __init__(self, paths: Iterable[str]) -> None:
        """Set the named files and folders."""
        self._paths = list(paths)
        self._known: dict[str, _Known] = {}
        self._noticed: Stamps = {}
        self._places = self._read_place_stamps()

    def check_files(
        self, paths: Sequence[str], options: Options, jobs: int | None = None
    ) -> Iterator[Report]:
        """Yield a report for each description; one with no change is not checked again."""
        for path in paths:
            variants = options.variants.get(options.workspace.resolve_links(path))
            known = self._known.get(path)
            if known is None or known.variants != variants or _list_changed(known.stamps):
                known = self._known[path] = self._check(path, options, variants)
            yield known.report
        self._known = {path: self._known[path] for path in paths}

    def _check(self, path: str, options: Options, variants: object) -> _Known:
        view = options.workspace.with_record()
        view.record("file", path)
        report = check_file(path, replace(options, workspace=view, cache=None))
        for file in report.files:  # MuJoCo reads files itself
            view.record("file", file)
        assert view.dependencies is not None
        stamps = _collect_stamps(view.dependencies)
        for question in stamps:
            self._noticed.pop(question, None)
        return _Known(report, stamps, variants)

    def _select_noticed(self, known: _Known) -> Stamps:
        return {key: self._noticed[key] for key in known.stamps if key in self._noticed}

    def wait(self, sleep: Callable[[float], object] = time.sleep) -> list[str]:
        """Wait, with ``sleep`` for a time [s], until a file changes; return the changed paths."""
        while True:
            begin = time.monotonic()
            changed = self.list_changed()
            if changed:
                self._store_stamps()
                return changed
            sleep(max(_PERIOD, (time.monotonic() - begin) / _SHARE))

    def _store_stamps(self) -> None:
        """Store the present stamps, so that a change is reported once, also if no check follows."""
        self._places = self._read_place_stamps()
        questions = {question for one in self._known.values() for question in one.stamps}
        self._noticed = {question: read_stamp(question) for question in questions}

    def list_changed(self) -> list[str]:
        """Return the paths that changed since the last reports, without folders around others."""
        now = self._read_place_stamps()
        before = self._places
        changed = {path for path in before.keys() | now if before.get(path) != now.get(path)}
        for known in self._known.values():
            changed |= _list_changed({**known.stamps, **self._select_noticed(known)})
        around = {above for path in changed for above in _list_above(path)}
        return sorted(changed - around)

    def count_files(self) -> int:
        """Return the number of files that are watched."""
        questions = {question for one in self._known.values() for question in one.stamps}
        return len({path for kind, path in questions if kind == "file"} | self._places.keys())

    def _read_place_stamps(self) -> dict[str, Stamp | None]:
        """Return the stamps of the named files and of those below the named folders."""
        found: list[str] = []
        for path in self._paths:
            found += list_files(path, _ENDINGS) if os.path.isdir(path) else [path]
        return {path: read_stamp(("file", path)) for path in map(os.path.abspath, found)}


def _list_above(path: str) -> Iterator[str]:
    """Yield the folders around a path."""
    above = os.path.dirname(path)
    while above != path:
        yield above
        path, above = above, os.path.dirname(above)


def _collect_stamps(dependencies: Dependencies) -> Stamps:
    stamps: Stamps = {}
    for part in (dependencies, *dependencies.shared):
        stamps.update(part.stamps)
    return stamps


def _list_changed(stamps: Stamps) -> set[str]:
    return {question[1] for question, stamp in stamps.items() if read_stamp(question) != stamp}
