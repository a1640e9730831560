"""One rule for tensors in every export: noise is none, rounding is lifted, surpluses move."""

from importlib.util import find_spec

import numpy as np
import pytest

import urdftool as api
from urdftool.errors import UrdftoolError
from urdftool.formats.common.inertia_surplus import is_consistent, move_surplus
from urdftool.mechanics.repair import find_nearest_consistent
from urdftool.mechanics.spatial_inertia import SpatialInertia
from urdftool.mechanics.tensor import to_matrix
from urdftool.model.elements import ZERO
from urdftool.model.pose import IDENTITY, rotation_from_rpy

pytestmark = pytest.mark.usefixtures("stages_are_read_here")

FORMATS = [
    pytest.param("sdf"),
    pytest.param("mjcf", marks=pytest.mark.skipif(not find_spec("mujoco"), reason="compiles it")),
    pytest.param("usd", marks=pytest.mark.skipif(not find_spec("pxr"), reason="writes a stage")),
]
BOX = "<collision><geometry><box size='1 1 1'/></geometry></collision>"


def link(name, mass, xx, yy, zz):
    return (
        f"<link name='{name}'><inertial><mass value='{mass}'/><inertia ixx='{xx}' iyy='{yy}' "
        f"izz='{zz}' ixy='0' ixz='0' iyz='0'/></inertial>{BOX}</link>"
    )


def arm(tip, joint="fixed"):
    """A base, a hinge, an arm, and a link at its end."""
    hinge = (
        "<joint name='h' type='revolute'><parent link='base'/><child link='arm'/>"
        "<axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='9' velocity='9'/></joint>"
    )
    end = (
        f"<joint name='e' type='{joint}'><parent link='arm'/><child link='tip'/>"
        "<origin xyz='0.5 0 0' rpy='0.3 0.2 0.1'/><axis xyz='0 0 1'/>"
        "<limit lower='-1' upper='1' effort='9' velocity='9'/></joint>"
    )
    base, upper = link("base", 5, 1, 1, 1), link("arm", 2, 0.2, 0.2, 0.2)
    return f"<robot name='r'>{base}{upper}{tip}{hinge}{end}</robot>"


def export(name, tmp_path, text):
    path = tmp_path / "r.urdf"
    path.write_text(text)
    return getattr(api, f"export_{name}")(api.load(path), verify=name != "sdf")


def codes(written):
    return {loss.code for loss in written.losses}


@pytest.mark.parametrize("name", FORMATS)
def test_noise_is_not_inconsistent(name, tmp_path):
    """A tensor of -5e-20 kg·m² is that of a point mass, computed with rounding."""
    written = export(name, tmp_path, arm(link("tip", 0.1, -5.42e-20, -5.42e-20, 0)))
    assert not codes(written) & {"inertia-triangle-inequality", "lossy-inertia"}


@pytest.mark.parametrize("name", FORMATS)
def test_rounding_of_written_numbers_is_lifted_and_reported(name, tmp_path):
    written = export(name, tmp_path, arm(link("tip", 1, 0.01, 0.01, 0.0201), "revolute"))
    assert "lossy-inertia" in codes(written)


@pytest.mark.parametrize("name", FORMATS)
def test_more_than_rounding_is_refused(name, tmp_path):
    with pytest.raises(UrdftoolError, match="physically inconsistent"):
        export(name, tmp_path, arm(link("tip", 1, 0.01, 0.01, 0.03), "revolute"))


@pytest.mark.parametrize("name", FORMATS[1:])
def test_the_surplus_of_a_fixed_link_moves(name, tmp_path):
    written = export(name, tmp_path, arm(link("tip", 1, 0.01, 0.01, 0.05)))
    (moved,) = [loss for loss in written.losses if loss.code == "lossy-inertia-moved"]
    assert "link 'tip' is physically inconsistent" in moved.message
    assert "moved to link 'arm', which is welded to it" in moved.message
    assert {check.verdict for check in written.checks} <= {"equal", "announced", "none"}


def test_the_total_stays():
    turned = rotation_from_rpy((0.3, 0.2, 0.1))
    bodies = {
        "a": SpatialInertia(2.0, ZERO, (0.2, 0, 0, 0.2, 0, 0.2)),
        "b": SpatialInertia(1.0, (0.1, 0, 0), (0.01, 0, 0, 0.01, 0, 0.05)),
        "c": SpatialInertia(1.0, ZERO, (0.01, 0, 0, 0.01, 0, 0.09)),
    }
    before = dict(bodies)
    rotations = {"a": IDENTITY.rotation, "b": turned, "c": turned}
    moves = move_surplus(bodies, rotations, ["b", "c"], "a", find_nearest_consistent)
    assert [(one.link, one.taker) for one in moves] == [("b", "a"), ("c", "a")]
    assert all(map(is_consistent, bodies.values()))

    def total(parts):
        return sum(
            np.array(rotations[name]).reshape(3, 3)
            @ to_matrix(body.tensor)
            @ np.array(rotations[name]).reshape(3, 3).T
            for name, body in parts.items()
        )

    assert np.allclose(total(before), total(bodies), atol=1e-15)


def test_a_surplus_that_no_link_can_take_stays():
    bodies = {
        "a": SpatialInertia(1.0, ZERO, (1e-4, 0, 0, 1e-4, 0, 1e-4)),
        "b": SpatialInertia(1.0, ZERO, (0.01, 0, 0, 0.01, 0, 0.9)),
    }
    before = dict(bodies)
    rotations = dict.fromkeys(bodies, IDENTITY.rotation)
    assert move_surplus(bodies, rotations, ["b"], "a", find_nearest_consistent) == []
    assert bodies == before
