"""Opening a stage, and the errors of OpenUSD."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from pxr import Pcp, Tf, Usd, UsdUtils

from ...diagnostic import Severity
from ...errors import ModelError
from ...source.location import Place, SourceFile
from ...workspace import Workspace
from ..reading import Losses
from .read_layers import LayerFiles, check_count, open_layers
from .read_places import Layers

_INCOMPLETE = (
    Pcp.ErrorArcCycle,
    Pcp.ErrorInvalidAssetPath,
    Pcp.ErrorInvalidSublayerPath,
    Pcp.ErrorSublayerCycle,
    Pcp.ErrorUnresolvedPrimPath,
)
"""Errors after which parts of the stage are missing."""


@contextmanager
def convert_errors(file: SourceFile) -> Iterator[None]:
    """Convert exceptions of OpenUSD, which decodes parts of a stage when they are asked for.

    Raises:
        ModelError: OpenUSD raised an exception.
    """
    try:
        yield
    except (Tf.ErrorException, UnicodeError) as error:
        notes = [_NOT_TEXT] if isinstance(error, UnicodeError) else list(_list_messages(error.args))
        text = "OpenUSD does not open the stage"
        raise ModelError(text, at=Place(file, 0, 0), notes=notes) from None


def open_stage(
    path: str, file: SourceFile, losses: Losses, workspace: Workspace
) -> tuple[Usd.Stage, Layers]:
    """Open a stage with its payloads, and record the warnings of OpenUSD.

    Returns:
        The stage, and its layers.

    Raises:
        ModelError: A layer that it refers to cannot be opened.
        Exception: OpenUSD raises it, see :func:`convert_errors`.
    """
    delegate = UsdUtils.CoalescingDiagnosticDelegate()
    place = Place(file, 0, 0)
    files = LayerFiles(workspace, place)
    opened = open_layers(os.path.abspath(path), files)
    check_count(opened, place)
    stage = Usd.Stage.Open(os.path.abspath(path), Usd.Stage.LoadAll)
    layers = Layers(stage, file, files, workspace)
    errors = [error for error in stage.GetCompositionErrors() if isinstance(error, _INCOMPLETE)]
    if errors:
        delegate.TakeUncoalescedDiagnostics()
        raise ModelError(
            "parts of the stage are missing",
            at=layers.get_place(stage.GetPrimAtPath(errors[0].rootSite.path)),
            notes=[_join(str(error)) for error in errors[:_MOST]],
        )
    for text in _list_messages(delegate.TakeUncoalescedDiagnostics()):
        losses.add("warning", f"OpenUSD warns: {text}", "", place, Severity.INFO)
    return stage, layers


_MOST = 3
"""Number of messages of OpenUSD that an error shows. Chosen, no source."""


_NOT_TEXT = "the text is not valid UTF-8"


def _list_messages(items: Iterable[Any]) -> Iterator[str]:
    """Yield the messages of diagnostics; they quote the file, which may be no valid text."""
    for item in items:
        try:
            yield _join(str(item.commentary))
        except UnicodeError:
            yield _NOT_TEXT


def _join(text: str) -> str:
    return " ".join(text.split())
