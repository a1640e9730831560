"""The cases of sdformat's own tests: its expected values where they are right.

Where ours differ on purpose, the test says so: shapes keep their names instead of
``PARENT_fixed_joint_lump__…``; lumped inertia is along the axes of the link instead of the parent's
inertial frame (the tensors compared here are both along the link's); ``provide_feedback`` stands in
``physics`` alone, since ``physics/ode`` has none; colours are not made 1.25 times brighter.
"""

import numpy as np
import pytest

from tests.conftest import CORPUS
from urdftool.compare.check import is_faithful
from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.verify.compare import compare, read_pair
from urdftool.formats.sdf.write import write
from urdftool.model.load import load
from urdftool.model.pose import rotation_from_rpy

from .robots import named, names, tree

pytestmark = pytest.mark.corpus

FOLDER = CORPUS / "gazebosim__sdformat" / "test" / "integration"
CLASSIC = {"target": "gazebo-classic"}


def model_of(name, **choices):
    return tree(write(load(FOLDER / f"{name}.urdf"), Options(**choices)))


def mass_of(model, name):
    """Mass, center and tensor along the axes of the link."""
    inertial = named(model, "link", name).find("inertial")
    pose = [float(w) for w in (inertial.findtext("pose") or "0 0 0 0 0 0").split()]
    i = {e.tag: float(e.text) for e in inertial.find("inertia")}
    tensor = np.array(
        [
            [i["ixx"], i["ixy"], i["ixz"]],
            [i["ixy"], i["iyy"], i["iyz"]],
            [i["ixz"], i["iyz"], i["izz"]],
        ]
    )
    turn = np.array(rotation_from_rpy(pose[3:]))
    return float(inertial.findtext("mass")), pose[:3], turn @ tensor @ turn.T


REDUCTION = {
    "link0": (1000, (0, 0, -0.5), (0, 0, 0), (1, 1, 1), (0, 0, 0)),
    "link1": (100, (0, -1.5, 0), (-2.14159265, 0.14159265, 0.85840735), (2, 3, 4), (0, 0, 0)),
    "link2": (200, (0.2, 0.4, 1), (-1.14159265, -0.14159265, 1.57079633), (5, 6, 7), (0, 0, 0)),
    "link3": (400, (0.1, 0.2, 0.3), (-1.14159265, 0.14159265, 0.85840735), (8, 9, 10), (0, 0, 0)),
    "link1a": (
        700,
        (1.6, -2.72857, -0.342857),
        (-2.14159265, 0.14159265, 0.85840735),
        (576.477313, 527.680922, 420.127477),
        (-65.680839, 134.562430, 264.780538),
    ),
}


@pytest.mark.parametrize(
    ("case", "visuals", "collisions"),
    [
        ("fixed_joint_reduction", 7, 7),
        ("fixed_joint_reduction_collision", 0, 6),
        ("fixed_joint_reduction_visual", 6, 0),
    ],
)
def test_reduction(case, visuals, collisions):
    model = model_of(case, **CLASSIC)
    assert sorted(names(model, "link")) == sorted(REDUCTION)
    for name, (mass, center, rpy, moments, products) in REDUCTION.items():
        got_mass, got_center, got_tensor = mass_of(model, name)
        xx, yy, zz = moments
        xy, xz, yz = products
        turn = np.array(rotation_from_rpy(rpy))
        tensor = turn @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
        assert got_mass == pytest.approx(mass)
        assert got_center == pytest.approx(center, abs=1e-5)
        assert got_tensor == pytest.approx(tensor, abs=2e-5)
    assert len(list(model.iter("visual"))) == visuals
    assert len(list(model.iter("collision"))) == collisions


@pytest.mark.parametrize("link", ["link1", "link1a", "link1b", "link1c", "link1d", "link1e"])
@pytest.mark.parametrize("choices", [CLASSIC, {"fixed_joints": "lump"}])
def test_simple_reduction(link, choices):
    mass, center, tensor = mass_of(model_of("fixed_joint_reduction_simple", **choices), link)
    away = link[-1] in "cde"
    assert mass == 300
    assert center == pytest.approx((0.2 if away else 0, 0, 0), abs=1e-9)
    assert tensor == pytest.approx(np.diag((7, 9 + 6 * away, 11 + 6 * away)), abs=1e-6)


@pytest.mark.parametrize(
    ("link", "contacts", "mu", "mu2", "script"),
    [
        ("child_link_1", "177", "0.7", "0.71", "script_uri_71_name"),
        ("child_link_1a", "166", "0.6", "0.61", None),
        ("child_link_2", None, "0.5", "0.51", "script_name_51"),
    ],
)
def test_extensions_of_lumped_links(link, contacts, mu, mu2, script):
    model = model_of("fixed_joint_reduction_collision_visual_extension", **CLASSIC)
    collision = named(model, "collision", f"{link}_collision")
    assert collision.findtext("max_contacts") == contacts
    assert collision.findtext("surface/friction/ode/mu") == mu
    assert collision.findtext("surface/friction/ode/mu2") == mu2
    visual = named(model, "visual", f"{link}_visual")
    assert visual.findtext("material/script/name") == script
    if link == "child_link_1":
        assert collision.findtext("surface/contact/ode/min_depth") == "0.007"
        assert visual.findtext("material/ambient") == "0 1 0 1"
    for tag in ("gravity", "self_collide", "velocity_decay"):
        assert next(model.iter(tag), None) is None


