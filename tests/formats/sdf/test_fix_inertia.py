"""Tensors that no rigid body has: what becomes of them, in numbers of our own."""

import numpy as np
import pytest

from tests.formats.sdf.robots import export, inertial, link, tree
from urdftool.formats.mjcf.options import Options as Mjcf
from urdftool.formats.mjcf.write import write as write_mjcf
from urdftool.refusal import Refused

TURN = "0.4 0 0"
MOMENTS = (0.1, 0.2, 0.4)
BOX = '<collision><origin xyz="1 0 0"/><geometry><box size="0.1 0.2 0.3"/></geometry></collision>'
BAD = inertial(2.0, MOMENTS, xyz="1 2 3", rpy=TURN)


def written(*inside, **choices):
    """Mass, center and tensor of the one link of an export, and what was said."""
    made = export(link("a", "".join(inside)), **choices)
    node = tree(made).find("link/inertial")
    assert [float(n) for n in node.findtext("pose").split()][3:] == [0, 0, 0]
    i = {
        k: float(node.findtext(f"inertia/{k}")) for k in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    }
    tensor = np.array(
        [
            [i["ixx"], i["ixy"], i["ixz"]],
            [i["ixy"], i["iyy"], i["iyz"]],
            [i["ixz"], i["iyz"], i["izz"]],
        ]
    )
    center = [float(n) for n in node.findtext("pose").split()][:3]
    said = [loss.message for loss in made.losses if loss.code == "lossy-inertia"]
    return float(node.findtext("mass")), center, tensor, said


def test_it_is_refused_and_the_option_named():
    with pytest.raises(Refused) as refused:
        export(link("a", BAD))
    (finding,) = refused.value.findings
    assert finding.code == "inertia-triangle-inequality"
    assert "--fix-inertia lift, balance or box" in finding.hint


def test_lifted_it_is_the_nearest_that_a_body_has():
    mass, center, tensor, (said,) = written(BAD, fix_inertia="lift")
    c, s = np.cos(0.4), np.sin(0.4)
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    expected = turn @ np.diag([0.15, 0.25, 0.4]) @ turn.T
    assert (mass, center) == (2.0, [1.0, 2.0, 3.0])
    np.testing.assert_allclose(tensor, expected, atol=1e-6)
    assert "0.1, 0.2, 0.4 kg·m²): lifted to 0.15" in said
    low, middle, high = np.linalg.eigvalsh(tensor)
    assert low + middle >= high


def test_balanced_it_is_a_ball_of_the_same_mean():
    _, _, tensor, (said,) = written(BAD, fix_inertia="balance")
    np.testing.assert_allclose(tensor, np.eye(3) * sum(MOMENTS) / 3, rtol=1e-12)
    assert "balanced to 0.233333" in said


def test_a_box_around_what_touches():
    _, _, tensor, (said,) = written(BAD, BOX, fix_inertia="box")
    x, y, z = 0.1**2, 0.2**2, 0.3**2
    np.testing.assert_allclose(tensor, np.diag([y + z, x + z, x + y]) * 2 / 12, rtol=1e-9)
    assert "replaced by the inertia of a box" in said
    _, _, _, (said,) = written(BAD, fix_inertia="box")
    assert "no geometry for a box" in said


def test_a_tensor_that_a_body_has_stays_as_it_is_written():
    made = export(link("a", inertial(2.0, (0.1, 0.2, 0.25), rpy=TURN)), fix_inertia="box")
    node = tree(made).find("link/inertial")
    assert node.findtext("pose").split()[3] == "0.4"
    assert node.findtext("inertia/izz") == "0.25"
    assert not made.losses


@pytest.mark.parametrize("way", ["lift", "balance", "box"])
def test_both_languages_get_the_same(way, write, urdftool):
    path = write("r.urdf", f'<robot name="r">{link("a", BAD + BOX)}</robot>')
    done = urdftool("export", "sdf", path, "-o", "sdf", "--fix-inertia", way, "--verify")
    assert done.code == 0, done.out
    from urdftool.model.load import load

    robot = load(path)
    losses = write_mjcf(robot, Mjcf(fix_inertia=way, base="free")).losses
    (said,) = [loss.message for loss in losses if loss.code == "lossy-inertia"]
    assert said.split(" kg·m²")[0] in done.err
