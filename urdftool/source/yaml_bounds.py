"""Size checks of YAML before it is loaded, since a few lines of it can exhaust memory."""

from __future__ import annotations

from io import StringIO
from typing import Any

from ..errors import XacroError

MAX_BYTES = 32 * 1024 * 1024  # of a file of YAML, as of a description; chosen, no source
MAX_VALUES = 1_000_000
"""Maximum number of values and characters of a file, with aliases resolved. Chosen, no source."""
MAX_DEPTH = 100  # nested values; chosen, no source


def check_yaml(text: str, name: str, loader: Any) -> Any:
    """Check the size of YAML and return it as a stream.

    Counts the events of the parser without storing them: nested lists would overflow the stack in
    libyaml, and aliases or merges of aliases may grow exponentially.

    Raises:
        XacroError: It exceeds the limits of depth or size, or contains itself.
        YAMLError: It is not valid YAML.
    """
    import yaml

    sizes: dict[str, int] = {}
    open_ones: list[tuple[str | None, int]] = []
    count = 0
    again = StringIO(text)
    again.name = name
    for event in yaml.parse(again, Loader=loader):
        anchor = getattr(event, "anchor", None)
        mark: Any = event.start_mark
        where = f"{name}:{mark.line + 1}:{mark.column + 1}"
        if isinstance(event, yaml.AliasEvent):
            if any(anchor == around for around, _ in open_ones):
                raise XacroError(
                    f"{where}: alias *{anchor} refers to the value that contains it",
                    rule="expansion-failed",
                )
            count += sizes.get(anchor or "", 1)
        elif isinstance(event, yaml.ScalarEvent):
            count += 1 + len(event.value)
            if anchor:
                sizes[anchor] = 1 + len(event.value)
        elif isinstance(event, (yaml.SequenceStartEvent, yaml.MappingStartEvent)):
            open_ones.append((anchor, count))
            count += 1
            if len(open_ones) > MAX_DEPTH:
                raise _make_limit_error(where, f"values are nested more than {MAX_DEPTH} deep")
        elif isinstance(event, (yaml.SequenceEndEvent, yaml.MappingEndEvent)):
            around, before = open_ones.pop()
            if around:
                sizes[around] = count - before
        if count > MAX_VALUES:
            raise _make_limit_error(
                where, f"the file has more than {MAX_VALUES} values with its aliases"
            )
    again.seek(0)
    return again


def _make_limit_error(where: str, what: str) -> XacroError:
    return XacroError(
        f"{where}: {what}, the limit of YAML in a description", rule="expansion-failed"
    )
