"""The rows of the comparison follow the options, and the tables behind them agree."""

from dataclasses import replace

import pytest

from urdftool.compare.check import is_faithful
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.verify import verify_copy
from urdftool.formats.mjcf.write import write as write_mjcf
from urdftool.model.load import load

from .robots import BOX, INERTIAL, joint, link, robot

pytest.importorskip("mujoco")

SOLID = INERTIAL + f"<collision>{BOX}</collision>"
CHAIN = (
    link("a", SOLID),
    joint("j", "a", "b", inside='<limit lower="-1" upper="1" effort="3" velocity="2"/>'),
    link("b", SOLID),
    joint("k", "b", "c", "prismatic", inside='<limit lower="0.1" upper="0.2"/>'),
    link("c", SOLID),
    joint("m", "c", "d", "continuous", inside='<mimic joint="j" multiplier="2"/>'),
    link("d", SOLID),
)

OTHERS = {
    "plain": "",
    "ball": joint("x", "a", "e", "ball", inside='<dynamics damping="1"/>') + link("e", SOLID),
    "planar": joint("x", "a", "e", "planar", inside='<axis xyz="0 0 1"/>') + link("e", SOLID),
    "floating": joint("x", "a", "e", "floating", inside="") + link("e", SOLID),
    "no mass": joint("x", "a", "e", inside='<limit lower="-1" upper="1"/>') + link("e", ""),
    "option": '<mujoco><option gravity="0 0 -1" timestep="0.004"><flag contact="enable"/></option>'
    "</mujoco>",
    "origin": '<origin xyz="1 2 3" rpy="0 0 1"/>',
    "static": "<gazebo><static>true</static></gazebo>",
    "drive": '<gazebo><plugin name="p" filename="libgazebo_ros_diff_drive.so">'
    "<leftJoint>m</leftJoint></plugin></gazebo>",
    "sky": '<gazebo reference="a"><material>Gazebo/SkyBlue</material></gazebo>',
    "spring": '<gazebo reference="j"><springStiffness>2</springStiffness></gazebo>',
}
CHOICES = {
    "auto": {},
    "free servos": {"base": "free", "actuators": "position"},
    "held motors": {"base": "fixed", "actuators": "motor"},
    "velocities": {"actuators": "velocity", "keep_locked_joints": True},
}


def list_pairs():
    """List each robot with each choice; of the pairs half is slow, with each of both in others."""
    for row, (other, text) in enumerate(OTHERS.items()):
        for column, (name, choices) in enumerate(CHOICES.items()):
            marks = [pytest.mark.slow] * ((row + column) % 2)
            yield pytest.param(text, choices, marks=marks, id=f"{other}-{name}")


@pytest.mark.parametrize(("other", "choices"), list(list_pairs()))
def test_an_export_is_faithful(write, other, choices):
    source = load(write("r.urdf", robot(*CHAIN, other)))
    options = Options(**choices)
    compared = verify_copy(source, options, write_mjcf(source, options))
    checks = [check for check in compared if check.name != "runs"]  # boxes in boxes
    assert is_faithful(checks), [c.differing for c in checks if c.differing]


@pytest.mark.parametrize(
    ("made", "said", "row"),
    [
        ({"base": "free"}, {"base": "fixed"}, "base"),
        ({"actuators": "motor"}, {"actuators": "position"}, "actuators"),
        ({"actuators": "motor"}, {"actuators": "none"}, "actuators"),
        ({"pose": {"j": 0.5}}, {}, "configurations"),
    ],
)
def test_what_an_option_asks_for_is_expected(write, made, said, row):
    source = load(write("r.urdf", robot(*CHAIN)))
    checks = verify_copy(source, Options(**said), write_mjcf(source, Options(**made)))
    assert row in [check.name for check in checks if check.verdict == "differs"]


