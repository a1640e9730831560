"""Cache of results, keyed by the file's content and the settings."""

from __future__ import annotations

from ..source.access import list_companions
from ..storage import DiskCache, cache_key
from .compute import Result, Task, parse_result

_VERSION = 12
"""Version of the results; increment it when the same settings give another result."""


def read_cached_result(cache: DiskCache, key: str) -> Result | None:
    """Return the cached result of a key; None if it is missing or damaged."""
    data = cache.get(key)
    try:
        return None if data is None else parse_result(data, cached=True)
    except ValueError:
        return None


def compute_key(task: Task) -> str | None:
    """Return the key of a task's result; None if its file cannot be read."""
    suffix = task.path.suffix.lower()
    facts = [suffix, list(task.scale), task.settings.as_dict()]
    if suffix in (".gltf", ".glb"):
        facts.append(task.gltf_up)
    try:
        inputs = [task.path.read_bytes()]
        if suffix == ".gltf":  # buffers are separate files
            for path in list_companions(task.path, "*.bin"):
                inputs += [path.name.encode(), path.read_bytes()]
    except OSError:
        return None
    return cache_key(_VERSION, facts, inputs)
