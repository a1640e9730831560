"""Pictures and films of runs, and what is refused before anything is simulated."""

import io
import os

import numpy as np
import pytest
from PIL import Image

from tests.conftest import FIXTURES
from urdftool.api.simulate import run_trials as simulate
from urdftool.drawing.gif_file import encode_gif
from urdftool.drawing.shapes import read_robot_shapes
from urdftool.model.kinematics import link_poses as poses_at
from urdftool.model.load import load
from urdftool.simulation.animation import MOST, link_poses, render_animation, render_final_state
from urdftool.simulation.settings import Settings

pytest.importorskip("mujoco")

ROBOTS = FIXTURES / "robots"
MIRA = ROBOTS / "mira_description" / "urdf" / "mira.urdf"


@pytest.fixture(scope="module")
def collapse():
    robot = load(ROBOTS / "ros2_arm" / "urdf" / "robot2_sound.urdf.xacro")
    (run,) = simulate(robot, Settings(hold="none", duration=1.6), engine="mujoco")
    return robot, run, read_robot_shapes(robot)


def test_links_are_where_the_joints_put_them(collapse):
    robot, run, _ = collapse
    got = link_poses(run, run.recording.poses[-1])
    angles = dict(zip(run.recording.joints, run.recording.positions[-1].tolist(), strict=True))
    expected = poses_at(robot, angles)
    root = got[robot.tree.root.name]
    for name, pose in expected.items():
        assert (root @ pose).translation == pytest.approx(got[name].translation, abs=1e-3)


def test_a_picture_shows_where_it_ended(collapse):
    _, run, shapes = collapse
    image = render_final_state(run, shapes, size=(160, 120))
    assert image.shape == (120, 160, 3)
    blue = (image[..., 2].astype(int) - image[..., 0] > 60).any(axis=1)
    assert blue[30:].any()
    assert not blue.all()
    assert (image == render_final_state(run, shapes, size=(160, 120))).all()


def test_a_film_moves_and_ends_where_the_run_does(collapse):
    _, run, shapes = collapse
    told = []
    data = render_animation(run, shapes, size=(48, 36), progress=lambda *n: told.append(n))
    with Image.open(io.BytesIO(data)) as seen:
        assert seen.size == (48, 36)
        assert seen.info["loop"] == 0
        frames, lasts = [], []
        for number in range(seen.n_frames):
            seen.seek(number)
            frames.append(np.array(seen.convert("RGB")).astype(int))
            lasts.append(seen.info["duration"])
    assert told[-1] == (len(told), len(told))
    assert 5 < len(frames) <= len(told) <= MOST
    assert abs(frames[0] - frames[-1]).max() > 60
    assert sum(lasts) / 1000 == pytest.approx(run.recording.times[-1] + 1.0, abs=0.1)


def test_what_stands_still_is_drawn_once():
    robot = load(MIRA)
    (run,) = simulate(robot, Settings(duration=1.0), engine="mujoco")
    data = render_animation(run, read_robot_shapes(robot), size=(96, 72))
    with Image.open(io.BytesIO(data)) as seen:
        assert seen.n_frames < 8


def test_pictures_are_given_back_as_they_were():
    frames = [np.full((8, 10, 3), shade, np.uint8) for shade in (0, 120, 255)]
    with Image.open(io.BytesIO(encode_gif(frames, [0.05, 0.1, 0.5]))) as seen:
        times = []
        for number, frame in enumerate(frames):
            seen.seek(number)
            times.append(seen.info["duration"])
            assert abs(np.array(seen.convert("RGB")).astype(int) - frame).max() < 4
        assert times == [50, 100, 500]


@pytest.mark.slow
def test_the_command_writes_all_three(urdftool, tmp_path):
    files = [tmp_path / name for name in ("a.png", "b.png", "c.gif")]
    result = urdftool(
        *("simulate", MIRA, "--engine", "mujoco", "--duration", "0.3"),
        *("--plot", files[0], "--picture", files[1], "--video", files[2]),
    )
    assert result.code == 1  # not at rest so soon
    for file, kind in zip(files, ("PNG", "PNG", "GIF"), strict=True):
        with Image.open(file) as seen:
            assert seen.format == kind
        assert f"wrote {file}" in result.err


BARE = """<robot name="bare"><link name="a"><inertial><mass value="1"/>
 <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>"""


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--picture", "a.jpg"], "--picture requires a file that ends in .png"),
        (["--video", "a.png"], "--video requires a file that ends in .gif"),
        (["--plot", "bare.urdf/a.png"], "bare.urdf is not a folder"),
        (["--plot", "folder.png"], "is a folder"),
        (["--plot", "a.png", "--picture", "./a.png"], "require different files"),
        (["--video", "a.gif"], "bare.urdf:1:1: the robot has no geometry to draw"),
    ],
)
def test_what_cannot_be_drawn_is_said_before_the_simulation(
    urdftool, write, monkeypatch, options, said
):
    write("bare.urdf", BARE)
    os.mkdir("folder.png")
    monkeypatch.setattr("urdftool.simulation.run.simulate", None)
    result = urdftool("simulate", "--engine", "mujoco", "bare.urdf", *options)
    assert result.code == 2
    assert said in result.err
