"""``python -m measure.damage.safe_fixes [COUNT [SEED [FOLDER…]]]``: before and after ``--fix``.

Defects with a safe fix are planted in real robots: those of example-robot-data, pybullet_data and
the corpus, or those below the folders. Each robot is compared before and after its own safe fixes,
and those of each planted defect: as ``verify`` compares two robots, with frames of sensors and
parameters of plugins, and by the text of exports to SDF and MJCF. A difference counts as stated if
it is one that the fixes of the rule state (``STATED``).
"""

from __future__ import annotations

import os
import random
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from measure.precision.__main__ import descriptions, descriptions_below
from urdftool.api.export import export_mjcf, export_sdf
from urdftool.api.verify import verify
from urdftool.errors import UrdftoolError
from urdftool.formats.written import Written
from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings
from urdftool.model.elements import Robot
from urdftool.model.load import make_robot
from urdftool.source.description import read_description
from urdftool.workspace import Workspace

MOST = 150_000
"""Bytes of the largest robot that is tried: chosen, so that exports take seconds."""

STATED = {
    # rule: row of ``verify``, and what differs; what readers did not read, or read wrongly, before
    "bad-extension-number": {("surface", "second friction")},
    "empty-material-name": {("MJCF", "")},  # its name, not its color
    "malformed-uri": {("SDF", ""), ("MJCF", ""), ("visuals", "visual")},  # the mesh is found
    "mesh-case-mismatch": {("visuals", "visual")},
    "missing-gazebo-material": {("looks", "ambient"), ("simulator data", "visual added"),
                                ("simulator data", "visual/material added"),
                                ("simulator data", "visual/material/ambient"),
                                ("simulator data", "visual/material/diffuse")},
    "missing-gz-frame-id": {("sensors", "frame")},
    "ogre-material-script": {("simulator data", "material"), ("looks", "material script"),
                             ("simulator data", "gazebo[] added")},
    "plugin-class-mismatch": {("simulator data", "plugin")},
    "redundant-inertia-attributes": {("simulator data", f"inertial/inertia/@{name}")
                                     for name in ("iyx", "izx", "izy")},
    "ros2-control-nested": {("simulator data", "existence")},
    "unknown-attribute": {("simulator data", "axis/@rpy")},
    "unknown-element": {("colors", "color of visual"),  # a material is moved where it is read
                        ("simulator data", "visual/geometry/material[] removed"),
                        ("simulator data", "visual/geometry/material[]/color removed"),
                        ("simulator data", "visual/geometry/material[]/color/@rgba")},
    "unprefixed-hardware-interface": {("simulator data", "joint[]/hardwareInterface")},
    "wrong-arity": {("colors", "color of visual")},
    "wrong-case-keyword": {("tree", "type")},
}  # fmt: skip
"""What the message of a rule with a safe fix states; the tests of its fixtures use it, too."""

Plant = Callable[[Element, random.Random], bool]


def _pick(root: Element, path: str, chance: random.Random) -> Element | None:
    found = root.findall(path)
    return chance.choice(found) if found else None


def _change(path: str, edit: Callable[[Element], object]) -> Plant:
    """Plant a defect in a random element of a path."""

    def plant(root: Element, chance: random.Random) -> bool:
        found = _pick(root, path, chance)
        if found is not None:
            edit(found)
        return found is not None

    return plant


def _set(path: str, name: str, value: str) -> Plant:
    """Plant an attribute."""
    return _change(path, lambda found: found.set(name, value))


def _pad(path: str, name: str) -> Plant:
    """Plant a blank behind a name."""
    return _change(path, lambda found: found.set(name, f"{found.get(name, '')} "))


def _add(path: str, text: str) -> Plant:
    """Plant an element."""
    return _change(path, lambda found: found.append(ElementTree.fromstring(text)))


def _omit_axis(root: Element, chance: random.Random) -> bool:
    found = [
        (joint, axis)
        for joint in root.findall("joint")
        for axis in joint.findall("axis")
        if [*map(float, axis.get("xyz", "").split())] == [1, 0, 0]
    ]
    if found:
        joint, axis = chance.choice(found)
        joint.remove(axis)
    return bool(found)


