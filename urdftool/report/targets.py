"""Targets of robots with their evidence, as text and JSON (``docs/schemas/lint-targets.json``)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..lint.evidence import Evidence
from ..lint.explained_targets import ExplainedTargets
from ..lint.variants import label
from ..listing import list_first
from .json_text import format_json

_MOST_CONTROLLERS = 6
"""Controllers of a file that a line names; chosen, no source."""


def format_targets_as_text(explained: Iterable[ExplainedTargets]) -> str:
    """Format the targets of robots; those with the same evidence are one block."""
    blocks: dict[str, list[str]] = {}
    for one in explained:
        blocks.setdefault("\n".join(_format_block(one)), []).append(one.path)
    return "\n".join("\n".join((*paths, block, "")) for block, paths in blocks.items())


def _format_block(one: ExplainedTargets) -> Iterator[str]:
    if one.not_checked:
        yield f"  not checked: {one.not_checked}"
        return
    names = ", ".join(sorted(one.targets)) or "any reader of URDF"
    yield f"  targets: {names}" + (f" (set by {one.set_by})" if one.set_by else "")
    for evidence, ignored in one.evidence.items():
        yield f"    {_format_evidence(evidence, ignored)}"
    if one.packages:
        yield "  packages:"
    for name, folder in sorted(one.packages.items()):
        yield f"    {name}: {folder or 'not found'}"
    yield from _format_arguments(one)
    if one.controllers:
        yield "  controllers:"
    for use in one.controllers:
        named = [f"{name} ({kind})" for name, kind in use.controllers.items()]
        yield f"    {use.path}: {list_first(named, _MOST_CONTROLLERS)}; {use.why}"


def _format_evidence(evidence: Evidence, ignored: str) -> str:
    place = f"{evidence.path}:{evidence.line}" if evidence.line else evidence.path
    note = f" (does not count: {ignored})" if ignored else ""
    return f"{evidence.target}: {place}: {evidence.text}{note}"


def _format_arguments(one: ExplainedTargets) -> Iterator[str]:
    if one.arguments is None:
        yield "  launch arguments: not searched; name the folder to check those of launch files"
        return
    if one.arguments or one.computed:
        yield "  launch arguments:"
    for arguments, place in one.arguments:
        yield f"    {label(arguments)}: {place}"
    for name, place in one.computed.items():
        yield f"    {name}: computed in {place}, so it is not passed"


def format_targets_as_json(explained: Iterable[ExplainedTargets]) -> str:
    """Format the targets of robots as one object."""
    robots = [_make_object(one) for one in explained]
    return format_json({"version": 1, "robots": robots}, indent=1) + "\n"


def _make_object(one: ExplainedTargets) -> dict[str, object]:
    return {
        "path": one.path,
        "targets": sorted(one.targets),
        "set_by": one.set_by or None,
        "evidence": [
            {**evidence._asdict(), "line": evidence.line or None, "ignored": ignored or None}
            for evidence, ignored in one.evidence.items()
        ],
        "packages": dict(sorted(one.packages.items())),
        "arguments": None
        if one.arguments is None
        else [{"values": values, "place": place} for values, place in one.arguments],
        "computed_arguments": one.computed,
        "controllers": [use._asdict() for use in one.controllers],
        "not_checked": one.not_checked or None,
    }
