"""Files of a stage: text, binary, and packages with all images."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from pxr import Sdf, Tf, UsdUtils

from ...errors import OutputError
from ..common.directory import mark_usda
from .stage import StageBuilder

Content = bytes | Path

FOLDER = "payloads"


def check_replaced(path: Path) -> None:
    """Check that a binary file that an export replaces was written by urdftool.

    Raises:
        OutputError: It was not.
    """
    if not path.is_file() or path.suffix.lower() not in (".usdc", ".usdz", ".usd"):
        return
    try:
        layer = Sdf.Layer.OpenAsAnonymous(str(path))
        creator = str(layer.customLayerData.get("creator", "")) if layer else ""
    except Tf.ErrorException:
        creator = ""
    if not creator.startswith("urdftool "):
        raise OutputError(
            "was not written by urdftool; keep it, or overwrite it with --overwrite", path=path
        )


def make_single_file(
    builder: StageBuilder, name: str, source: str, images: Mapping[str, Content]
) -> dict[str, Content]:
    """Return the files of a stage of one layer, by path; the suffix of the name is the form."""
    suffix = Path(name).suffix.lower()
    if suffix == ".usda":
        return {name: encode_text(builder.base, source), **images}
    data = encode_binary(builder.base)
    if suffix != ".usdz":
        return {name: data, **images}
    return {name: _make_package(Path(name).stem, data, images)}


def make_layered_files(
    builder: StageBuilder, name: str, source: str, images: Mapping[str, Content]
) -> dict[str, Content]:
    """Return the files of a stage whose robot is a payload with a layer for each kind of data."""
    own = {kind: layer for kind, layer in builder.layers.items() if layer is not builder.base}
    base = Sdf.Layer.CreateAnonymous("base.usda")  # no stage composes it
    base.TransferContent(builder.base)
    base.subLayerPaths = [f"./{kind}.usdc" for kind in own]
    layer = Sdf.Layer.CreateAnonymous("interface.usda")
    layer.customLayerData = builder.base.customLayerData
    for key in ("metersPerUnit", "kilogramsPerUnit", "upAxis", "timeCodesPerSecond"):
        layer.pseudoRoot.SetInfo(key, builder.base.pseudoRoot.GetInfo(key))
    prim = Sdf.CreatePrimInLayer(layer, builder.root)
    prim.specifier, prim.typeName, prim.kind = Sdf.SpecifierDef, "Xform", "component"
    prim.payloadList.Prepend(Sdf.Payload(f"./{FOLDER}/base.usda"))
    layer.defaultPrim = prim.name
    binary = Path(name).suffix.lower() in (".usdc", ".usd")
    files: dict[str, Content] = {
        name: encode_binary(layer) if binary else encode_text(layer, source)
    }
    files[f"{FOLDER}/base.usda"] = encode_text(base, source)
    files |= {f"{FOLDER}/{kind}.usdc": encode_binary(layer) for kind, layer in own.items()}
    return files | {f"{FOLDER}/{path}": content for path, content in images.items()}


def encode_text(layer: Sdf.Layer, source: str) -> bytes:
    """Return a layer as text, with the mark of the export."""
    text: str = layer.ExportToString()
    return mark_usda(re.sub(r"\n{3,}", "\n\n", text).rstrip().encode() + b"\n", source)


def encode_binary(layer: Sdf.Layer) -> bytes:
    """Return a layer as binary (crate) data."""
    with TemporaryDirectory(prefix="urdftool-") as folder:
        path = Path(folder) / "layer.usdc"
        layer.Export(str(path))
        return path.read_bytes()


def _make_package(stem: str, data: bytes, images: Mapping[str, Content]) -> bytes:
    """Return a package of a layer and its images.

    Raises:
        OutputError: OpenUSD cannot create it.
    """
    with TemporaryDirectory(prefix="urdftool-") as folder:
        layer = Path(folder) / f"{stem}.usdc"
        layer.write_bytes(data)
        for path, content in images.items():
            image = Path(folder) / path
            image.parent.mkdir(parents=True, exist_ok=True)
            image.write_bytes(content if isinstance(content, bytes) else content.read_bytes())
        package = Path(folder) / f"{stem}.usdz"
        if not UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(layer)), str(package)):
            raise OutputError("OpenUSD cannot create the package", path=f"{stem}.usdz")
        return package.read_bytes()
