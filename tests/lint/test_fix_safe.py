"""A safe fix changes nothing that an engine loads: kinematics, masses, inertia, shapes, limits.

What an engine could not load before, it may load afterwards. Each rule with a safe fix is tried on
its fixtures and on robots with one defect; the slow tests take all real robots there are.
"""

import re
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.conftest import CORPUS, FIXTURES, XACRO
from tests.lint.engine_views import ENGINES
from tests.lint.fix_safety import Bench
from urdftool.lint.discover import find_descriptions
from urdftool.rules.rule import UNSAFE
from urdftool.rules.table import FIXES

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="waits for pipes")

RULES = FIXTURES / "rules"
SAFE = sorted(rule for rule, traits in FIXES.items() if traits.applicability != UNSAFE)
BAD = sorted(
    path
    for rule in SAFE
    for path in (RULES / rule).glob("bad*.urdf*")
    if path.suffix != ".expected"
)
THERE = [name for name in ENGINES if find_spec(name) is not None]


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    if not THERE:
        pytest.skip("no physics engine is installed")
    made = Bench(tmp_path_factory.mktemp("bench"), THERE)
    yield made
    made.close()


@pytest.mark.parametrize("bad", BAD, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_a_safe_fix_of_a_fixture_changes_nothing(bad, bench, tmp_path, monkeypatch):
    rule = bad.parent.name
    shutil.copytree(RULES / rule, tmp_path / rule, ignore=shutil.ignore_patterns("fixed*"))
    monkeypatch.chdir(tmp_path / rule)
    assert bench.changes_of_fixes(bad.name, [rule])[1] == []


ARM = """<inertial><origin xyz="0 0 1"/><mass value="2"/>\
<inertia ixx="0.2" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.1"/></inertial>\
<collision><origin xyz="0 0 1"/><geometry><box size="0.1 0.1 1"/></geometry></collision>"""
JOINT = """<parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>\
<limit lower="-1" upper="1" effort="1" velocity="1"/>"""
ROBOT = """<?xml version="1.0"?>
<robot name="r">
  <link name="base"><inertial><mass value="1"/>\
<inertia ixx="0.3" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.3"/></inertial>\
<collision><geometry><box size="1 1 0.1"/></geometry></collision></link>
  <link name="arm">{arm}</link>
  <joint name="swing" type="revolute">{joint}</joint>
  <link name="tip"><inertial><mass value="0.1"/>\
<inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial></link>
  <joint name="bend" type="continuous"><parent link="arm"/><child link="tip"/>\
{axle}</joint>
</robot>
"""
AXLE = '<axis xyz="0 0 1"/>'
SEEN = '<visual><geometry><sphere radius="0.1"/></geometry>{}</visual>'
WHOLE = ROBOT.format(arm=ARM, joint=JOINT, axle=AXLE)

DEFECTS = {
    # name: the rule, what stands in the robot, and what stands there instead
    "a type with a capital": ("wrong-case-keyword", '"revolute"', '"Revolute"'),
    "a fixed type with a capital": ("wrong-case-keyword", '"continuous"', '"Fixed"'),
    "a parent with a capital": ("wrong-case-keyword", "<parent", "<Parent"),
    "an inertial with a capital": ("wrong-case-keyword", ARM, ARM.replace("inertial", "Inertial")),
    "a collision with a capital": (
        "wrong-case-keyword",
        ARM,
        ARM.replace("collision", "Collision"),
    ),
    "an origin with a capital": ("wrong-case-keyword", '<origin xyz="0 0 1"/><g', "<Origin/><g"),
    "an axis with a capital": ("wrong-case-keyword", "<axis", "<Axis"),
    "a limit with a capital": ("wrong-case-keyword", "<limit", "<Limit"),
    "a bound with a capital": ("wrong-case-keyword", "lower=", "Lower="),
    "damping in elements": (
        "dynamics-as-child-elements",
        JOINT,
        f"{JOINT}<dynamics><damping>3</damping></dynamics>",
    ),
    "empty dynamics": ("empty-dynamics", JOINT, f"{JOINT}<dynamics/>"),
    "no lower bound": ("limit-without-bounds", 'lower="-1"', ""),
    "no upper bound": ("limit-without-bounds", 'upper="1"', ""),
    "half a limit of a fixed joint": (
        "limit-without-effort-or-velocity",
        '"revolute">' + JOINT,
        '"fixed">' + JOINT.replace('effort="1"', ""),
    ),
    "no axis": ("axis-omitted", '<axis xyz="0 1 0"/>', ""),
    "a long axis": ("axis-not-unit", "0 1 0", "0 0 2"),
    "two equal inertials": ("repeated-element", ARM, ARM + ARM.split("<coll")[0]),
    "two equal origins": (
        "repeated-element",
        '<origin xyz="0 0 1"/><g',
        '<origin xyz="0 0 1"/><origin xyz="0 0 1"/><g',
    ),
    "two equal axes": ("repeated-element", JOINT, f'{JOINT}<axis xyz="0 1 0"/>'),
    "two materials": (
        "repeated-element",
        ARM,
        ARM
        + SEEN.format(
            '<material name="a"><color rgba="1 0 0 1"/></material>'
            '<material name="b"><color rgba="0 1 0 1"/></material>'
        ),
    ),
    "a color of three": (
        "wrong-arity",
        ARM,
        ARM + SEEN.format('<material name="a"><color rgba="1 0 0"/></material>'),
    ),
    "one scale": (
        "wrong-arity",
        '<box size="0.1 0.1 1"/>',
        f'<mesh filename="{RULES}/mesh-case-mismatch/meshes/arm.stl" scale="2"/>',
    ),
    "a mass with a blank": ("not-a-number", 'value="2"', 'value="2 "'),
    "a bound with a blank": ("not-a-number", 'lower="-1"', 'lower="-1 "'),
    "a tab in an origin": ("tab-or-newline-in-vector", '"0 0 1"/><g', '"0\t0\t1"/><g'),
    "a reference to a tab": ("tab-or-newline-in-vector", '"0 0 1"/><g', '"0&#9;0&#x9;1"/><g'),
    "a line in a size": ("tab-or-newline-in-vector", "0.1 0.1 1", "0.1\n0.1 1"),
    "a parent with a blank": ("padded-reference", 'parent link="base"', 'parent link="base "'),
    "a leader with a blank": (
        "padded-reference",
        f"{AXLE}</joint>",
        f'{AXLE}<mimic joint="swing "/></joint>',
    ),
    "a world that is not there": (
        "unknown-parent-link",
        "</robot>",
        '<joint name="fix" type="fixed"><parent link="world"/><child link="base"/></joint></robot>',
    ),
    "a turned axis": ("unknown-attribute", "<axis ", '<axis rpy="0 0 1" '),
    "a pose of nothing": ("unknown-element", ARM, f"{ARM}<pose>0 0 0 0 0 0</pose>"),
    "a material twice": (
        "conflicting-material",
        "</robot>",
        '<material name="a"><color rgba="1 0 0 1"/></material>' * 2 + "</robot>",
    ),
    "a material for nothing": (
        "unused-material",
        "</robot>",
        '<material name="a"><color rgba="1 0 0 1"/></material></robot>',
    ),
    "an empty name of a material": (
        "empty-material-name",
        ARM,
        SEEN.format('<material name=""><color rgba="1 0 0 1"/></material>') + ARM,
    ),
    "no name of a material": (
        "empty-material-name",
        ARM,
        SEEN.format('<material><color rgba="1 0 0 1"/></material>') + ARM,
    ),
    "a frame of no mass": (
        "zero-mass",
        "</robot>",
        '<link name="frame"><inertial><mass value="0"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" '
        'iyz="0" izz="0"/></inertial></link><joint name="f" type="fixed"><parent link="tip"/>'
        '<child link="frame"/></joint></robot>',
    ),
    "a tensor out by rounding": (
        "inertia-triangle-inequality-rounding",
        'izz="0.1"/></inertial><coll',
        'izz="0.4000002"/></inertial><coll',
    ),
    "an inertia with seven numbers": (
        "redundant-inertia-attributes",
        'izz="0.1"',
        'izz="0.1" iyx="0"',
    ),
    "a mimic of a mimic": (
        "mimic-chain",
        f"{AXLE}</joint>",
        f'{AXLE}<mimic joint="swing"/></joint><link name="end"><inertial><mass value="0.1"/>'
        '<inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial></link>'
        '<joint name="twist" type="continuous"><parent link="tip"/><child link="end"/>'
        f'{AXLE}<mimic joint="bend"/></joint>',
    ),
    "a transmission of old": (
        "unprefixed-hardware-interface",
        "</robot>",
        '<transmission name="t"><type>transmission_interface/SimpleTransmission</type>'
        '<joint name="swing"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>'
        '<actuator name="m"/></transmission></robot>',
    ),
    "a shape with a name": (
        "named-geometry-loses-extensions",
        "<collision><or",
        '<collision name="hull"><or',
    ),
}


def _with(name):
    """The robot with a defect."""
    _, there, instead = DEFECTS[name]
    assert there in WHOLE
    return WHOLE.replace(there, instead, 1)


@pytest.mark.parametrize("name", DEFECTS)
def test_a_safe_fix_of_a_defect_changes_nothing(name, bench, write):
    path = write("r.urdf", _with(name))
    assert bench.changes_of_fixes(path, [DEFECTS[name][0]])[1] == []


def test_every_rule_with_a_safe_fix_makes_one(bench, tmp_path, monkeypatch, write):
    """Otherwise nothing would be compared for it."""
    # one needs another rule to find anything; the fixture of one has the other kind of fix
    idle = set(SAFE) - {"unused-suppression", "include-not-found"}
    for bad in BAD:
        rule = bad.parent.name
        if rule in idle:
            there = tmp_path / f"{rule} {bad.name}"
            shutil.copytree(RULES / rule, there, ignore=shutil.ignore_patterns("fixed*"))
            monkeypatch.chdir(there)
            if bench.changes_of_fixes(bad.name, [rule])[0]:
                idle.discard(rule)
    for name, (rule, *_) in DEFECTS.items():
        if rule in idle and bench.changes_of_fixes(write("r.urdf", _with(name)), [rule])[0]:
            idle.discard(rule)
    assert not idle


LARGE = """<xacro:arg name="kind" default="fixed"/>
<xacro:arg name="world" default="world"/>
<xacro:macro name="part" params="name kind *more">
  <link name="${name}"/>
  <joint name="${name}_joint" type="${kind}">
    <parent link="base"/>
    <child link="${name}"/>
    <limit effort="1" velocity="1" lower="-1" upper="1"/>
    <xacro:insert_block name="more"/>
  </joint>
</xacro:macro>
<material name="red"><color rgba="1 0 0 1"/></material>
<material name="red"><color rgba="1 0 0 1"/></material>
<link name="base"/>
<joint name="hold" type="fixed"><parent link="$(arg world)"/><child link="base"/></joint>
<xacro:part name="arm" kind="$(arg kind)"><dynamics damping="1"/></xacro:part>
"""


def test_what_other_arguments_need_stays(write, urdftool):
    """A part that is fixed with these arguments is not fixed with others."""
    path = write("r.urdf.xacro", XACRO.format(LARGE))
    rules = "redundant-on-fixed,axis-omitted,unused-material,conflicting-material"
    words = ("lint", path, "--select", f"{rules},unknown-parent-link", "--exit-zero", "--no-cache")
    assert "redundant-on-fixed" in urdftool(*words).out
    assert "Nothing to fix." in urdftool(*words, "--fix").err
    assert Path(path).read_text() == XACRO.format(LARGE)
    again = urdftool(*words, "kind:=revolute", "world:=base", "--fix")
    assert "axis-omitted" in again.out
    assert Path(path).read_text() == XACRO.format(LARGE)


@pytest.mark.parametrize(
    ("there", "instead"),
    [
        ('<mass value="2"/>', '<mass value="2.001"/>'),
        ('ixx="0.2"', 'ixx="0.2001"'),
        ('upper="1"', 'upper="1.001"'),
        ('<axis xyz="0 1 0"/>', '<axis xyz="0 -1 0"/>'),
        ("0.1 0.1 1", "0.1 0.1 1.001"),
        ('xyz="0 0 1"/><g', 'xyz="0 0.001 1"/><g'),
    ],
    ids=["mass", "inertia", "limit", "axis", "size", "place"],
)
def test_a_change_is_seen_by_every_engine(there, instead, bench, write):
    assert there in WHOLE
    path = write("r.urdf", WHOLE)
    changed = {path: WHOLE.replace(there, instead, 1).encode()}
    seen = bench.changes(path, {}, changed)
    assert {re.split("[ :]", what)[0] for what in seen} == set(THERE), seen
    assert bench.changes(path, {}, {path: WHOLE.encode()}) == []


@pytest.mark.parametrize(
    ("name", "seen"),
    [
        ("an inertial with a capital", {"pinocchio", "pybullet", "mujoco"}),
        ("a long axis", {"pybullet"}),
        ("no upper bound", {"pybullet", "mujoco"}),
        ("damping in elements", {"mujoco"}),
        ("a mass with a blank", {"pinocchio"}),
        ("a tab in an origin", {"pinocchio", "pybullet"}),
        ("a leader with a blank", {"mujoco"}),
        ("a tensor out by rounding", {"pybullet"}),
        ("a mimic of a mimic", {"mujoco"}),
    ],
)
def test_why_a_fix_is_unsafe(name, seen, bench, write):
    """What the engines load differently after fixes that look as if they were safe."""
    path = write("r.urdf", _with(name))
    applied, what = bench.changes_of_fixes(path, [DEFECTS[name][0]], unsafe=True)
    assert applied == {DEFECTS[name][0]: 1}
    assert {re.split("[ :]", one)[0] for one in what} == seen & set(THERE), what


def _robots_of(package, *inner):
    found = find_spec(package)
    if found is None:
        return None
    origin = found.origin or next(iter(found.submodule_search_locations))
    folder = Path(origin).parent.joinpath(*inner)
    return folder if folder.is_dir() else None


def _example_robots():
    found = find_spec("pinocchio")
    if found is None or found.origin is None:
        return None
    inner = ("share", "example-robot-data", "robots")
    places = (up.joinpath(*inner) for up in Path(found.origin).parents)
    return next((place for place in places if place.is_dir()), None)


SOURCES = {
    "example-robot-data": _example_robots,
    "pybullet_data": lambda: _robots_of("pybullet_data"),
    "corpus": lambda: CORPUS if CORPUS.is_dir() else None,
}
LEAST = {"example-robot-data": 40, "pybullet_data": 20, "corpus": 35}
"""How many robots have a safe fix that some engine loads before and after it, at least."""


@pytest.mark.slow
@pytest.mark.parametrize("source", SOURCES)
def test_safe_fixes_change_no_real_robot(source, bench, monkeypatch):
    folder = SOURCES[source]()
    if folder is None:
        pytest.skip(f"{source} is not here")
    monkeypatch.chdir(folder)
    paths = find_descriptions(["."])
    many = [path for path in paths if "random_urdfs" in path]
    paths = [path for path in paths if "random_urdfs" not in path] + many[::100]
    changed, compared = {}, 0
    for path in paths:
        before = sum(bench.compared.values())
        applied, seen = bench.changes_of_fixes(path, SAFE)
        compared += bool(applied) and sum(bench.compared.values()) > before
        if seen:
            changed[path] = seen, dict(applied)
    assert changed == {}
    assert compared >= LEAST[source]