def test_a_root_without_shapes():
    model = model_of("fixed_joint_reduction_collision_visual_empty_root", **CLASSIC)
    assert names(model, "link") == ["base_link"]
    assert named(model, "collision", "child_link_1_collision").findtext("max_contacts") == "177"


def test_a_plugin_follows_its_link():
    plugin = next(
        model_of("fixed_joint_reduction_plugin_frame_extension", **CLASSIC).iter("plugin")
    )
    assert plugin.findtext("bodyName") == "base_link"
    offset = [float(w) for w in plugin.findtext("xyzOffset").split()]
    assert offset == pytest.approx((-0.707108, 1.70711, 0), abs=1e-4)
    assert [float(w) for w in plugin.findtext("rpyOffset").split()] == pytest.approx(
        (0, 0, 1.5708), abs=1e-4
    )


@pytest.fixture(scope="module")
def extended():
    return model_of("urdf_gazebo_extensions", fixed_joints="lump", version="1.9")


def test_extensions_of_joints(extended):
    assert named(extended, "joint", "jointw0").find("physics") is None
    joint = named(extended, "joint", "joint01")
    expected = {
        "physics/provide_feedback": "true",
        "physics/ode/implicit_spring_damper": "false",
        "physics/ode/cfm_damping": "false",
        "physics/ode/fudge_factor": "0.56789",
        "physics/ode/limit/cfm": "123",
        "physics/ode/limit/erp": "0.987",
        "axis/dynamics/damping": "1.1111",
        "axis/dynamics/friction": "2.2222",
        "axis/dynamics/spring_reference": "0.234",
        "axis/dynamics/spring_stiffness": "0.567",
    }
    assert {path: joint.findtext(path) for path in expected} == expected
    for name, value in (("joint12", "false"), ("joint14", "true")):
        damper = named(extended, "joint", name).findtext("physics/ode/implicit_spring_damper")
        assert damper == value


def test_extensions_of_links(extended):
    one, two = (named(extended, "link", name) for name in ("link1", "link2"))
    assert [e.findtext("gravity") for e in (one, two)] == ["false", "false"]
    assert [e.findtext("enable_wind") for e in (one, two)] == ["true", "false"]
    assert [e.findtext("velocity_decay/linear") for e in (one, two)] == ["0.1", "0.1"]
    assert [e.findtext("velocity_decay/angular") for e in (one, two)] == ["0.2", "0.1"]
    for link in extended.findall("link"):
        if link.get("name") not in ("link1", "link2"):
            assert [e.tag for e in link if e.tag in ("gravity", "enable_wind")] == []


POSES = {
    "{}NoPose": (333, 0, 0, 0, 0, np.pi / 2),
    "{}Pose": (333, 111, 0, 0, 0, np.pi / 2 - 1),
    "{}PoseRelative": (111, 0, 0, 0, 0, -1),
    "{}PoseTwoLevel": (333, 111, 222, 0, 0, np.pi / 2 - 1),
    "issue378_{}": (1, 2, 3, 0.1, 0.2, 0.3),
}


@pytest.mark.parametrize("tag", ["light", "projector", "sensor"])
@pytest.mark.parametrize("name", POSES)
def test_poses_of_what_a_lumped_link_had(tag, name):
    model = model_of("urdf_gazebo_extensions", **CLASSIC)
    made = named(named(model, "link", "link0"), tag, name.format(tag))
    pose = [float(w) for w in made.findtext("pose").split()]
    assert pose == pytest.approx(POSES[name], abs=1e-5)


def test_frames_of_what_was_lumped(extended):
    frames = names(extended, "frame")
    assert len(frames) == 14
    assert {"issue378_link_joint", "jCamera", "Camera", "linkSensorPoseTwoLevel2"} <= set(frames)


def test_a_tag_keeps_its_fixed_joint():
    assert "joint12a" not in names(model_of("fixed_joint_reduction", **CLASSIC), "joint")
    kept = names(model_of("fixed_joint_reduction_disabled", **CLASSIC), "joint")
    assert "joint12a" in kept
    assert "joint23a" not in kept


def test_a_force_torque_sensor_keeps_its_joint():
    model = model_of("force_torque_sensor")
    assert named(model, "joint", "joint_1").find("sensor") is not None
    assert named(model, "joint", "joint_2").find("sensor") is None
    for name in ("lumped_and_reduced", "massless_child_link"):
        kept = model_of(f"invalid_force_torque_sensor_{name}", fixed_joints="lump")
        assert named(kept, "joint", "joint_1").find("sensor") is not None


def test_parameters_of_joints():
    model = model_of("urdf_joint_parameters")
    for name, value in (("jointw0", "0"), ("joint01", "1")):
        axis = named(model, "joint", name).find("axis")
        paths = ("dynamics/damping", "dynamics/friction", "limit/effort", "limit/velocity")
        assert [axis.findtext(path) for path in paths] == [value] * 4


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.urdf")), ids=lambda path: path.stem)
@pytest.mark.parametrize("choices", [{}, {"fixed_joints": "lump"}, CLASSIC])
def test_every_case_is_the_same_robot(path, choices, tmp_path):
    robot = load(path)
    options = Options(force=True, file="m.sdf", **choices)
    written = write(robot, options)
    place = tmp_path / "m.sdf"
    place.write_bytes(written.files["m.sdf"])
    checks = compare(read_pair(robot, written, place, options))
    assert is_faithful(checks), [check.differing for check in checks]
