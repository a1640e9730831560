"""Names of the elements of xacro."""

from __future__ import annotations

TAGS = {
    "arg": "name",
    "attribute": "name",
    "call": "macro",
    "element": "",
    "if": "value",
    "include": "filename",
    "insert_block": "name",
    "macro": "name",
    "property": "name",
    "unless": "value",
}
"""Tags of xacro itself without their prefix, each with an attribute that it requires; all others
are macro calls.
"""

UNPREFIXED = frozenset(TAGS) - {"attribute", "call", "element"}
"""Tags that old files have without the prefix."""

CONDITIONS = ("xacro:if", "xacro:unless")
"""Elements whose content depends on arguments."""
