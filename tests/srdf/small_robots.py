"""Robots of a few lines: each is a joint, ``parent > child type``, with what follows it."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path
from xml.sax.saxutils import quoteattr

from urdftool.model.elements import Robot
from urdftool.model.load import load

_END = re.compile(r"(.+?) (fixed|revolute|prismatic|continuous|planar|floating)((?: \S+)*)")

INERTIAL = (
    '<inertial><origin xyz="0 0 0.1"/><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    '<collision><geometry><box size="0.02 0.02 0.02"/></geometry></collision>'
)


def write_urdf(lines: str, name: str = "robot", bare: Collection[str] = (), more: str = "") -> str:
    """Write a URDF.

    Args:
        lines: A joint a line: ``JOINT: PARENT > CHILD TYPE [xyz=…] [limit=LOWER,UPPER]
        [mimic=JOINT,MULTIPLIER] [axis=…]``.
        name: Name of the robot.
        bare: Names of the links without geometry.
        more: Further elements.
    """
    links: dict[str, None] = {}
    joints = []
    for line in filter(None, map(str.strip, lines.splitlines())):
        joint, _, rest = line.partition(": ")
        parent, _, rest = rest.partition(" > ")
        match = _END.fullmatch(rest)
        assert match is not None, line
        child, kind, options = match[1], match[2], match[3].split()
        links |= {parent: None, child: None}
        joints.append(_write_joint(joint, parent, child, kind, options))
    written = [
        f"<link name={quoteattr(link)}>{'' if link in bare else INERTIAL}</link>" for link in links
    ]
    return "\n".join(
        [f"<robot name={quoteattr(name)}>", *written, *joints, *filter(None, [more]), "</robot>"]
    )


def _write_joint(name: str, parent: str, child: str, kind: str, options: list[str]) -> str:
    given = dict(option.split("=") for option in options)
    inner = f'<origin xyz="{given.get("xyz", "0,0,0.2").replace(",", " ")}"/>'
    inner += f"<parent link={quoteattr(parent)}/><child link={quoteattr(child)}/>"
    if kind != "fixed":
        inner += f'<axis xyz="{given.get("axis", "0,0,1").replace(",", " ")}"/>'
    if kind in ("revolute", "prismatic"):
        lower, upper = given.get("limit", "-1.5,1.5").split(",")
        inner += f'<limit lower="{lower}" upper="{upper}" effort="10" velocity="2"/>'
    if "mimic" in given:
        leader, multiplier = given["mimic"].split(",")
        inner += f'<mimic joint="{leader}" multiplier="{multiplier}"/>'
    return f"<joint name={quoteattr(name)} type={quoteattr(kind)}>{inner}</joint>"


def load_lines(folder: Path, lines: str, **options: object) -> Robot:
    """Load a robot from its lines."""
    path = folder / "robot.urdf"
    path.write_text(write_urdf(lines, **options), encoding="utf-8")  # type: ignore[arg-type]
    return load(path)


ARM = """
j1: base > l1 revolute
j2: l1 > l2 revolute
j3: l2 > l3 revolute
tool: l3 > tool0 fixed
"""

FINGERS = """
mount: tool0 > palm fixed
left: palm > left_tip prismatic xyz=0,0.01,0 axis=0,1,0 limit=0,0.04
right: palm > right_tip prismatic xyz=0,-0.01,0 axis=0,-1,0 limit=0,0.04 mimic=left,1
"""

WHEELS = """
wl: base > wheel_left continuous
wr: base > wheel_right continuous
"""


def prefix_lines(lines: str, prefix: str, keep: Collection[str] = ()) -> str:
    """Add a prefix to the names of the joints and links of some lines."""
    renamed = []
    for line in filter(None, map(str.strip, lines.splitlines())):
        joint, _, rest = line.partition(": ")
        parent, _, rest = rest.partition(" > ")
        rest = rest.replace("mimic=", f"mimic={prefix}")
        parent = parent if parent in keep else prefix + parent
        renamed.append(f"{prefix}{joint}: {parent} > {prefix}{rest}")
    return "\n".join(renamed)
