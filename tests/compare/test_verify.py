"""Comparison of one robot in URDF, SDF and MJCF, which were written by hand."""

import json

import jsonschema
import pytest

from tests.conftest import ROOT
from urdftool.compare.compare import compare_robots
from urdftool.compare.names import match_names
from urdftool.compare.rows import select_rows
from urdftool.formats.registry import format_named

URDF = """<robot name="arm">
<link name="base"><inertial><mass value="4"/>
<inertia ixx="0.4" ixy="0" ixz="0" iyy="0.5" iyz="0" izz="0.6"/></inertial>
<collision><geometry><box size="0.2 0.3 0.1"/></geometry></collision></link>
<link name="plate"><inertial><mass value="0.5"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.025"/></inertial></link>
<joint name="fix" type="fixed"><parent link="base"/><child link="plate"/>
<origin xyz="0 0 0.05"/></joint>
<link name="upper"><inertial><origin xyz="0 0.1 0.2"/><mass value="2"/>
<inertia ixx="0.02" ixy="0.001" ixz="0" iyy="0.03" iyz="0" izz="0.04"/></inertial>
<collision><origin xyz="0 0 0.2"/><geometry><cylinder radius="0.05" length="0.4"/></geometry>
</collision></link>
<joint name="shoulder" type="revolute"><parent link="plate"/><child link="upper"/>
<origin xyz="0.1 0 0.02" rpy="0 0 0.5"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="2" effort="30" velocity="3"/><dynamics damping="0.7" friction="0.1"/>
</joint>
<link name="tip"><inertial><mass value="1"/>
<inertia ixx="0.001" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.0025"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="upper"/><child link="tip"/>
<origin xyz="0 0 0.4"/><axis xyz="0 0 1"/><limit lower="0" upper="0.2" effort="9" velocity="1"/>
</joint></robot>
"""

SDF = """<sdf version="1.9"><model name="other">
<link name="base"><inertial><mass>4</mass>
<inertia><ixx>0.4</ixx><iyy>0.5</iyy><izz>0.6</izz></inertia></inertial>
<collision name="c"><geometry><box><size>0.2 0.3 0.1</size></box></geometry></collision></link>
<link name="plate"><pose>0 0 0.05 0 0 0</pose><inertial><mass>0.5</mass>
<inertia><ixx>0.01</ixx><iyy>0.02</iyy><izz>0.025</izz></inertia></inertial></link>
<joint name="fix" type="fixed"><parent>base</parent><child>plate</child></joint>
<link name="upper"><pose>0.1 0 0.07 0 0 0.5</pose>
<inertial><pose>0 0.1 0.2 0 0 0</pose><mass>2</mass>
<inertia><ixx>0.02</ixx><ixy>0.001</ixy><iyy>0.03</iyy><izz>0.04</izz></inertia></inertial>
<collision name="c"><pose>0 0 0.2 0 0 0</pose>
<geometry><cylinder><radius>0.05</radius><length>0.4</length></cylinder></geometry></collision>
</link>
<joint name="shoulder" type="revolute"><parent>plate</parent><child>upper</child>
<axis><xyz>0 1 0</xyz><limit><lower>-1</lower><upper>2</upper><effort>30</effort>
<velocity>3</velocity></limit><dynamics><damping>0.7</damping><friction>0.1</friction></dynamics>
</axis></joint>
<link name="tip"><pose relative_to="upper">0 0 0.4 0 0 0</pose><inertial><mass>1</mass>
<inertia><ixx>0.001</ixx><iyy>0.002</iyy><izz>0.0025</izz></inertia></inertial></link>
<joint name="slide" type="prismatic"><parent>upper</parent><child>tip</child>
<axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>0.2</upper><effort>9</effort>
<velocity>1</velocity></limit></axis></joint>
</model></sdf>
"""

