"""``model.config``: the name of a model and where it is, for Gazebo's list of models."""

from __future__ import annotations

from lxml import etree

from .options import MODEL, Options
from .xml import add, document


def config(name: str, options: Options) -> bytes:
    """The file.

    Args:
        name: The name of the model.
        options: The choices of the export.
    """
    root = etree.Element("model")
    add(root, "name", name)
    add(root, "version", "1.0")
    add(root, "sdf", MODEL, version=options.sdf_version)
    author = add(root, "author")
    add(author, "name", "urdftool")
    add(root, "description", f"{name}, exported from its URDF")
    return document(root)
