"""Declared correspondence of two robots: what one is, expressed by the other.

A file for ``verify --map`` has names that belong together, and may declare in addition how the
second robot was made of the first::

    root    base_link  tool0                   # the first robot, taken from link tool0
    joint   j4  j4  sign -1  zero 0.5          # position in B = sign · position in A + zero
    mirror  xz                                 # B is the mirror image of A
    frame   wrist  xyz 0 0 0.1  rpy 0 0 0      # link frame of B in that of A, at the same body
    merged  base_link  imu_link camera_mount   # links of A that are part of base_link in B
    removed gripper_base                       # the branch of A from that link is not in B
    added   gripper_base                       # the branch of B from that link is not in A
    mount   g_base tool0  xyz 0 0 0.1  rpy 0 0 0  # a fixed joint of B carries g_base
    branch  base  g_base                       # A, from link base, is the branch of B from g_base
    tolerance 1e-7                             # numbers of B are rounded
    part    arm_system  l_arm_system           # a transmission, hardware component or the like
    setting self_collide true                  # a <gazebo> setting of the whole robot in B
    image   xz link l_hand r_hand              # B also has a mirror image of a link, joint, part
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from ..errors import ConfigError
from ..model.settings import OF_ROBOT
from .names import Line, read_lines

Words = Sequence[str]

PLANES = {"yz": 0, "xz": 1, "xy": 2}
"""Coordinate that the reflection at each plane negates."""

_FLAGS = tuple(row.name for row in OF_ROBOT if row.kind == "flag")


class JointValue(NamedTuple):
    """Position of a joint in B: ``sign`` times that in A, plus ``zero`` [rad, m]."""

    joint: str
    sign: float
    zero: float


class FrameMove(NamedTuple):
    """Link frame of B in that of A: ``xyz`` [m], ``rpy`` [rad] of URDF."""

    link: str
    xyz: tuple[float, float, float]
    rpy: tuple[float, float, float]


class Mount(NamedTuple):
    """Link of B that a fixed joint carries: its parent, and its pose there [m, rad]."""

    link: str
    parent: str
    xyz: tuple[float, float, float]
    rpy: tuple[float, float, float]


class Image(NamedTuple):
    """Mirror image that B has in addition: plane, kind, name of the original and of the image."""

    plane: str
    kind: str
    name: str
    image: str


class Correspondence(NamedTuple):
    """What a file for ``verify --map`` holds.

    Attributes:
        names: Names that belong together: ``joint`` or ``link``, and one in each robot.
        root: New root among the links of A; empty for the same.
        values: Joints whose position has another sign or zero; names of A.
        mirror: Plane of the reflection; empty for none.
        frames: Link frames that moved in their bodies; names of A.
        merged: Links of A that became part of another one, by that link.
        removed: Links of A whose branches B does not have.
        added: Links of B whose branches A does not have.
        branch: Links of A and B from which the robots are compared; empty for the roots.
        mounts: Links of B that fixed joints carry, which A does not have.
        images: Mirror images of parts of A that B has in addition.
        settings: Settings of the whole robot in B, by the names of ``settings.OF_ROBOT``.
        tolerance: Tolerance of numbers that were rounded; 0 for that of the rows.
        is_declared: Whether anything but names is declared.
    """

    names: Sequence[Line] = ()
    root: str = ""
    values: Sequence[JointValue] = ()
    mirror: str = ""
    frames: Sequence[FrameMove] = ()
    merged: Sequence[tuple[str, tuple[str, ...]]] = ()
    removed: Sequence[str] = ()
    added: Sequence[str] = ()
    branch: tuple[str, str] = ("", "")
    mounts: Sequence[Mount] = ()
    images: Sequence[Image] = ()
    settings: Sequence[tuple[str, bool]] = ()
    tolerance: float = 0.0
    is_declared: bool = False

    @property
    def merged_links(self) -> dict[str, str]:
        """Return the link that a link of A became a part of, by name."""
        return {name: into for into, names in self.merged for name in names}


class _MalformedError(Exception):
    """A line has another form than its kind requires."""


def read_correspondence(path: Path, count: int) -> Correspondence:
    """Read a file for ``verify --map``.

    Args:
        path: The file.
        count: Number of robots; declarations require two.

    Raises:
        ConfigError: The file cannot be read, or a line has another form.
    """
    return parse_correspondence(read_lines(path), count, path)


def parse_correspondence(
    lines: Sequence[tuple[int, Words]], count: int, path: Path | None = None
) -> Correspondence:
    """Parse the lines of a correspondence; see :func:`read_correspondence`."""
    correspondence = Correspondence()
    for number, words in lines:
        reader = _READERS.get(words[0])
        if words[0] in ("joint", "link", "part") and len(words) == count + 1:
            correspondence = correspondence._replace(
                names=[*correspondence.names, (words[0], tuple(words[1:]))]
            )
            continue
        try:
            if reader is None:
                raise _MalformedError
            if count != 2:
                raise ConfigError(
                    f"line {number} declares how one robot was made of the other, which requires "
                    f"two robots, not {count}",
                    path=path,
                )
            correspondence = reader(correspondence, words[1:])._replace(is_declared=True)
        except _MalformedError:
            raise ConfigError(
                f"line {number} is not {_describe(words[0], count)}", path=path
            ) from None
    return correspondence


def _describe(kind: str, count: int) -> str:
    names = " ".join("ABCDEFGH"[:count])
    if kind in _FORMS and (kind != "joint" or count == 2):
        other = f"'joint {names}', names in each robot, nor " if kind == "joint" else ""
        return f"{other}'{_FORMS[kind]}'"
    return f"'joint {names}' or 'link {names}', names in each robot"


def _read_root(found: Correspondence, words: Words) -> Correspondence:
    if len(words) != 2 or found.root:
        raise _MalformedError
    return found._replace(root=words[1])


def _read_value(found: Correspondence, words: Words) -> Correspondence:
    if len(words) not in (4, 6):
        raise _MalformedError
    options = dict(zip(words[2::2], map(_read_number, words[3::2]), strict=True))
    sign, zero = options.pop("sign", 1.0), options.pop("zero", 0.0)
    if options or abs(sign) != 1.0:
        raise _MalformedError
    names = [*found.names, ("joint", (words[0], words[1]))]
    return found._replace(names=names, values=[*found.values, JointValue(words[0], sign, zero)])


def _read_mirror(found: Correspondence, words: Words) -> Correspondence:
    if len(words) != 1 or words[0] not in PLANES or found.mirror:
        raise _MalformedError
    return found._replace(mirror=words[0])


def _read_frame(found: Correspondence, words: Words) -> Correspondence:
    if len(words) != 9 or words[1] != "xyz" or words[5] != "rpy":
        raise _MalformedError
    x, y, z, roll, pitch, yaw = map(_read_number, [*words[2:5], *words[6:9]])
    move = FrameMove(words[0], (x, y, z), (roll, pitch, yaw))
    return found._replace(frames=[*found.frames, move])


def _read_mount(found: Correspondence, words: Words) -> Correspondence:
    if len(words) != 10 or words[2] != "xyz" or words[6] != "rpy":
        raise _MalformedError
    x, y, z, roll, pitch, yaw = map(_read_number, [*words[3:6], *words[7:10]])
    mount = Mount(words[0], words[1], (x, y, z), (roll, pitch, yaw))
    return found._replace(mounts=[*found.mounts, mount])


def _read_image(found: Correspondence, words: Words) -> Correspondence:
    if len(words) != 4 or words[0] not in PLANES or words[1] not in ("link", "joint", "part"):
        raise _MalformedError
    if found.images and found.images[0].plane != words[0]:
        raise _MalformedError
    return found._replace(images=[*found.images, Image(*words)])


def _read_setting(found: Correspondence, words: Words) -> Correspondence:
    if len(words) != 2 or words[0] not in _FLAGS or words[1] not in ("true", "false"):
        raise _MalformedError
    return found._replace(settings=[*found.settings, (words[0], words[1] == "true")])


def _read_merged(found: Correspondence, words: Words) -> Correspondence:
    if len(words) < 2:
        raise _MalformedError
    return found._replace(merged=[*found.merged, (words[0], tuple(words[1:]))])


def _read_removed(found: Correspondence, words: Words) -> Correspondence:
    if len(words) != 1:
        raise _MalformedError
    return found._replace(removed=[*found.removed, words[0]])


def _read_added(found: Correspondence, words: Words) -> Correspondence:
    if len(words) != 1:
        raise _MalformedError
    return found._replace(added=[*found.added, words[0]])


def _read_branch(found: Correspondence, words: Words) -> Correspondence:
    if len(words) != 2 or any(found.branch):
        raise _MalformedError
    return found._replace(branch=(words[0], words[1]))


def _read_number(word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        raise _MalformedError from None
    if not math.isfinite(value):
        raise _MalformedError
    return value


def _read_tolerance(found: Correspondence, words: Words) -> Correspondence:
    if len(words) != 1 or not 0.0 < _read_number(words[0]) < 1.0:
        raise _MalformedError
    return found._replace(tolerance=_read_number(words[0]))


_READERS: dict[str, Callable[[Correspondence, Words], Correspondence]] = {
    "root": _read_root,
    "joint": _read_value,
    "mirror": _read_mirror,
    "frame": _read_frame,
    "merged": _read_merged,
    "removed": _read_removed,
    "added": _read_added,
    "branch": _read_branch,
    "tolerance": _read_tolerance,
    "mount": _read_mount,
    "image": _read_image,
    "setting": _read_setting,
}

_FORMS = {
    "root": "root OLD_ROOT NEW_ROOT",
    "joint": "joint A B sign 1|-1 zero V",
    "mirror": "mirror xy|xz|yz",
    "frame": "frame LINK xyz X Y Z rpy R P Y",
    "merged": "merged LINK MERGED_LINK ...",
    "removed": "removed LINK",
    "added": "added LINK",
    "branch": "branch LINK_OF_A LINK_OF_B",
    "tolerance": "tolerance T",
    "mount": "mount LINK PARENT xyz X Y Z rpy R P Y",
    "image": "image PLANE link|joint|part NAME IMAGE",
    "setting": "setting NAME true|false",
}
