"""Writing of ``model.config``, the entry of a model in Gazebo's model database."""

from __future__ import annotations

from lxml import etree

from .options import MODEL, Options
from .xml import add, serialize_document


def write_config(name: str, options: Options) -> bytes:
    """Write the file.

    Args:
        name: Name of the model.
        options: Options of the export.
    """
    root = etree.Element("model")
    add(root, "name", name)
    add(root, "version", "1.0")
    add(root, "sdf", MODEL, version=options.sdf_version)
    author = add(root, "author")
    add(author, "name", "urdftool")
    add(root, "description", f"{name}, exported from its URDF")
    return serialize_document(root)
