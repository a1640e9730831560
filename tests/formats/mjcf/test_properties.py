"""Robots at random: what MuJoCo makes of the export is the robot, whatever it is."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.formats.mjcf.test_verify import ADDED
from urdftool.compare.check import WITHOUT_DIFFERENCE, is_faithful
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.write import write as write_mjcf
from urdftool.model.load import load
from urdftool.report.exports import format_check_table

from .robots import joint, robot

pytest.importorskip("mujoco")

from urdftool.formats.mjcf.verify import verify_copy

KINDS = ("revolute", "continuous", "prismatic", "fixed", "fixed")


def text(numbers):
    return " ".join(repr(float(number)) for number in numbers)


def inertial(random, possible):
    """Mass properties of points at random, or with a moment that is too large for any."""
    points = random.normal(size=(5, 3)) * 10.0 ** random.uniform(-3, 0)
    tensor = sum(p @ p * np.eye(3) - np.outer(p, p) for p in points)
    if not possible:
        tensor[2, 2] *= 3
    xx, yy, zz = np.diag(tensor)
    names = {"ixx": xx, "iyy": yy, "izz": zz}
    names |= {"ixy": tensor[0, 1], "ixz": tensor[0, 2], "iyz": tensor[1, 2]}
    inertia = " ".join(f'{name}="{value!r}"' for name, value in names.items())
    return (
        f"<inertial>{origin(random)}<mass value='{10.0 ** random.uniform(-3, 2)!r}'/>"
        f"<inertia {inertia}/></inertial>".replace("np.float64(", "").replace(")", "")
    )


def origin(random):
    return f'<origin xyz="{text(random.normal(size=3))}" rpy="{text(random.normal(size=3) * 2)}"/>'


def at_random(random, odd):
    """A tree of two to seven links."""
    count = int(random.integers(2, 8))
    parts = []
    for index in range(count):
        capsule = '<geometry><capsule radius="0.1" length="0.3"/></geometry>'
        shape = f"<collision>{origin(random)}{capsule}</collision>"
        weighs = random.random() < 0.8
        inside = inertial(random, not odd or random.random() < 0.7) if weighs else ""
        parts.append(f'<link name="l{index}">{inside}{shape}</link>')
        if index == 0:
            continue
        kind = KINDS[int(random.integers(len(KINDS)))]
        low, high = sorted(random.normal(size=2))
        inside = (
            (
                f'{origin(random)}<axis xyz="{text(random.normal(size=3))}"/>'
                f'<limit lower="{low!r}" upper="{high!r}" effort="2.5" velocity="1"/>'
                f'<dynamics damping="{random.random()!r}" friction="0.5"/>'
            )
            .replace("np.float64(", "")
            .replace(")", "")
        )
        parent = f"l{int(random.integers(index))}"
        parts.append(joint(f"j{index}", parent, f"l{index}", kind, inside))
    return robot(*parts)


def check_a_random_robot(write, odd, seed):
    random = np.random.default_rng(seed)
    found = load(write("r.urdf", at_random(random, odd)))
    base = ("fixed", "free")[int(random.integers(2))]
    options = Options(base=base, fix_inertia="lift" if odd else "none")
    written = write_mjcf(found, options)
    checks = verify_copy(found, options, written)
    same_robot = [check for check in checks if check.name != "runs"]  # random masses may diverge
    assert is_faithful(same_robot), format_check_table(checks)
    exact = {"lossy-inertia", "lossy-massless"}.isdisjoint(loss.code for loss in written.losses)
    if exact:
        added = {*ADDED, "joint physics"}  # stops of joints with servos are added to the source
        verdicts = {check.verdict for check in same_robot if check.name not in added}
        assert verdicts <= WITHOUT_DIFFERENCE, format_check_table(checks)


def random_robots(count):
    """Settings and seeds of a test of random robots."""
    checks = [HealthCheck.function_scoped_fixture]
    made = settings(max_examples=count, deadline=None, suppress_health_check=checks)
    return lambda test: made(given(seed=st.integers(0, 2**32 - 1))(test))


@pytest.mark.parametrize("odd", [False, True])
@random_robots(4)
def test_a_random_robot_is_itself(write, odd, seed):
    check_a_random_robot(write, odd, seed)


@pytest.mark.slow
@pytest.mark.parametrize("odd", [False, True])
@random_robots(100)
def test_many_random_robots_are_themselves(write, odd, seed):
    check_a_random_robot(write, odd, seed)
