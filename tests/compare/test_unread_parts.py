"""What a reader does not read of a part is compared as it is written, or named as not compared."""

import json
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import pytest

import urdftool
from urdftool.compare.differences import compare
from urdftool.compare.unread import list_unseen
from urdftool.model.elements import Robot

mujoco = pytest.mark.library("mujoco")

MJCF = """<mujoco><compiler {compiler}/><option density="1000"/>
<default><default class="soft"><position {servo}/></default></default>
<asset><mesh name="tet" vertex="0 0 0 1 0 0 0 1 0 0 0 {top}"/>
<mesh name="ball" builtin="sphere" params="1" scale="{scale} 1 1"/>
<hfield name="h" nrow="2" ncol="2" size="1 1 {height} 1" elevation="0 1 1 0"/></asset>
<worldbody><body name="a"><freejoint name="f"/><geom name="box" type="box" size="1 1 1" {fluid}/>
<geom type="mesh" mesh="tet" mass="1"/><geom type="mesh" mesh="ball" mass="1"/>
<geom type="hfield" hfield="h" mass="1"/>
<geom name="v" type="box" size="1 1 1" contype="0" conaffinity="0" mass="0" {unnamed}/>
<body name="b" pos="1 0 0"><joint name="j" axis="0 1 0" ref="0.1"/><geom type="sphere" size="1"/>
</body>
</body></worldbody>
<equality>{equality}</equality>
<actuator><position name="p" joint="j" kp="9" class="soft" {actuator}/></actuator>
<keyframe><key name="k" qpos="0 0 {key} 1 0 0 0 0"/></keyframe></mujoco>"""

PLAIN = {
    **dict.fromkeys(("compiler", "servo", "fluid", "unnamed", "actuator", "equality"), ""),
    "top": "1",
    "scale": "1",
    "height": "1",
    "key": "0",
}

FLUID = 'fluidshape="ellipsoid" fluidcoef="0.5 0.25 1.5 {} 1"'


class Case(NamedTuple):
    """Values of both files, and the row that is not equal."""

    before: dict[str, str]
    after: dict[str, str]
    row: str
    verdict: str = "differs"


CASES = {
    "mesh in the XML": Case({}, {"top": "2"}, "collisions"),
    "builtin mesh": Case({}, {"scale": "3"}, "visuals"),
    "heightfield": Case({}, {"height": "2"}, "collisions"),
    "fluid": Case({"fluid": FLUID.format(1)}, {"fluid": FLUID.format(9)}, "other elements"),
    "no fluid": Case({"fluid": FLUID.format(1)}, {}, "other elements"),
    "adhesion": Case({}, {"fluid": 'adhesion="5"'}, "other elements"),
    "time constant": Case({}, {"actuator": 'timeconst="2"'}, "other elements"),
    "time constant of a class": Case({}, {"servo": 'timeconst="2"'}, "other elements"),
    "equality with a reference": Case(
        *({"equality": f'<weld body1="b" solref="{n} 1"/>'} for n in (0.02, 0.5)),
        row="other elements",
    ),
    "root pose of a key": Case({}, {"key": "-0.5"}, "other elements"),
    "discarded visuals": Case({}, {"compiler": 'discardvisual="true"'}, "visuals", "not compared"),
}


def write(path: Path, text: str) -> Path:
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    return path


@cache
def load_text(text: str, folder: str) -> Robot:
    """Load a description from a folder of its own, once for all tests."""
    with TemporaryDirectory(suffix=folder) as place:
        name = "r.xml" if text.startswith("<mujoco>") else "r.sdf"
        return urdftool.load(write(Path(place) / name, text))


def check(template: str, case: Case, plain: dict[str, str]) -> None:
    """Check that both files of a case are not equal, and that a copy of the first is equal."""
    before, after = (template.format(**plain | one) for one in (case.before, case.after))
    one, other, copied = (
        load_text(text, folder) for text, folder in ((before, "a"), (after, "a"), (before, "b"))
    )
    agreement = urdftool.verify(one, other)
    verdicts = {found.name: found.verdict for found in agreement.pairs[0, 1].make_checks()}
    assert verdicts[case.row] == case.verdict
    assert not agreement.is_equal
    assert urdftool.verify(one, copied).is_equal
    changes = {change.row for change in compare(one, other)}
    unread = {part.row for part in list_unseen(one, other)}
    assert case.row in (changes if case.verdict == "differs" else unread)
    assert not list(compare(one, copied))
    assert not list(list_unseen(one, copied))


