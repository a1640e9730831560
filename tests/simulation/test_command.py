"""What a user of ``urdftool simulate`` sees: words, JSON, exit codes, refusals in one message."""

import json
from importlib.util import find_spec

import jsonschema
import pytest

from tests.conftest import FIXTURES, ROOT
from tests.simulation.robots import body, inertial
from urdftool.simulation.engines import registry

BOX = body('<box size="0.4 0.3 0.2"/>', 2, (0.0216667, 0.0333333, 0.0416667))
MIRA = FIXTURES / "robots" / "mira_description" / "urdf" / "mira.urdf"


TINY = '<mesh filename="cube.stl" scale="1e-20 1e-20 1e-20"/>'
JOINT_AND_END = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>'
LIMIT = '<limit lower="-1" upper="1" effort="9" velocity="1"/>'


def two_links(kind="revolute", second="b", limit=LIMIT):
    part = inertial(1, 0.01, 0.01, 0.01)
    return (
        f'<robot name="r"><link name="a">{part}<collision><geometry><box size="1 1 .1"/></geometry>'
        f'</collision></link><link name="{second}">{part}</link><joint name="j" type="{kind}">'
        f'<parent link="a"/><child link="b"/><axis xyz="0 0 1"/>{limit}</joint></robot>'
    )


def test_words(urdftool):
    result = urdftool("simulate", MIRA)
    assert result.code == 0
    assert result.out.startswith("mira: stands\n")
    assert "stands on      base_link" in result.out


@pytest.mark.parametrize(
    ("there", "engine"),
    [
        ({"pybullet", "mujoco"}, "pybullet"),
        ({"pybullet"}, "pybullet"),
        ({"mujoco"}, "mujoco"),
    ],
)
def test_the_engine_that_is_there_simulates(monkeypatch, there, engine):
    monkeypatch.setattr(registry, "is_installed", lambda name: name in there)
    assert registry.choose_default_engine() == engine


def test_json_is_as_its_schema_says(urdftool, write):
    result = urdftool("simulate", write("r.urdf", BOX), "--format", "json", "--trials", "2")
    assert result.code == 0
    said = json.loads(result.out)
    schema = json.loads((ROOT / "docs" / "schemas" / "simulate.json").read_text("utf-8"))
    jsonschema.validate(said, schema)
    assert len(said["trials"]) == 2


@pytest.mark.parametrize("engine", ["pybullet", "mujoco"])
@pytest.mark.parametrize(
    "more",
    [pytest.param((), id="one"), pytest.param(("--fleet",), id="fleet", marks=pytest.mark.slow)],
)
def test_the_same_seed_gives_the_same_bytes(urdftool, write, engine, more):
    if not find_spec(engine):
        pytest.skip(f"requires {engine}")
    path = write("r.urdf", BOX)
    words = (
        *("simulate", path, *more, "--engine", engine, "--seed", "7", "--trials", "3"),
        *("--format", "json", "--duration", "0.5"),
    )
    first, second = urdftool(*words), urdftool(*words)
    assert first.out
    assert (first.out, first.code) == (second.out, second.code)
    assert '"seconds"' not in first.out
    assert '"seconds"' in urdftool("-v", *words).out


def test_a_box_that_is_dropped_stands(urdftool, write):
    assert urdftool("simulate", write("r.urdf", BOX), "--height", "0.5").code == 0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (two_links("planar", limit=""), "is planar"),
        (two_links("spherical", limit=""), "is spherical"),
        (two_links(second="c"), "child 'b' of joint"),
        (two_links().replace("</robot>", '<link name="x"/></robot>'), "have no parent joint"),
        (two_links().replace("</robot>", JOINT_AND_END), "is used twice"),
        (BOX.replace('value="2"', 'value="nan"'), "which is not finite"),
        (BOX.replace('value="2"', 'value="-2"'), "mass of link 'a' is negative (-2 kg)"),
        (BOX.replace('<box size="0.4 0.3 0.2"/>', '<mesh filename="a.glb"/>'), "no such mesh"),
        (BOX.replace('<box size="0.4 0.3 0.2"/>', TINY), "cannot make contact"),
        ('<robot name="r"/>', "no link"),
    ],
)  # fmt: skip
def test_what_no_engine_can_be_given_is_refused_in_one_message(urdftool, write, text, said):
    write("cube.stl", (FIXTURES / "meshes" / "cube.stl").read_bytes())
    result = urdftool("simulate", write("r.urdf", text))
    assert result.code == 2
    assert said in result.err
    assert "r.urdf:" in result.err.splitlines()[0]
    assert result.out == ""


def test_a_robot_that_collides_with_a_flat_box_alone_falls(urdftool, write):
    flat = BOX.replace('<box size="0.4 0.3 0.2"/>', '<box size="0 1 1"/>')
    result = urdftool("simulate", write("r.urdf", flat), "--duration", "1")
    assert result.code == 1
    assert "no-collision-geometry" in result.out
    assert "size of a <box> in a collision of link 'a' is 0 1 1" in result.out
    assert "the shape is ignored" in result.out


