"""A loop that Gazebo closes is open in PyBullet, which is said; MuJoCo closes it."""

import pytest

from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

BAR = (
    '<link name="{0}"><inertial><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" '
    'iyz="0" izz="0.01"/></inertial><collision><geometry><box size="0.1 0.1 0.1"/></geometry>'
    "</collision></link>"
)
HINGE = (
    '<joint name="{0}" type="continuous"><parent link="base"/><child link="{0}_bar"/>'
    '<origin xyz="0 {1} 0"/><axis xyz="0 1 0"/></joint>'
)
CLOSED = (
    '<gazebo><joint name="closing" type="revolute"><parent>left_bar</parent>'
    "<child>right_bar</child><axis><xyz>0 1 0</xyz></axis></joint></gazebo>"
)


@pytest.mark.parametrize(("engine", "said"), [("pybullet", ["closing"]), ("mujoco", [])])
def test_what_engine_leaves_a_loop_open(tmp_path, engine, said):
    path = tmp_path / "robot.urdf"
    links = "".join(BAR.format(name) for name in ("base", "left_bar", "right_bar"))
    path.write_text(
        f'<robot name="r">{links}{HINGE.format("left", 0.2)}{HINGE.format("right", -0.2)}'
        f"{CLOSED}</robot>"
    )
    robot = load(path)
    (run,) = simulate(robot, Settings(duration=0.1), engine=engine)
    assert [fault.name for fault in judge(robot, run).faults if fault.code == "loop-open"] == said
