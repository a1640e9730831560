"""The comparison finds what is wrong with a file, whatever wrote it."""

import re

import numpy as np
import pytest

from urdftool.compare.check import is_faithful
from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.verify.compare import compare, pair_of, verify
from urdftool.formats.sdf.verify.dynamics import compute_mass_matrix, compute_poses
from urdftool.formats.sdf.verify.mechanism import rotate_by_angles, rotate_by_quaternion
from urdftool.formats.sdf.verify.source import convert_mechanism
from urdftool.formats.sdf.write import write
from urdftool.model.load import load
from urdftool.model.pose import quaternion_from_rpy, rotation_from_rpy

from .goldens import FOLDER
from .robots import inertial, joint, link, robot

ARM = FOLDER / "gripper_arm.urdf"


def checks_of(tmp_path, change=lambda text: text, quiet=False, **choices):
    source = load(ARM)
    written = write(source, Options(**choices))
    if quiet:
        written.losses.clear()
    place = tmp_path / "model.sdf"
    text = written.files["model.sdf"].decode()
    changed = change(text)
    assert changed != text or change("") == ""
    place.write_text(changed)
    pair = pair_of(source, written, place, Options(**choices))
    return {check.name: check for check in compare(pair)}


@pytest.mark.parametrize("fixed_joints", ["keep", "lump"])
@pytest.mark.parametrize("version", ["1.9", "1.11", "1.12"])
def test_an_export_is_faithful(tmp_path, fixed_joints, version):
    checks = checks_of(tmp_path, fixed_joints=fixed_joints, version=version)
    assert is_faithful(checks.values())
    assert checks["frames"].worst < 1e-14


def replaced(old, new):
    return lambda text: text.replace(old, new, 1)


@pytest.mark.parametrize(
    ("change", "found"),
    [
        (replaced("<mass>1.5</mass>", "<mass>1.6</mass>"), {"whole"}),
        (replaced("<ixy>0.001</ixy>", "<ixy>-0.001</ixy>"), {"whole"}),
        (replaced("<mass>4</mass>", "<mass>4.0001</mass>"), {"whole"}),
        (replaced("<upper>1.5</upper>", "<upper>1.6</upper>"), {"limits"}),
        (replaced("<friction>0.1</friction>", ""), {"limits"}),
        (replaced("<effort>20</effort>", "<effort>-1</effort>"), {"limits"}),
        (replaced("<multiplier>0.9<", "<multiplier>1<"), {"tree"}),
        (replaced('type="prismatic"', 'type="revolute"'), {"tree"}),
        (replaced("0 0 0.3 0 0 0.5", "0 0 0.3 0 0 0.6"), {"frames"}),
        (replaced("<size>0.1 0.05 0.04</size>", "<size>0.1 0.05 0.05</size>"), {"collisions"}),
        (replaced("<diffuse>0.2 0.4 0.9 0.7", "<diffuse>0.25 0.5 1 0.7"), {"colours"}),
        (replaced("<izz>0.004</izz>", "<izz>0.0041</izz>"), {"mass matrix"}),
        (replaced("<xyz>0 0 1</xyz>", "<xyz>0 1 0</xyz>"), {"frames", "mass matrix", "gravity"}),
        (lambda text: re.sub(r"<visual.*?</visual>", "", text, count=1, flags=re.S), {"visuals"}),
    ],
)  # fmt: skip
def test_a_change_is_found(tmp_path, change, found):
    checks = checks_of(tmp_path, change)
    assert found <= {name for name, check in checks.items() if check.verdict == "differs"}


@pytest.mark.parametrize(
    "change",
    [replaced('<frame name="flange"', '<frame name="flanges"'), replaced("</sdf>", "")],
)
def test_a_file_that_cannot_be_read_differs(tmp_path, change):
    source = load(ARM)
    written = write(source)
    text = change(written.files["model.sdf"].decode())
    (tmp_path / "model.sdf").write_text(text)
    (check,) = verify(source, written, Options(), tmp_path)
    assert check.verdict == "differs"


def test_what_was_announced_is_no_failure(tmp_path):
    checks = checks_of(tmp_path, version="1.9")
    assert checks["tree"].verdict == "announced"
    assert checks_of(tmp_path, quiet=True, version="1.9")["tree"].verdict == "differs"


@pytest.mark.parametrize("rpy", [(0.1, 0.2, 0.3), (2, -1.5707963, 4), (0, 0, 0)])
def test_its_rotations_are_those_of_urdf(rpy):
    assert rotate_by_angles(rpy) == pytest.approx(np.array(rotation_from_rpy(rpy)), abs=1e-15)
    w, x, y, z = quaternion_from_rpy(rpy)
    assert rotate_by_quaternion(x, y, z, w) == pytest.approx(rotate_by_angles(rpy), abs=1e-14)


def test_a_pendulum_in_closed_form():
    """A bob of 2 kg half a metre out on a hinge about y: m l² + I, and m g l at rest."""
    bob = link("b", inertial(2, (0.01, 0.02, 0.03), xyz="0.5 0 0"))
    limit = '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'
    mechanism = convert_mechanism(robot(link("a"), joint("j", "a", "b", inside=limit), bob))
    order = mechanism.sort_joints()
    for angle in (0.0, 0.7):
        inertia, weight = compute_mass_matrix(
            mechanism, compute_poses(mechanism, {"j": angle}, order), order, ["j"]
        )
        assert inertia[0, 0] == pytest.approx(2 * 0.25 + 0.02)
        assert weight[0] == pytest.approx(-2 * 9.81 * 0.5 * np.cos(angle))


def test_two_links_in_closed_form():
    """The mass matrix of two point masses on a planar arm."""
    limit = '<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/>'
    parts = (
        link("a"),
        joint("j", "a", "b", inside=limit),
        link("b", inertial(2, (0, 0, 0), xyz="1 0 0")),
        joint("k", "b", "c", inside=limit, origin="1 0 0"),
        link("c", inertial(3, (0, 0, 0), xyz="1 0 0")),
    )
    mechanism = convert_mechanism(robot(*parts))
    order = mechanism.sort_joints()
    bend = 0.8
    placed = compute_poses(mechanism, {"k": bend}, order)
    inertia, _ = compute_mass_matrix(mechanism, placed, order, ["j", "k"])
    near, far = 2.0, 3.0
    assert inertia[1, 1] == pytest.approx(far)
    assert inertia[0, 1] == pytest.approx(far * (1 + np.cos(bend)))
    assert inertia[0, 0] == pytest.approx(near + far * (2 + 2 * np.cos(bend)))
