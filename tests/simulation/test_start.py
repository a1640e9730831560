"""A simulation starts at the home of ``export mjcf``."""

import pytest

from tests.formats.mjcf.robots import export, find, tree
from tests.formats.test_standing_pose import CORNERS, quadruped
from urdftool.api.start import choose_start
from urdftool.model.load import load
from urdftool.simulation.settings import Settings

HEAD = (
    '<joint name="neck" type="revolute"><parent link="base"/><child link="head"/>'
    '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="5" velocity="1"/></joint>'
    '<link name="head"/><ros2_control name="h" type="system"><joint name="neck">'
    '<state_interface name="position"><param name="initial_value">0.25</param></state_interface>'
    "</joint></ros2_control>"
)


@pytest.fixture
def dog(write):
    return write("dog.urdf", quadruped((-2.7, -0.9), (-1, 3), HEAD))


def test_the_start_is_the_home_of_the_export(dog):
    settings, notes = choose_start(load(dog), Settings())
    key = find(tree(export(dog)), "key", "home")
    home = [float(word) for word in key.get("qpos").split()][7:]
    names = [f"{leg}_{part}" for leg in CORNERS for part in ("hip", "knee")]
    assert [settings.pose[name] for name in (*names, "neck")] == pytest.approx(home, abs=1e-6)
    assert [note.code for note in notes] == ["lossy-standing"]
    again, more = choose_start(load(dog), settings)
    assert (again, more) == (settings, [])


@pytest.mark.parametrize(
    ("choices", "pose"),
    [
        ({"pose": {"fl_knee": -1.0}}, {"fl_knee": -1.0, "neck": 0.25}),
        ({"pose": {"fl_knee": -1.0, "neck": 0.0}}, {"fl_knee": -1.0, "neck": 0.0}),
        ({"fixed_base": True}, {"neck": 0.25}),
        ({"pose": {"nee": 1.0}}, {"nee": 1.0}),
    ],
)
def test_the_user_comes_first(dog, choices, pose):
    assert choose_start(load(dog), Settings(**choices))[0].pose == pose


def test_a_robot_with_bent_legs_stands(dog):
    import urdftool

    pytest.importorskip("pybullet")
    (verdict,) = urdftool.simulate(urdftool.load(dog), engine="pybullet")
    assert not [fault.kind for fault in verdict.faults if fault.severity.name == "ERROR"]