@pytest.mark.slow
def test_a_robot_of_ten_thousand_links_is_refused_in_time(urdftool, write):
    part = inertial(1, 0.01, 0.01, 0.01)
    links = "".join(f'<link name="l{i}">{part}</link>' for i in range(10_000))
    joints = "".join(
        f'<joint name="j{i}" type="continuous"><parent link="l{i}"/><child link="l{i + 1}"/>'
        "</joint>"
        for i in range(9_999)
    )
    result = urdftool("simulate", write("r.urdf", f'<robot name="r">{links}{joints}</robot>'))
    assert result.code == 2
    assert "r.urdf:1:1: the robot has 9999 moving joints" in result.err


def test_a_zero_mass_is_a_verdict(urdftool, write):
    result = urdftool("simulate", write("r.urdf", BOX.replace('value="2"', 'value="0"')))
    assert result.code == 1
    assert "no-mass" in result.out
    assert "mass of link 'a' is 0" in result.out


@pytest.mark.slow
def test_the_time_limit_holds(urdftool, write):
    result = urdftool(
        "simulate", write("r.urdf", BOX), "--timestep", "0.00001", "--duration", "3600",
        "--height", "9000", "--time-limit", "1",
    )  # fmt: skip
    assert result.code == 2
    assert "--time-limit" in result.err


def test_a_pose_or_payload_of_nothing_is_refused(urdftool, write):
    path = write("r.urdf", two_links())
    assert urdftool("simulate", path, "--pose", "k=1").code == 2
    assert "no link 'c'" in urdftool("simulate", path, "--payload", "c=1").err
    assert urdftool("simulate", path, "--payload", "b").code == 2


def test_the_swept_joint_that_hits_is_named(urdftool, write):
    text = two_links().replace('xyz="0 0 1"/>', 'xyz="0 1 0"/><origin xyz="0 0 0.3"/>')
    far = (
        '<link name="far"><collision><origin xyz="0.4 0 0"/><geometry><box size=".3 .1 .1"/>'
        '</geometry></collision></link><joint name="f" type="fixed"><parent link="b"/>'
        '<child link="far"/></joint></robot>'
    )
    result = urdftool("simulate", write("r.urdf", text.replace("</robot>", far)), "--sweep")
    assert "limits of joint 'j' are -1 to 1" in result.out


def test_a_held_round_part_above_the_ground_does_not_shake_the_robot(urdftool, write):
    part = '<origin xyz="0.1 0 0" rpy="0 1.5708 0"/>'
    text = (
        '<robot name="r"><link name="b"><inertial><mass value="8"/><inertia ixx="0.03" iyy="0.1" '
        'izz="0.13" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry>'
        '<box size="0.4 0.2 0.1"/></geometry></collision></link><link name="l"><inertial>'
        '<origin xyz="0.1 0 0"/><mass value="0.285"/><inertia ixx="0.0001" iyy="0.001" izz="0.001" '
        f'ixy="0" ixz="0" iyz="0"/></inertial><collision>{part}<geometry>'
        '<cylinder radius="0.02" length="0.2"/></geometry></collision></link>'
        '<joint name="j" type="revolute"><origin xyz="0.2 0 0"/><parent link="b"/>'
        '<child link="l"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="100" '
        'velocity="100"/></joint></robot>'
    )
    result = urdftool("simulate", write("r.urdf", text), "--engine", "pybullet")
    assert result.out.startswith("r: stands\n")


def test_an_arm_that_tips_over_is_said_to_be_bolted_down_usually(urdftool, write):
    part = inertial(1, 0.0017, 0.0017, 0.0017)
    shape = "<collision><geometry><box size='.1 .1 .1'/></geometry></collision>"
    links = "".join(f'<link name="l{i}">{part}{shape}</link>' for i in range(5))
    joints = "".join(
        f'<joint name="j{i}" type="revolute"><origin xyz="0.3 0 0"/><parent link="l{i}"/>'
        f'<child link="l{i + 1}"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="1" effort="900" velocity="1"/></joint>'
        for i in range(4)
    ).replace("0.3 0 0", "0.2 0 0.2", 1)
    path = write("r.urdf", f'<robot name="r">{links}{joints}</robot>')
    result = urdftool("simulate", path)
    assert result.code == 1
    assert "the exports fix the root (the description has no sign of a mobile base)" in result.out
    assert "root free (exports fix it; --fixed-base)" in result.out
    assert urdftool("simulate", path, "--fixed-base").code == 0


def test_a_robot_that_stands_in_spite_of_an_error_is_said_to_stand(urdftool, write):
    sluggish = body('<box size="0.4 0.3 0.2"/>', 2, (1, 1, 1))
    path = write("r.urdf", sluggish)
    result = urdftool("simulate", path)
    assert result.code == 0
    assert result.out.startswith("r: stands, with warnings\n")
    assert "warning: inertia of link 'a' is a placeholder" in result.out
    result = urdftool("simulate", "--strict", path)
    assert result.code == 1
    assert result.out.startswith("r: stands, with model errors (inertia-too-large)")


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ((), "held by  position motors within effort limits"),
        (("--limp",), None),
    ],
)
def test_what_holds_the_joints_is_named(urdftool, write, options, expected):
    done = urdftool(
        "simulate", write("r.urdf", two_links()), "--fixed-base", "--engine", "pybullet", *options
    )
    text = " ".join(done.out.split())
    assert ("held by" in text) == (expected is not None)
    assert expected is None or " ".join(expected.split()) in text
