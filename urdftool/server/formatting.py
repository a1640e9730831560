"""Formatting of a document, as ``urdftool fmt`` does."""

from __future__ import annotations

from typing import Any

from ..fmt.run import format_file
from .around import YAML
from .edits import make_edit
from .knowledge import Knowledge


def format_document(knowledge: Knowledge, params: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the edits that format a document; none if it has its layout, or is YAML.

    Raises:
        SourceError: It is not well-formed.
    """
    if params["path"].endswith(YAML):
        return []
    file = knowledge.read(params["path"])
    done = format_file(file)
    return [make_edit(knowledge, file, done.after)] if done.is_changed else []
