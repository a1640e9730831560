"""Formats of robot descriptions: their names and how their files are recognized."""

from __future__ import annotations

from typing import NamedTuple


class DescriptionFormat(NamedTuple):
    """A format of robot descriptions.

    Attributes:
        name: Name of its folder in ``formats``, also used on the command line.
        title: Display name, with its simulators.
        suffixes: File suffixes, in lower case; ``.xml`` belongs to several formats.
        roots: Tags of the root elements of its files; none for a format that is not XML.
        heads: First bytes of its files, of a format that is not XML.
        has_several: Whether a file may have several robots.
        targets: Simulators for which it is made, as targets of ``lint``; none for any reader.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    roots: tuple[str, ...] = ()
    heads: tuple[bytes, ...] = ()
    has_several: bool = False
    targets: tuple[str, ...] = ()


URDF = DescriptionFormat("urdf", "URDF and xacro", (".urdf", ".xacro"), ("robot",))

DESCRIPTION_FORMATS = (
    URDF,
    DescriptionFormat(
        "sdf",
        "SDF, for Gazebo",
        (".sdf", ".xml", ".world"),
        ("sdf",),
        has_several=True,
        targets=("gz",),
    ),
    DescriptionFormat(
        "mjcf",
        "MJCF, for MuJoCo",
        (".xml", ".mjcf"),
        ("mujoco", "mujocoinclude"),
        targets=("mujoco",),
    ),
    DescriptionFormat(
        "usd",
        "USD, for Isaac Sim and Newton",
        (".usda", ".usdc", ".usdz", ".usd"),
        heads=(b"#usda", b"PXR-USDC", b"PK\x03\x04"),
        has_several=True,
        targets=("newton", "isaac"),
    ),
)
"""Every format; a file that belongs to no other is URDF."""

NAMES = tuple(one.name for one in DESCRIPTION_FORMATS)
"""Their names."""

ROOTS = {root: one for one in DESCRIPTION_FORMATS for root in one.roots}
"""Formats by the tags of their root elements."""

SUFFIXES = tuple(dict.fromkeys(end for one in DESCRIPTION_FORMATS for end in one.suffixes))
"""Suffixes of every format."""

XML_SUFFIXES = tuple(
    dict.fromkeys(end for one in DESCRIPTION_FORMATS if one.roots for end in one.suffixes)
)
"""Suffixes of the formats that are XML, with ``.xml``."""

OWN_XML_SUFFIXES = tuple(end for end in XML_SUFFIXES if end != ".xml")
"""The same without ``.xml``, by which a file may be anything."""

SEVERAL_SUFFIXES = tuple(
    end for one in DESCRIPTION_FORMATS if one.has_several for end in one.suffixes if end != ".xml"
)
"""Suffixes of files that may have several robots."""


def find_by_head(data: bytes) -> DescriptionFormat | None:
    """Find the format that is not XML of a file, by its first bytes; None for another."""
    known = (one for one in DESCRIPTION_FORMATS if one.heads and data.startswith(one.heads))
    return next(known, None)