MJCF = """<mujoco model="third"><compiler angle="radian" autolimits="true"/><worldbody>
<body name="base" pos="3 4 5"><freejoint/>
<inertial pos="0 0 0.005555555555555556" mass="4.5"
 fullinertia="0.4111111111111111 0.5211111111111111 0.625 0 0 0"/>
<geom type="box" size="0.1 0.15 0.05" group="3" mass="0"/>
<body name="upper" pos="0.1 0 0.07" euler="0 0 0.5">
<inertial pos="0 0.1 0.2" mass="2" fullinertia="0.02 0.03 0.04 0.001 0 0"/>
<joint name="shoulder" axis="0 1 0" range="-1 2" damping="0.7" frictionloss="0.1"
 actuatorfrcrange="-30 30"/>
<geom type="cylinder" size="0.05 0.2" pos="0 0 0.2" group="3" mass="0"/>
<body name="tip" pos="0 0 0.4">
<inertial pos="0 0 0" mass="1" diaginertia="0.001 0.002 0.0025"/>
<joint name="slide" type="slide" axis="0 0 1" range="0 0.2" actuatorfrcrange="-9 9"/>
</body></body></body></worldbody></mujoco>
"""

mujoco = pytest.mark.library("mujoco")
TEXTS = {"urdf": URDF, "sdf": SDF, "mjcf": MJCF}
FORMATS = ["urdf", "sdf", pytest.param("mjcf", marks=mujoco)]


def read(write, name, text):
    return format_named(name).read(write(f"{name}{len(text)}.xml", text)).robot


@pytest.fixture(scope="module")
def robots(tmp_path_factory):
    """Read the unchanged robot in a format, once."""
    folder, found = tmp_path_factory.mktemp("robots"), {}

    def get(name):
        if name not in found:
            path = folder / f"{name}.xml"
            path.write_text(TEXTS[name])
            found[name] = format_named(name).read(path).robot
        return found[name]

    return get


@pytest.mark.parametrize("other", FORMATS)
@pytest.mark.parametrize("first", FORMATS)
def test_one_robot_in_three_formats_is_equal(robots, first, other):
    comparison = compare_robots(robots(first), robots(other))
    assert not [d for d in comparison.differences if not d.is_convention]
    assert comparison.is_equal
    assert set(comparison.joints) == {"shoulder", "slide"}
    assert ("base" in comparison.skipped) == ("urdf" in (first, other))
    assert ("simulator data" in comparison.skipped) == ((first, other) != ("urdf", "urdf"))
    assert ("contact pairs" in comparison.skipped) == (first != other or first == "urdf")


CHANGES = [
    ("mass", '"2"/>\n<inertia ixx="0.02"', '"2.02"/>\n<inertia ixx="0.02"', "upper", "mass"),
    ("frames", 'xyz="0.1 0 0.02"', 'xyz="0.101 0 0.02"', "shoulder", "origin"),
    ("frames", 'rpy="0 0 0.5"', 'rpy="0 0 0.52"', "shoulder", "origin"),
    ("axes", 'axis xyz="0 1 0"', 'axis xyz="0 -1 0"', "shoulder", "axis"),
    ("axes", 'axis xyz="0 1 0"', 'axis xyz="0.02 1 0"', "shoulder", "axis"),
    ("inertia", 'ixx="0.02" ixy="0.001"', 'ixx="0.02" ixy="-0.001"', "upper", "inertia"),
    ("center of mass", '"0 0.1 0.2"', '"0 0.101 0.2"', "upper", "center of mass"),
    ("limits", 'upper="2"', 'upper="2.1"', "shoulder", "upper limit"),
    ("limits", 'effort="30"', 'effort="31"', "shoulder", "limit of effort"),
    ("joint physics", 'damping="0.7"', 'damping="0"', "shoulder", "damping"),
    ("collisions", 'radius="0.05"', 'radius="0.051"', "upper", "collision"),
    ("collisions", 'xyz="0 0 0.2"', 'xyz="0 0 0.201"', "upper", "collision"),
    ("tree", 'type="prismatic"', 'type="revolute"', "slide", "type"),
]


@pytest.mark.parametrize("other", FORMATS)
@pytest.mark.parametrize(("row", "old", "new", "name", "what"), CHANGES)
def test_a_change_is_found_at_its_part(write, robots, other, row, old, new, name, what):
    assert URDF.count(old) == 1
    comparison = compare_robots(read(write, "urdf", URDF.replace(old, new)), robots(other))
    found = [d for d in comparison.differences if d.row not in ("mass matrix", "gravity")]
    found = [d for d in found if not d.is_convention]
    assert row in {d.row for d in found}
    assert {d.name for d in found} == {name}
    chosen = next(d for d in found if d.row == row)
    assert chosen.what.startswith(what)
    line = 1 + URDF[: URDF.index(old)].count("\n")
    assert abs(chosen.places[0].line - line) <= 2
    assert chosen.places[1].line