@mujoco
@pytest.mark.parametrize("name", CASES)
def test_what_is_not_read_of_an_mjcf_is_compared_as_written(name):
    check(MJCF, CASES[name], PLAIN)


@mujoco
def test_fluid_of_a_geom_without_a_name_is_compared(tmp_path):
    text = MJCF.format(**PLAIN).replace('name="v" ', "")
    paths = [
        write(tmp_path / f"{n}.xml", text.replace('mass="0"', f'mass="0" {FLUID.format(n)}'))
        for n in (1, 9)
    ]
    agreement = urdftool.verify(*paths)
    assert {entry.row for entry in agreement.list_disagreements()} == {"other elements"}


SDF = """<sdf version="1.11"><model name="m"><pose>0 0 {pose} 0 0 0</pose>
<link name="a"><inertial><mass>1</mass>{inertial}</inertial>
<collision name="c"><geometry>{shape}</geometry></collision>
<visual name="v"><geometry><plane><size>{plane} 1</size></plane></geometry></visual></link>
<link name="b"/><joint name="j" type="screw"><parent>a</parent><child>b</child>
<screw_thread_pitch>0.1</screw_thread_pitch><axis><xyz>{axis}</xyz></axis></joint>
</model></sdf>"""

POLYLINE = "<polyline><point>0 0</point><point>{} 0</point><point>0 1</point></polyline>"
HEIGHTMAP = "<heightmap><uri>h.png</uri><size>1 1 {}</size></heightmap>"
ADDED = "<fluid_added_mass><xx>{}</xx></fluid_added_mass>"

SDF_PLAIN = {
    "pose": "0",
    "inertial": "",
    "shape": POLYLINE.format(1),
    "plane": "1",
    "axis": "0 0 1",
}

SDF_CASES = {
    "polyline": Case({}, {"shape": POLYLINE.format(2)}, "collisions"),
    "added mass": Case(
        *({"inertial": ADDED.format(n)} for n in (1, 2)), row="inertia", verdict="not compared"
    ),
    "plane": Case({}, {"plane": "3"}, "visuals"),
    "axis of a screw": Case({}, {"axis": "1 0 0"}, "axes"),
}


@pytest.mark.parametrize("name", SDF_CASES)
def test_what_is_not_read_of_an_sdf_is_compared_as_written(name):
    check(SDF, SDF_CASES[name], SDF_PLAIN)


@pytest.mark.parametrize(
    ("height", "images", "verdict"),
    [(1, "xx", "equal"), (2, "xx", "differs"), (1, "xy", "not compared"), (1, "", "not compared")],
)
def test_a_heightmap_is_equal_only_with_an_equal_image(tmp_path, height, images, verdict):
    paths = []
    for number, place in enumerate("ab"):
        values = SDF_PLAIN | {"shape": HEIGHTMAP.format((1, height)[number])}
        paths.append(write(tmp_path / place / "r.sdf", SDF.format(**values)))
        if images:
            (tmp_path / place / "h.png").write_text(images[number])
    checks = urdftool.verify(*paths).pairs[0, 1].make_checks()
    assert {one.name: one.verdict for one in checks}["collisions"] == verdict


def test_diff_finds_the_pose_of_a_model_that_verify_ignores(tmp_path):
    one, other = (write(tmp_path / f"{n}.sdf", SDF.format(**SDF_PLAIN | {"pose": n})) for n in "19")
    (change,) = compare(urdftool.load(one), urdftool.load(other))
    assert (change.row, change.what) == ("base", "pose in the world")
    assert urdftool.verify(one, other).is_equal


def test_diff_names_what_was_not_read(tmp_path, urdftool):
    case = SDF_CASES["added mass"]
    paths = [
        write(tmp_path / place / "r.sdf", SDF.format(**SDF_PLAIN | values))
        for place, values in (("a", case.before), ("b", case.after), ("c", case.before))
    ]
    result = urdftool("diff", *paths[:2], "--format", "json")
    assert result.code == 1
    assert "not compared: a: added mass of a fluid is not read" in result.err
    assert "no differences in what was read; 1 part not compared" in result.err
    report = json.loads(result.out)
    assert (report["equal"], report["changes"]) == (False, [])
    assert report["not_compared"][0]["name"] == "a"
    assert urdftool("diff", paths[0], paths[2]).code == 0
