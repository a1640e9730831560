"""Joints of ``<gazebo>`` that close a loop become equalities; what of them is lost is said."""

import math

import numpy as np
import pytest

from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.verify import verify_copy
from urdftool.formats.registry import format_named
from urdftool.model.load import load
from urdftool.refusal import Refused

from .robots import BOX, INERTIAL, export, joint, link, robot, rules, tree

SOLID = f"{INERTIAL}<collision>{BOX}</collision>"


def closed(inside="", *, kind="revolute", parent="b", child="c", axes=("0 1 0", "0 1 0"), block=""):
    """Two arms on a base whose ends a joint joins."""
    return robot(
        link("a", SOLID), link("b", SOLID), link("c", SOLID),
        joint("ab", "a", "b", "continuous", f'<axis xyz="{axes[0]}"/>'),
        joint("ac", "a", "c", "continuous", f'<origin xyz="2 0 0"/><axis xyz="{axes[1]}"/>'),
        f'<gazebo{block}><joint name="loop" type="{kind}"><parent>{parent}</parent>'
        f"<child>{child}</child>{inside}</joint></gazebo>",
    )  # fmt: skip


AXIS = "<axis><xyz>0 1 0</xyz></axis>"
POSE = "<pose>-1 0 1 0 0 0</pose>"


def equalities(written):
    return [(element.tag, dict(element.attrib)) for element in tree(written).find("equality")]


def test_a_hinge_in_a_plane_is_one_point(write):
    written = export(write("r.urdf", closed(POSE + AXIS)))
    ((tag, attributes),) = equalities(written)
    assert tag == "connect"
    assert attributes["anchor"] == "-1 0 1"
    assert (attributes["body1"], attributes["body2"]) == ("c", "b")
    assert rules(written) == ["lossy-added-servo", "lossy-passive-joint", "lossy-gains"]
    assert [e.get("joint") for e in tree(written).find("actuator")] == ["ac"]
    pairs = [(e.get("body1"), e.get("body2")) for e in tree(written).iter("exclude")]
    assert ("b", "c") in pairs


def test_a_hinge_in_space_is_two_points_of_its_axis(write):
    text = closed(POSE + AXIS, axes=("0 1 0", "1 0 0"))
    anchors = [attributes["anchor"] for _, attributes in equalities(export(write("r.urdf", text)))]
    assert anchors == ["-1 0 1", "-1 0.1 1"]


def test_a_ball_is_one_point(write):
    text = closed(kind="ball", axes=("0 1 0", "1 0 0"))
    ((tag, attributes),) = equalities(export(write("r.urdf", text)))
    assert (tag, attributes["anchor"]) == ("connect", "0 0 0")


def test_fixed_is_a_weld_also_to_the_world(write):
    ((tag, attributes),) = equalities(
        export(write("r.urdf", closed(kind="fixed", parent="world", child="model::c")))
    )
    assert tag == "weld"
    assert attributes["body1"] == "c"
    assert "body2" not in attributes


def test_a_pose_in_the_frame_of_another_link(write):
    text = closed('<pose relative_to="a">1 0 1 0 0 0</pose>' + AXIS)
    ((_, attributes),) = equalities(export(write("r.urdf", text)))
    assert attributes["anchor"] == "-1 0 1"


@pytest.mark.parametrize(
    ("choices", "code"),
    [
        ({"parent": "ghost"}, "dangling-reference"),
        ({"child": "ghost"}, "dangling-reference"),
        ({"child": "b"}, "dangling-reference"),
        ({"block": ' reference="a"'}, "unknown-extension"),
        ({"inside": '<pose relative_to="ghost">0 0 0 0 0 0</pose>'}, "dangling-reference"),
        ({"kind": "odd"}, "invalid-sdf-value"),
    ],
)
def test_a_loop_that_the_robot_does_not_hold_is_said(write, choices, code):
    path = write("r.urdf", closed(**choices))
    written = format_named("mjcf").write(load(path), Options(actuators="none"))
    assert rules(written) == [code]
    assert "joint 'loop'" in written.losses[0].message
    assert tree(written).find("equality") is None


@pytest.mark.parametrize("kind", ["prismatic", "universal"])
def test_what_is_not_carried_is_said(write, kind):
    written = export(write("r.urdf", closed(kind=kind)), actuators="none")
    assert rules(written) == ["lossy-loop"]
    assert tree(written).find("equality") is None


@pytest.mark.parametrize(
    "inside",
    [
        "<limit><lower>-1</lower><upper>1e16</upper></limit>",
        "<dynamics><damping>0.1</damping></dynamics>",
    ],
)
def test_limits_and_dynamics_are_said(write, inside):
    written = export(
        write("r.urdf", closed(f"<axis><xyz>0 1 0</xyz>{inside}</axis>")), actuators="none"
    )
    assert rules(written) == ["lossy-loop"]
    assert len(equalities(written)) == 1


@pytest.mark.parametrize("inside", ["<pose>0 0</pose>", "<axis><xyz>up</xyz></axis>"])
def test_numbers_that_are_none(write, inside):
    path = write("r.urdf", closed(inside))
    with pytest.raises(Refused) as caught:
        export(path)
    assert caught.value.findings[0].code == "invalid-sdf-value"
    assert len(equalities(export(path, force=True))) >= 1


@pytest.mark.parametrize("kind", ["revolute", "ball", "fixed"])
def test_the_loop_stays_closed(write, tmp_path, kind):
    mujoco = pytest.importorskip("mujoco")
    path = write("r.urdf", closed(POSE + AXIS, kind=kind))
    written = export(path)
    checks = verify_copy(load(path), Options(), written)
    assert all(check.verdict != "differs" for check in checks)
    text = written.files[written.main].decode()
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    bodies = [model.body(name).id for name in ("b", "c")]
    points = ([1, 0, 1], [-1, 0, 1])

    def apart():
        placed = [
            data.xpos[body] + data.xmat[body].reshape(3, 3) @ point
            for body, point in zip(bodies, points, strict=True)
        ]
        return np.linalg.norm(placed[0] - placed[1])

    assert apart() < 1e-12
    for _ in range(500):
        mujoco.mj_step(model, data)
    assert apart() < 2e-3


@pytest.mark.parametrize(("angle", "is_reported"), [(0.0, False), (0.5, True)])
def test_a_loop_that_is_open_at_home_is_reported_once(write, angle, is_reported):
    text = closed(POSE + AXIS, axes=("0 1 0", "1 0 0"))  # a loop in space, held at two points
    written = export(write("r.urdf", text), pose={"ab": angle})
    found = [loss for loss in written.losses if loss.code == "lossy-open-loop"]
    assert bool(found) == is_reported
    for loss in found:  # the greater radius is that of the point on the axis: (1, 0.1, 1)
        assert f"{2 * math.sqrt(2) * math.sin(angle / 2):.3g} m" in loss.message
    assert len(found) == is_reported