def test_a_change_of_the_second_file_is_the_same_difference(write):
    changed = read(write, "sdf", SDF.replace("<lower>-1<", "<lower>-1.5<"))
    (difference,) = compare_robots(read(write, "urdf", URDF), changed).differences
    assert difference.values == (-1.0, -1.5)
    assert (difference.unit, difference.name) == ("rad", "shoulder")
    assert difference.places[1].path.endswith(".xml")


def test_joints_are_matched_by_prefix_and_by_structure(write):
    given = URDF.replace('"shoulder"', '"arm_Shoulder"').replace('"slide"', '"arm_Slide"')
    one, two = read(write, "urdf", URDF), read(write, "urdf", given)
    assert compare_robots(one, two).joints == {"shoulder": "arm_Shoulder", "slide": "arm_Slide"}
    other = URDF.replace('"shoulder"', '"q1"').replace('"slide"', '"q2"')
    comparison = compare_robots(one, read(write, "urdf", other + " "))
    assert comparison.joints == {"shoulder": "q1", "slide": "q2"}
    assert comparison.is_equal


def test_names_need_not_be_unique_without_case():
    assert match_names(["a_1", "b"], ["A1", "a-1"], {}) == {}
    assert match_names(["x", "y"], ["x", "z"], {"y": "z"}) == {"x": "x", "y": "z"}


def test_the_link_frame_is_a_convention(write):
    """The frame of a link is moved along the axis, with everything in it."""
    moved = (
        URDF.replace('xyz="0.1 0 0.02"', 'xyz="0.076028723 0.04387912810 0.02"')
        .replace('"0 0.1 0.2"', '"0 0.05 0.2"')
        .replace('<origin xyz="0 0 0.2"/>', '<origin xyz="0 -0.05 0.2"/>')
        .replace('<origin xyz="0 0 0.4"/>', '<origin xyz="0 -0.05 0.4"/>')
    )
    comparison = compare_robots(read(write, "urdf", URDF), read(write, "urdf", moved))
    conventions = [d for d in comparison.differences if d.is_convention]
    assert [d.name for d in conventions] == ["upper"]
    assert comparison.is_equal


def test_three_files_name_the_one_that_is_alone(urdftool, write):
    files = [
        write("a.urdf", URDF),
        write("b.urdf", URDF.replace('upper="2"', 'upper="2.5"')),
        write("c.sdf", SDF),
    ]
    result = urdftool("verify", *files, "--format", "json")
    assert result.code == 1
    report = json.loads(result.out)
    schema = json.loads((ROOT / "docs" / "schemas" / "verify.json").read_text())
    jsonschema.validate(report, schema)
    (difference,) = report["differences"]
    assert difference["alone"] == 1
    assert difference["values"] == [2.0, 2.5, 2.0]
    assert difference["places"][1] == {"path": files[1], "line": 15}
    text = urdftool("verify", *files)
    assert text.code == 1
    assert f"B  2.5  {files[1]}:15:1  (alone)" in text.out


@pytest.mark.parametrize("rows", ["textures", "loops,plugins"])
def test_robots_without_what_is_compared_are_not_called_equal(urdftool, write, rows):
    words = ("verify", write("a.urdf", URDF), write("b.urdf", URDF), "--only", rows)
    result = urdftool(*words)
    assert result.code == 1
    assert "2 robots: nothing was compared" in result.err
    report = json.loads(urdftool(*words, "--format", "json").out)
    assert (report["equal"], report["pairs"][0]["equal"]) == (False, False)


def test_equal_robots(urdftool, write):
    result = urdftool("verify", write("a.urdf", URDF), write("c.sdf", SDF))
    assert result.code == 0
    assert result.err.endswith(
        "2 robots: equal in every compared property; 6 could not be compared\n"
    )


