"""Robot descriptions below folders, of all XML formats and with their parts."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable

from ..lint.discover import has_ending, list_files
from ..source.description_formats import OWN_XML_SUFFIXES, ROOTS

ENDINGS = (*OWN_XML_SUFFIXES, ".srdf")
_HEAD = 16_384
"""Bytes in which the root element must begin. Chosen, no source."""

_ROOT = re.compile(
    rb"\A(?:\xef\xbb\xbf)?(?:\s|<\?(?:(?!\?>).)*\?>|<!--(?:(?!-->).)*-->)*<(?:%s)[\s/>]"
    % "|".join(ROOTS).encode(),
    re.DOTALL,
)


def find_files(paths: Iterable[str], links: list[str] | None = None) -> list[str]:
    """Return the files to format, each once: named files, and descriptions below named folders.

    Below folders these are files by their ending, and ``.xml`` files by their root element; hidden
    folders are skipped. A named path that does not exist is kept, so that it is reported.

    Args:
        paths: Files and folders.
        links: List to which links are added that are not followed.
    """
    found: dict[str, str] = {}
    for path in paths:
        files = [path]
        if os.path.isdir(path):
            below = list_files(path, (*ENDINGS, ".xml"), links)
            files = [file for file in below if has_ending(file, *ENDINGS) or _is_description(file)]
        for file in files:
            found.setdefault(file if file == "-" else os.path.realpath(file), file)
    return list(found.values())


def _is_description(path: str) -> bool:
    """Tell whether an ``.xml`` file has the root element of a robot description."""
    try:
        with open(path, "rb") as stream:
            return _ROOT.match(stream.read(_HEAD)) is not None
    except OSError:
        return False
