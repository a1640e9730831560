"""The tools that make MJCF or SDF of a URDF, each called as its own help says.

Ours gets the file as it is. The others get a copy whose ``package://`` URIs are paths (see
``robots.resolved``): so what they lose is not for want of a package.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from . import peers
from .robots import options_of
from .timing import URDFTOOL

IMPORT = """
import sys, mujoco
mujoco.mj_saveLastXML(sys.argv[2], mujoco.MjModel.from_xml_path(sys.argv[1]))
"""


@dataclass(frozen=True)
class Converter:
    """A way to convert.

    Attributes:
        name: What the tables call it.
        form: ``sdf`` or ``mjcf``.
        words: The command that writes an output of an input; None where the tool is missing.
        prints: The result is on standard output.
        package: What it is in ``peers``.
    """

    name: str
    form: str
    words: Callable[[Path, Path], list[str] | None]
    prints: bool = False
    package: str = "urdftool"

    @property
    def is_ours(self) -> bool:
        """Whether it is urdftool."""
        return self.package == "urdftool"


def _ours(form: str) -> Callable[[Path, Path], list[str] | None]:
    def words(path: Path, out: Path) -> list[str]:
        return [*URDFTOOL, "-q", "export", form, str(path), "-o", str(out), *options_of(path)]

    return words


def _tool(name: str, *options: str) -> Callable[[Path, Path], list[str] | None]:
    """A command; in its options ``IN``, ``OUT`` and ``FOLDER`` stand for files."""

    def words(path: Path, out: Path) -> list[str] | None:
        found = peers.tool(name)
        if found is None:
            return None
        stand = {"IN": str(path), "OUT": str(out), "FOLDER": str(out.parent / "assets")}
        return [found, *(stand.get(word, word) for word in options)]

    return words


def _mujoco(path: Path, out: Path) -> list[str] | None:
    """MuJoCo looks for meshes by their last name only, unless the file says otherwise."""
    if peers.python() is None or not peers.has("mujoco"):
        return None
    text = path.read_text("utf-8", "replace")
    if "<mujoco" not in text:
        said = r'\g<0><mujoco><compiler strippath="false"/></mujoco>'
        text = re.sub(r"<robot\b[^>]*>", said, text, count=1)
    told = path.with_name(f"{path.stem}.mujoco.urdf")
    told.write_text(text, "utf-8")
    return [peers.python() or "", "-c", IMPORT, str(told), str(out)]


CONVERTERS = (
    Converter("urdftool sdf", "sdf", _ours("sdf")),
    Converter("ign sdf -p", "sdf", _tool("ign", "sdf", "-p", "IN"), prints=True, package="ign sdf"),
    Converter("urdftool mjcf", "mjcf", _ours("mjcf")),
    Converter("MuJoCo's import", "mjcf", _mujoco, package="mujoco"),
    Converter(
        "urdf2mjcf", "mjcf", _tool("urdf2mjcf", "IN", "--output", "OUT", "--copy-meshes"),
        package="urdf2mjcf",
    ),
    Converter(
        "xacrodoc", "mjcf", _tool("xacrodoc", "IN", "--mjcf", "-o", "OUT", "-c", "FOLDER"),
        package="xacrodoc",
    ),
    Converter(
        "scikit-robot", "mjcf", _tool("skr", "convert-urdf-to-mjcf", "IN", "-o", "OUT"),
        package="scikit-robot",
    ),
)  # fmt: skip
