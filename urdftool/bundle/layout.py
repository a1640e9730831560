"""Portable file names: ASCII letters, digits and underscores, distinct without regard to case.

Foxglove refuses a dash or a second dot in the path of an asset, Windows some names and the
difference of upper and lower case, and MuJoCo names a mesh by its stem.
"""

from __future__ import annotations

import re
import unicodedata
from pathlib import Path

from ..formats.common.naming import UniqueNames, get_first_free, list_numbered_names
from .collect import Asset

MESHES = "meshes"
"""Folder of the meshes and images in a bundle."""

_RESERVED = re.compile(r"(?i)con|prn|aux|nul|com\d|lpt\d")
_LONGEST = 80
"""Characters of a file name. Chosen, no source."""


def make_portable(text: str, default: str = "unnamed") -> str:
    """Return a text as a name of ASCII letters, digits and underscores."""
    ascii_text = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    name = re.sub(r"\W+", "_", ascii_text).strip("_")[:_LONGEST] or default
    return f"{name}_" if _RESERVED.fullmatch(name) else name


class Layout:
    """Names of the files of a bundle.

    Stems of meshes are distinct, also if the suffixes differ; names of other files are distinct.
    """

    def __init__(self, folder: str = MESHES) -> None:
        """Start with an empty folder."""
        self.folder = folder
        self._stems = UniqueNames(fold=True)
        self._names = UniqueNames(fold=True)

    def place(self, asset: Asset, suffix: str = "") -> str:
        """Return the path of an asset in the bundle.

        Args:
            asset: The asset.
            suffix: Suffix of the new file, with its dot; empty keeps that of the asset.
        """
        suffix = suffix or "." + make_portable(asset.suffix.lstrip("."), "bin")
        stem = make_portable(asset.path.stem, asset.kind)
        parents = [make_portable(Path(part).name, "") for part in asset.path.parent.parts[-2:]]
        longer = [stem]
        for parent in reversed(parents):
            if parent:
                longer.append(f"{longer[-1]}_{parent}")
        if asset.kind == "mesh":
            return f"{self.folder}/{self._stems.take(*longer[:2])}{suffix}"
        taken = self._names
        stem = next((name for name in longer if name + suffix not in taken), "")
        stem = stem or get_first_free(list_numbered_names(longer[0], 1), _WithSuffix(taken, suffix))
        return f"{self.folder}/{taken.take(stem + suffix)}"


class _WithSuffix:
    """Stems that are taken with a suffix."""

    def __init__(self, names: UniqueNames, suffix: str) -> None:
        self._names = names
        self._suffix = suffix

    def __contains__(self, stem: object) -> bool:
        return f"{stem}{self._suffix}" in self._names
