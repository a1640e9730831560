"""How mesh and material files name other files, as expressions whose first group is the name.

Each takes time linear in the length of the file, also of one that is made to be slow.
"""

from __future__ import annotations

import re

_NAME = rb"(\S(?:[^\r\n]*\S)?)"
_OPTION = rb"-\w+(?:[ \t]+(?:on|off|sphere|cube_\w+|[-+.\d][-+.\deE]*|[rgbmlz]))*[ \t]+"

MTLLIB = re.compile(rb"(?m)^[ \t]*mtllib[ \t]+" + _NAME)
"""Material library of an OBJ file."""

MAP = re.compile(
    rb"(?m)^[ \t]*(?:map_\w+|bump|disp|decal|refl|norm)[ \t]+(?:" + _OPTION + rb")*" + _NAME
)
"""Image of a material of an MTL file."""

INIT_FROM = re.compile(rb"<init_from\b[^<>]*>\s*(?:<ref\b[^<>]*>\s*)?([^<\s](?:[^<]*[^<\s])?)\s*<")
"""Image of a COLLADA file."""

URI = re.compile(rb'"uri"\s*:\s*"([^"]+)"')
"""Buffer or image of a glTF file."""
