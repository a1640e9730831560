"""Ogre material scripts for textures in Gazebo Classic, in the folders where it expects them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import chain
from pathlib import Path

from ..common.naming import get_first_free, list_numbered_names

SCRIPTS = "materials/scripts"
TEXTURES = "materials/textures"


def choose_picture_names(robot: str, pictures: list[Path]) -> dict[Path, str]:
    """Choose a file name for each texture; Ogre shares one namespace among all models.

    Args:
        robot: Name of the model, the prefix of every name.
        pictures: Paths of the textures.
    """
    names: dict[Path, str] = {}
    for path in pictures:
        stem, suffix = replace_quoted(f"{robot}_{path.stem}"), path.suffix.lower()
        candidates = chain((f"{stem}{suffix}",), list_numbered_names(stem, suffix=suffix))
        names[path] = get_first_free(candidates, set(names.values()))
    return names


def replace_quoted(name: str) -> str:
    """Replace characters that require quotes in a script."""
    return re.sub(r"[^\w.-]", "_", name)


def get_material_name(robot: str, picture: str) -> str:
    """Return the name of the material of a texture."""
    return f"{replace_quoted(robot)}/{picture.rpartition('.')[0]}"


def create_script(robot: str, pictures: Mapping[Path, str]) -> bytes:
    """Create the script with a white material for each texture; visuals set their own colors.

    Args:
        robot: Name of the model.
        pictures: File names in the texture folder, by path.
    """
    parts = [
        f"material {get_material_name(robot, name)}\n"
        "{\n  technique\n  {\n    pass\n    {\n"
        "      ambient 1 1 1 1\n      diffuse 1 1 1 1\n"
        f"      texture_unit\n      {{\n        texture {name}\n      }}\n"
        "    }\n  }\n}\n"
        for name in pictures.values()
    ]
    return "\n".join(parts).encode()