def _repeat_mass(root: Element, chance: random.Random) -> bool:
    found = _pick(root, "link/inertial", chance)
    mass = found.find("mass") if found is not None else None
    if mass is None:
        return False
    found.append(Element("mass", dict(mass.attrib)))
    return True


def _repeat_material(root: Element, chance: random.Random) -> bool:
    found = _pick(root, "material[@name]", chance)
    if found is not None:
        root.append(ElementTree.fromstring(ElementTree.tostring(found)))
    return found is not None


def _write_one_slash(root: Element, chance: random.Random) -> bool:
    found = [m for m in root.iter("mesh") if m.get("filename", "").startswith("package://")]
    if found:
        mesh = chance.choice(found)
        mesh.set("filename", mesh.get("filename", "").replace("package://", "package:/"))
    return bool(found)


def _add_camera(root: Element, chance: random.Random) -> bool:
    link = _pick(root, "link[inertial]", chance)
    if link is None:
        return False
    block = SubElement(root, "gazebo", reference=link.get("name", ""))
    sensor = SubElement(block, "sensor", name="planted", type="imu")
    SubElement(sensor, "update_rate").text = "50"
    return True


_PUBLISHER = (
    '<gazebo><plugin name="states" filename="gz-sim-joint-state-publisher-system">'
    "<topic>states</topic></plugin></gazebo>"
)
_TRANSMISSION = (
    '<transmission name="planted"><type>transmission_interface/SimpleTransmission</type>'
    '<joint name="{0}"><hardwareInterface>PositionJointInterface</hardwareInterface></joint>'
    '<actuator name="planted_motor"><mechanicalReduction>1</mechanicalReduction></actuator>'
    "</transmission>"
)


def _add_transmission(root: Element, chance: random.Random) -> bool:
    joint = _pick(root, "joint[limit]", chance)
    if joint is not None:
        root.append(ElementTree.fromstring(_TRANSMISSION.format(joint.get("name"))))
    return joint is not None


KINDS: dict[str, Plant] = {
    "axis-omitted": _omit_axis,
    "bad-extension-number": _add(".", '<gazebo reference="{link}"><mu2>0.7d</mu2></gazebo>'),
    "deprecated-cfm-damping": _add(
        ".", '<gazebo reference="{joint}"><cfmDamping>true</cfmDamping></gazebo>'
    ),
    "empty-dynamics": _add("joint[limit]", "<dynamics/>"),
    "empty-material-name": _add(
        "link/visual", '<material name=""><color rgba="0.8 0.6 0.2 1"/></material>'
    ),
    "malformed-uri": _write_one_slash,
    "missing-gz-frame-id": _add_camera,
    "padded-reference": _pad("joint/parent", "link"),
    "plugin-class-mismatch": _add(".", _PUBLISHER),
    "redundant-inertia-attributes": _set("link/inertial/inertia[@ixy='0']", "iyx", "0"),
    "redundant-on-fixed": _add("joint[@type='fixed']", '<dynamics damping="0"/>'),
    "repeated-element": _repeat_mass,
    "conflicting-material": _repeat_material,
    "unknown-attribute": _set("joint/axis", "rpy", "0 0 0.5"),
    "unprefixed-hardware-interface": _add_transmission,
    "unused-material": _add(
        ".", '<material name="planted"><color rgba="0.8 0.6 0.2 1"/></material>'
    ),
    "wrong-arity": _add(
        "link/visual", '<material name="planted_too"><color rgba="0.6 0.6 0.7"/></material>'
    ),
    "wrong-case-keyword": _set("joint[@type='revolute']", "type", "Revolute"),
}
"""Defects by the rule whose safe fix is expected."""


@dataclass
class Compared:
    """Comparison of one robot before and after its safe fixes.

    Attributes:
        applied: Applied fixes by rule.
        stated: Differences that the fixes state.
        unstated: Other differences.
    """

    applied: Counter[str]
    stated: list[tuple[str, str]]
    unstated: list[tuple[str, str]]


def plant(text: str, kind: str, chance: random.Random) -> str | None:
    """Plant one defect; None if the robot has no place for it."""
    root = ElementTree.fromstring(text)
    if not KINDS[kind](root, chance):
        return None
    damaged = ElementTree.tostring(root, encoding="unicode")
    for word, path in (("{link}", "link[collision]"), ("{joint}", "joint[limit]")):
        found = _pick(root, path, chance) if word in damaged else None
        if word in damaged and found is None:
            return None
        damaged = damaged.replace(word, found.get("name", "") if found is not None else "")
    return damaged


