"""Textures for Gazebo Classic: scripts of Ogre, in the folders where Gazebo's models have them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import chain
from pathlib import Path

from ..common.naming import first_free, numbered

SCRIPTS = "materials/scripts"
TEXTURES = "materials/textures"


def picture_names(robot: str, pictures: list[Path]) -> dict[Path, str]:
    """A file name for each picture; Ogre has one room for the pictures of all models.

    Args:
        robot: The name of the model, with which every name begins.
        pictures: The files.
    """
    names: dict[Path, str] = {}
    for path in pictures:
        stem, suffix = plain(f"{robot}_{path.stem}"), path.suffix.lower()
        candidates = chain((f"{stem}{suffix}",), numbered(stem, suffix=suffix))
        names[path] = first_free(candidates, set(names.values()))
    return names


def plain(name: str) -> str:
    """A name without what would need quotes in a script."""
    return re.sub(r"[^\w.-]", "_", name)


def material_name(robot: str, picture: str) -> str:
    """The name of the material with a picture."""
    return f"{plain(robot)}/{picture.rpartition('.')[0]}"


def script(robot: str, pictures: Mapping[Path, str]) -> bytes:
    """The script with a white material for each picture; a visual says its own colours.

    Args:
        robot: The name of the model.
        pictures: Names of the files in the folder of textures.
    """
    parts = [
        f"material {material_name(robot, name)}\n"
        "{\n  technique\n  {\n    pass\n    {\n"
        "      ambient 1 1 1 1\n      diffuse 1 1 1 1\n"
        f"      texture_unit\n      {{\n        texture {name}\n      }}\n"
        "    }\n  }\n}\n"
        for name in pictures.values()
    ]
    return "\n".join(parts).encode()
