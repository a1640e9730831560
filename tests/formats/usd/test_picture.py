"""A robot drawn from its stage and from its URDF."""

import numpy as np
import pytest

from tests.conftest import FIXTURES, ROOT

pytestmark = [pytest.mark.library("pxr"), pytest.mark.library("PIL")]

ROBOT = FIXTURES / "robots/my_robot/urdf/mobile_manipulator.urdf.xacro"
POSE = ("--pose", "shoulder_joint=0.5", "--pose", "elbow_joint=1.2", "--size", "160x120")


def test_the_picture_of_a_stage_is_that_of_the_urdf(urdftool, tmp_path):
    from PIL import Image

    stage = tmp_path / "robot.usdc"
    assert urdftool("export", "usd", str(ROBOT), "-o", str(stage)).code == 0
    pictures = []
    for name, source in (("urdf", ROBOT), ("usd", stage)):
        path = tmp_path / f"{name}.png"
        assert urdftool("view", str(source), *POSE, "--picture", str(path)).code == 0
        pictures.append(np.asarray(Image.open(path).convert("RGB")).astype(int))
    assert np.ptp(pictures[0]) > 100
    assert (pictures[0] == pictures[1]).all()


def test_the_picture_of_the_page_is_there():
    assert "view_stage.png" in (ROOT / "docs/formats/usd.md").read_text("utf-8")
    assert (ROOT / "docs/pictures/view_stage.png").stat().st_size < 200_000
