"""The mechanics that exports are compared with, against closed forms."""

import math

import numpy as np
import pytest

from urdftool.mechanics.reference import Mechanics
from urdftool.model.load import load

PENDULUM = """<robot name="p"><link name="base"/>
<link name="rod"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.2"/></inertial></link>
<link name="cart"><inertial><mass value="3"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="base"/><child link="cart"/>
<axis xyz="2 0 0"/><limit lower="-1" upper="1"/></joint>
<joint name="swing" type="revolute"><parent link="cart"/><child link="rod"/>
<origin xyz="0 0 1"/><axis xyz="0 1 0"/><limit lower="-3" upper="3"/></joint></robot>
"""


@pytest.fixture
def cart(write):
    return Mechanics(load(write("cart.urdf", PENDULUM)))


@pytest.mark.parametrize("angle", [0.0, 0.3, -1.2, math.pi])
def test_a_pendulum_on_a_cart(cart, angle):
    q = {"slide": 0.4, "swing": angle}
    # about y, x turns towards -z
    lever = -2 * 0.5 * math.sin(angle)
    assert cart.compute_mass_matrix(q) == pytest.approx(
        np.array([[5, lever], [lever, 0.2 + 2 * 0.25]]), abs=1e-14
    )
    assert cart.compute_gravity(q) == pytest.approx(
        [0, -2 * 9.81 * 0.5 * math.cos(angle)], abs=1e-13
    )
    mass, com, _ = cart.compute_centroid(q)
    assert mass == 5
    expected = (3 * 0.4 + 2 * (0.4 + 0.5 * math.cos(angle))) / 5
    assert com == pytest.approx([expected, 0, 2 * (1 - 0.5 * math.sin(angle)) / 5])


def test_frames(cart):
    frame = cart.compute_frames({"slide": 1.0, "swing": math.pi / 2})["rod"]
    expected = [[0, 0, 1, 1], [0, 1, 0, 0], [-1, 0, 0, 1], [0, 0, 0, 1]]
    assert frame == pytest.approx(np.array(expected), abs=1e-15)
