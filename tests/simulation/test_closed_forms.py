"""A falling, a resting, a rolling and a swinging body against closed forms, within 1 %."""

import math

import numpy as np
import pytest

from tests.simulation.robots import body, inertial, runs

G = 9.81
BOX = body('<box size="0.4 0.3 0.2"/>', 2, (0.0216667, 0.0333333, 0.0416667))
SPHERE = body('<sphere radius="0.1"/>', 3, (0.012, 0.012, 0.012))
DISC = (
    (
        f'<robot name="r"><link name="a">{inertial(3, 0.0175, 0.0175, 0.015)}<collision>'
        '<origin rpy="1.5707963267948966 0 0"/><geometry><cylinder radius="0.1" length="0.2"/>'
        "</geometry></collision></link></robot>"
    )
    .replace('izz="0.015"', 'izz="0.0175"')
    .replace('iyy="0.0175"', 'iyy="0.015"')
)


def test_free_fall(write):
    (run,) = runs(write("r.urdf", BOX), height=2.1, duration=1.0, nudge=0.0)
    times, heights = run.recording.times, run.recording.poses[:, 0, 2]
    falling = times < math.sqrt(2 * 2 / G)
    expected = 2.1 - G * times**2 / 2
    assert falling.sum() > 15
    assert np.allclose(heights[falling], expected[falling], atol=0.01 * 2)
    lands = times[np.argmax(heights < 0.101)]
    assert lands == pytest.approx(math.sqrt(2 * 2 / G), abs=0.04)  # a sample later


@pytest.mark.parametrize(
    ("text", "height"), [(BOX, 0.1), (SPHERE, 0.1), (DISC, 0.1)], ids=["box", "sphere", "cylinder"]
)
def test_rest_height(write, text, height):
    (run,) = runs(write("r.urdf", text), nudge=0.0)
    assert run.recording.poses[-1, 0, 2] == pytest.approx(height, rel=0.01)


@pytest.mark.parametrize(
    ("text", "share"), [(SPHERE, 2 / 5), (DISC, 1 / 2)], ids=["ball", "cylinder"]
)
def test_rolling_down_a_slope(write, text, share):
    slope = math.radians(5)
    (run,) = runs(write("r.urdf", text), slope=slope, duration=2.0, nudge=0.0)
    times, along = run.recording.times, run.recording.poses[:, 0, 0]
    expected = G * math.sin(slope) / (1 + share) * times**2 / 2
    assert along[-1] == pytest.approx(expected[-1], rel=0.01)


def test_pendulum_period(write):
    mass, length, own = 1.5, 0.5, 0.02
    text = (
        '<robot name="r"><link name="world"/><link name="bob">'
        f"{inertial(mass, own, own, own, f'0 0 -{length}')}</link>"
        '<joint name="j" type="continuous"><origin xyz="0 0 2"/><parent link="world"/>'
        '<child link="bob"/><axis xyz="0 1 0"/></joint></robot>'
    )
    (run,) = runs(write("r.urdf", text), hold="none", pose={"j": 0.05}, duration=10.0, nudge=0.0)
    times, angles = run.recording.times, run.recording.positions[:, 0]
    down = np.flatnonzero((angles[:-1] > 0) & (angles[1:] <= 0))
    crossings = times[down] + (times[1] - times[0]) * angles[down] / (
        angles[down] - angles[down + 1]
    )
    expected = 2 * math.pi * math.sqrt((own + mass * length**2) / (mass * G * length))
    assert np.diff(crossings).mean() == pytest.approx(expected, rel=0.01)
    energy = run.recording.kinetic + run.recording.potential
    assert np.ptp(energy) < 0.05 * mass * G * length * (1 - math.cos(0.05))


def test_the_same_bit_for_bit(write):
    path = write("r.urdf", BOX)
    first, second = (runs(path, trials=2, seed=3)[1].recording for _ in range(2))
    for name in ("times", "poses", "velocities", "kinetic", "potential"):
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes()


def test_a_cylinder_that_lies_on_the_level_does_not_begin_to_roll(write):
    (run,) = runs(write("r.urdf", DISC))
    assert run.recording.still_since is not None
    assert np.abs(run.recording.poses[-1, 0, :2]).max() < 0.002


def test_damping_that_the_timestep_does_not_bear_is_told(write):
    text = (
        '<robot name="r"><link name="world"/><link name="bob">'
        f"{inertial(0.1, 1e-4, 1e-4, 1e-4, '0 0 -0.1')}</link>"
        '<joint name="j" type="continuous"><origin xyz="0 0 2"/><parent link="world"/>'
        '<child link="bob"/><axis xyz="0 1 0"/><dynamics damping="5"/></joint></robot>'
    )
    (run,) = runs(write("r.urdf", text), hold="none", pose={"j": 1.0}, duration=0.1)
    # half of the inertia about the joint, over the timestep
    assert run.recording.capped["j"] == pytest.approx((1e-4 + 0.1 * 0.01) / 2 / 0.002, rel=0.01)
