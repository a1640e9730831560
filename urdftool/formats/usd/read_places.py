"""Places of prims in the layers of a stage."""

from __future__ import annotations

import os
import re
from bisect import bisect_right

from pxr import Sdf, Usd

from ...source.document import STDIN
from ...source.location import Place, SourceFile
from ...workspace import Workspace
from .read_layers import LayerFiles

_PRIM = re.compile(rb'^([ \t]*)(?:def|over|class)(?: \w+)? "(\w+)"', re.MULTILINE)


class Layers:
    """The layers of a stage as source files.

    A prim is at the line of a text layer that defines it. Layers without lines, which are binary
    or in a package, have the path of the prim instead.
    """

    def __init__(
        self, stage: Usd.Stage, file: SourceFile, files: LayerFiles, workspace: Workspace
    ) -> None:
        """Store the stage; layers are read on demand.

        Raises:
            SourceError: A layer was not checked.
        """
        self._file, self._workspace = file, workspace
        self.files = files
        self._root: Sdf.Layer = stage.GetRootLayer()
        self._files: dict[str, SourceFile] = {}
        self._texts: dict[str, TextLayer] = {}
        self._numbers: dict[str, int] = {}
        files.check_used(stage.GetUsedLayers())
        self._used = [layer for layer in stage.GetUsedLayers() if not layer.anonymous]

    def list_files(self) -> list[SourceFile]:
        """Return the file of the stage, and those of its other layers."""
        files = [self._file, *map(self._get_file, self._used)]
        return list({file.path: file for file in files}.values())

    def get_place(self, prim: Usd.Prim, attribute: str = "") -> Place:
        """Return the place of a prim.

        Args:
            prim: The prim.
            attribute: Attribute whose strongest opinion is the place; empty, or without an
                opinion, for the definition of the prim.
        """
        if not prim or prim.IsPseudoRoot():
            return Place(self._file, 0, 0)
        stack = prim.GetPrimStack()
        for spec in stack if attribute else ():
            if attribute in spec.properties:
                return self._find_spec(spec, str(prim.GetPath()), attribute)
        found = [spec for spec in stack if spec.specifier == Sdf.SpecifierDef] or stack
        return self._find_spec(found[0], str(prim.GetPath())) if found else Place(self._file, 0, 0)

    def _find_spec(self, spec: Sdf.PrimSpec, path: str, attribute: str = "") -> Place:
        file = self._get_file(spec.layer)
        own = str(spec.path.StripAllVariantSelections())
        text = self._texts.get(file.path)
        if text is None:
            text = self._texts[file.path] = TextLayer(file.data)
        while own and own not in text.spans:
            own, attribute = own.rpartition("/")[0], ""
        if own:
            return Place(file, *text.find(own, attribute))
        number = self._numbers.setdefault(path, len(self._numbers))
        return Place(SourceFile(file.path, b"", part=f"<{path}>"), number, number)

    def _get_file(self, layer: Sdf.Layer) -> SourceFile:
        """Return a layer as a source file; its path is relative if that of the stage is."""
        if layer == self._root or self._file.path == STDIN:
            return self._file
        path = layer.realPath.partition("[")[0]  # without the layer in a package
        if path not in self._files:
            start = os.path.dirname(self._file.path)
            shown = path
            if not os.path.isabs(start):
                above = os.path.relpath(path, os.path.abspath(start))
                shown = os.path.normpath(os.path.join(start, above))
            try:
                data = self._workspace.read_bytes(path)
            except OSError:
                data = b""
            same = os.path.realpath(path) == os.path.realpath(self._file.path)
            self._files[path] = self._file if same else SourceFile(shown, data)
        return self._files[path]


class TextLayer:
    """Positions in a text layer.

    Attributes:
        spans: Span of the head of each prim by path; prims are nested by their indentation.
    """

    def __init__(self, data: bytes) -> None:
        """Find the prims; a binary layer has none."""
        self.spans: dict[str, tuple[int, int]] = {}
        self._data = data
        self._starts: list[int] = []
        if not data.startswith(b"#usda"):
            return
        stack: list[tuple[int, str]] = []
        for match in _PRIM.finditer(data):
            depth = len(match[1])
            while stack and stack[-1][0] >= depth:
                stack.pop()
            path = (stack[-1][1] if stack else "") + "/" + match[2].decode()
            stack.append((depth, path))
            self.spans.setdefault(path, (match.start() + depth, match.end()))
            self._starts.append(match.start())

    def find(self, path: str, attribute: str) -> tuple[int, int]:
        """Return the span of an attribute of a prim, or of the prim without it."""
        start, end = self.spans[path]
        if not attribute:
            return start, end
        after = bisect_right(self._starts, start)
        stop = self._starts[after] if after < len(self._starts) else len(self._data)
        line = re.compile(rb"^[ \t]*(\S.*\b%s = .*)$" % re.escape(attribute.encode()), re.MULTILINE)
        match = line.search(self._data, end, stop)
        return match.span(1) if match else (start, end)