def test_rows_and_tolerances(urdftool, write):
    files = write("a.urdf", URDF), write("b.urdf", URDF.replace('upper="2"', 'upper="2.1"'))
    assert urdftool("verify", *files, "--only", "frames,mass").code == 0
    assert urdftool("verify", *files, "--only", "limits").code == 1
    assert urdftool("verify", *files, "--tolerance", "0.2").code == 0
    assert urdftool("verify", *files, "--tolerance", "nan").code == 2
    assert [row.name for row in select_rows("center,lim", None)] == ["limits", "center of mass"]
    result = urdftool("verify", *files, "--only", "masses")
    assert result.code == 2
    assert "row 'masses' does not exist" in result.err


def test_a_map_names_joints(urdftool, write, tmp_path):
    other = URDF.replace('"shoulder"', '"q1"').replace('name="slide"', 'name="shoulder"')
    files = write("a.urdf", URDF), write("b.urdf", other)
    assert urdftool("verify", *files).code == 1
    names = write("names.txt", "# all\njoint shoulder q1  # the first\njoint slide shoulder\n")
    assert urdftool("verify", *files, "--map", names).code == 0
    result = urdftool("verify", *files, "--map", write("bad.txt", "joint a\n"))
    assert result.code == 2
    assert "bad.txt: line 1 is not 'joint A B'" in result.err


@pytest.mark.parametrize("files", [(), ("a.urdf",), ("-", "-")])
def test_usage(urdftool, write, files):
    write("a.urdf", URDF)
    assert urdftool("verify", *files).code == 2


def test_a_robot_that_is_no_tree(urdftool, write):
    loose = URDF.replace("</robot>", '<link name="loose"/></robot>')
    result = urdftool("verify", write("a.urdf", URDF), write("b.urdf", loose))
    assert result.code == 2
    assert "b.urdf:1:1: " in result.err


def test_different_robots(urdftool, write):
    other = '<robot name="x"><link name="a"/><link name="b"/><joint name="j" type="floating">'
    other += '<parent link="a"/><child link="b"/></joint></robot>'
    result = urdftool("verify", write("a.urdf", URDF), write("b.urdf", other))
    assert result.code == 1
    assert (
        "only 0 joints of A (2) and B (0) match" in result.err or "may be different" in result.err
    )


def test_a_base_at_the_world_is_no_difference(write, urdftool):
    """One file has a link for the world, as URDF has, and the other begins with the base."""
    limit = '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'
    shape = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
    arm = (
        f'<link name="base">{shape}</link><link name="arm">{shape}</link>'
        '<joint name="j" type="revolute"><parent link="base"/><child link="arm"/>'
        f'<origin xyz="0 0 1"/>{limit}</joint>'
    )
    world = (
        '<link name="world"/><joint name="anchor" type="fixed"><parent link="world"/>'
        '<child link="base"/><origin xyz="0 0 0.5" rpy="0 0 1"/></joint>'
    )
    one = write("one.urdf", f'<robot name="r">{world}{arm}</robot>')
    two = write("two.urdf", f'<robot name="r">{arm}</robot>')
    for files in ((one, two), (two, one)):
        result = urdftool("verify", *files)
        assert (result.code, "differs" in result.out) == (0, False), result.out
    three = write(
        "three.urdf", f'<robot name="r">{arm}</robot>'.replace('0 0 1"/><ax', '0 0 1.1"/><ax')
    )
    result = urdftool("verify", one, three)
    assert (result.code, result.out.count("joint 'j'")) == (1, 1)


MIMIC = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="one" type="continuous"><parent link="a"/><child link="b"/></joint>
<joint name="two" type="continuous"><parent link="b"/><child link="c"/>
<mimic joint="one" multiplier="-2" offset="0.3"/></joint>
<joint name="three" type="continuous"><parent link="c"/><child link="d"/>
<mimic joint="{}" multiplier="{}" offset="{}"/></joint></robot>"""


@pytest.mark.parametrize(("offset", "code"), [(-0.05, 0), (-0.06, 1)])
def test_a_chain_of_mimics_is_equal_to_its_last_leader(urdftool, write, offset, code):
    one = write("chain.urdf", MIMIC.format("two", 0.5, -0.2))
    two = write("leader.urdf", MIMIC.format("one", -1, offset))
    assert urdftool("verify", one, two).code == code