@pytest.mark.parametrize("corners", [100, 101, 128])
def test_no_polygon_of_a_mesh_is_lost(write, corners):
    """MuJoCo leaves out a polygon of over 100 corners; a file that has one is converted."""
    import math

    angles = [2 * math.pi * index / corners for index in range(corners)]
    lines = [f"v {math.cos(a):.9f} {math.sin(a):.9f} 0" for a in angles]
    lines += ["v 0 0 1", "f " + " ".join(str(index + 1) for index in reversed(range(corners)))]
    for index in range(corners):
        lines.append(f"f {index + 1} {(index + 1) % corners + 1} {corners + 1}")
    write("cone.obj", "\n".join(lines) + "\n")
    seen = '<visual><geometry><mesh filename="cone.obj"/></geometry></visual>'
    source = load(write("r.urdf", robot(link("a", INERTIAL + seen))))
    written = write_mjcf(source, Options())
    assert is_faithful(verify_copy(source, Options(), written))


FUSED = (
    "mass by 0.01 %",
    "axis the other way round",
    "spring lost",
    "armature added",
    "lower effort bound",
    "gravity of the moon",
    "gravity flag lost",
    "box for a cylinder",
    "friction by 1 %",
    "actuator on another joint",
    "gear 1 for 50",
    "gain lost",
    "IMU 0.5 m off",
    "noise of a sensor",
    "camera turned",
    "field of view",
    "initial value lost",
    "color by 1 %",
    "exclusion added",
)


@pytest.fixture(scope="module")
def merged():
    """A robot, the options that merge its links, and what is written of it."""
    from measure.planted.measure import FOLDER, MJCF

    source, options = load(FOLDER / "everything.urdf"), replace(MJCF, fuse=True)
    return source, options, write_mjcf(source, options)


@pytest.mark.parametrize("what", FUSED)
def test_a_change_of_a_model_with_merged_links_is_found(what, merged):
    from lxml import etree

    from measure.planted.mjcf import CHANGES

    source, options, written = merged
    root = etree.fromstring(written.text.encode())
    next(planted for planted in CHANGES if planted.what == what).edit(root)
    written = replace(written, files=written.files | {written.main: etree.tostring(root)})
    checks = verify_copy(source, options, written)
    assert "fused" in [check.name for check in checks if check.verdict == "differs"]


@pytest.mark.parametrize(
    ("base", "old", "new", "said"),
    [
        ("fixed", "", "", None),
        ("free", "", "", None),
        ("fixed", 'pos="0 0 -1.5"', "", "the floor is at z = 0"),
        ("free", 'name="floor"', 'name="floor" pos="0 0 -0.5"', "the floor is at z = -0.5"),
        ("fixed", 'type="plane"', 'type="plane" quat="1 0.1 0 0"', "the floor is tilted"),
        ("free", 'type="plane"', 'type="plane" contype="0"', "no contact with the floor"),
        ("free", "<worldbody>", "<worldbody><geom size='1'/>", "floors"),
        ("fixed", "<asset>", "<option gravity='0 0 -1.62'/><asset>", "option gravity"),
    ],
)
def test_a_scene_is_compared(write, base, old, new, said):
    source = load(write("r.urdf", robot(*CHAIN)))
    options = Options(scene=True, base=base)
    written = write_mjcf(source, options)
    text = written.files["scene.xml"].decode()
    assert old in text
    written.files["scene.xml"] = text.replace(old, new, 1).encode()
    (check,) = [c for c in verify_copy(source, options, written) if c.name == "scene"]
    assert all(said is not None and said in text for text in check.differing)
    assert bool(check.differing) == (said is not None)


def test_merged_links_without_shapes_are_equal(write):
    welded = joint("w", "a", "b", "fixed", inside="")
    source = load(write("r.urdf", robot(link("a"), welded, link("b"))))
    options = Options(fuse=True, scene=True)
    checks = verify_copy(source, options, write_mjcf(source, options))
    assert is_faithful(checks), [c.differing for c in checks if c.differing]