def compare(path: str, text: str, rule: str = "") -> Compared | None:
    """Fix a robot and compare it.

    Args:
        path: Its path, next to which its meshes are.
        text: Its text, read in place of the file.
        rule: The only rule whose fixes are applied; empty for all.

    Returns:
        The comparison; None if nothing was fixed, or a robot cannot be read.
    """
    before = Workspace({path: text.encode()})
    settings = Settings(select=(rule,)) if rule else Settings()
    options = Options(settings, fixes=True, workspace=before)
    done = fix_description(check_file(path, options), options)
    if not done.after:
        return None
    try:
        robots = [_load(path, before), _load(path, Workspace({path: text.encode(), **done.after}))]
        found = verify(*robots).list_disagreements()
    except UrdftoolError:
        return None
    differences = {(one.row, remove_names(one.what)) for one in found}
    for name, export in (("SDF", export_sdf), ("MJCF", export_mjcf)):
        one, other = (_write(robot, export) for robot in robots)
        if one != other:
            differences.add((name, _describe(one, other)))
    allowed = set().union(*(STATED.get(applied, set()) for applied in done.applied))
    exports = {("SDF", ""), ("MJCF", "")} if allowed else set()
    stated = {one for one in differences if {one, (one[0], "")} & (allowed | exports)}
    return Compared(done.applied, sorted(stated), sorted(differences - stated))


def remove_names(what: str) -> str:
    """Remove names of parts from what differs: ``joint[swing]/type`` becomes ``joint[]/type``."""
    return re.sub(r"\[[^]]*\]", "[]", what)


def _load(path: str, workspace: Workspace) -> Robot:
    return make_robot(read_description(path, workspace=workspace))


def _write(robot: Robot, export: Callable[..., Written]) -> str:
    """Return the text of an export without comments, or the refusal."""
    try:
        text = export(robot, force=True).text
    except UrdftoolError as error:
        return type(error).__name__
    return re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)


def _describe(one: str, other: str) -> str:
    """Return the first lines in which two exports differ."""
    changes = [*unified_diff(one.splitlines(), other.splitlines(), n=0)][3:]
    return " | ".join(" ".join(line.split())[:60] for line in changes[:3])


def list_robots(folders: Sequence[str] = ()) -> dict[str, str]:
    """List the URDF files that are robots: real path by name."""
    named = descriptions_below(list(folders), True) if folders else descriptions(True)
    found = {name: os.path.realpath(path) for name, path in named.items() if path.endswith(".urdf")}
    return {name: path for name, path in found.items() if os.path.getsize(path) < MOST}


def try_robot(path: str, kinds: Sequence[str], chance: random.Random) -> Iterator[Compared]:
    """Compare a robot with its own defects, then with each planted one."""
    try:
        text = Path(path).read_text("utf-8")
        damaged = [("", text), *((kind, plant(text, kind, chance)) for kind in kinds)]
    except (ElementTree.ParseError, UnicodeDecodeError, ValueError):
        return
    for kind, one in damaged:
        found = compare(path, one, kind) if one is not None else None
        if found is not None:
            yield found


def main(count: int = 60, seed: int = 0, folders: Sequence[str] = ()) -> None:
    named = list_robots(folders)
    chance = random.Random(seed)
    totals, applied = Counter[str](), Counter[str]()
    for name in chance.sample(sorted(named), len(named)):
        if totals["robots"] == count:
            break
        kinds = chance.sample(sorted(KINDS), 4)
        found = list(try_robot(named[name], kinds, chance))
        totals["robots" if found else "robots without a safe fix, or not read"] += 1
        for one in found:
            totals["comparisons"] += 1
            totals["stated differences"] += len(one.stated)
            totals["other differences"] += len(one.unstated)
            applied += one.applied
            for what in one.unstated:
                print(f"  {name} {dict(one.applied)}: {what}", flush=True)
    print(dict(totals))
    print(f"{applied.total()} fixes of {len(applied)} rules: {dict(applied)}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:3]), folders=sys.argv[3:])
