"""Cache of results, keyed by the file's content and the settings."""

from __future__ import annotations

from pathlib import Path

from ..source.access import list_companions
from ..storage import DiskCache, cache_key
from .compute import Result, Task, Vector, list_mesh_files, parse_result

_VERSION = 13
"""Version of the results; increment it when the same settings give another result."""


def read_cached_result(cache: DiskCache, key: str) -> Result | None:
    """Return the cached result of a key; None if it is missing or damaged."""
    data = cache.get(key)
    try:
        return None if data is None else parse_result(data, cached=True)
    except ValueError:
        return None


def compute_key(task: Task) -> str | None:
    """Return the key of a task's result; None if one of its files cannot be read."""
    facts: list[object] = [_list_facts(task, task.path, task.scale), task.settings.as_dict()]
    for other in task.others:
        facts.append([*_list_facts(task, other.path, other.scale), other.pose])
    try:
        inputs = [data for path in list_mesh_files(task) for data in _read_inputs(path)]
    except OSError:
        return None
    return cache_key(_VERSION, facts, inputs)


def _list_facts(task: Task, path: Path, scale: Vector) -> list[object]:
    suffix = path.suffix.lower()
    return [suffix, list(scale), task.gltf_up if suffix in (".gltf", ".glb") else ""]


def _read_inputs(path: Path) -> list[bytes]:
    inputs = [path.read_bytes()]
    if path.suffix.lower() == ".gltf":  # buffers are separate files
        for buffer in list_companions(path, "*.bin"):
            inputs += [buffer.name.encode(), buffer.read_bytes()]
    return inputs
