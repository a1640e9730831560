"""Exports from a stage, and to a stage from every format: equal to their source."""

import pytest

from tests.formats.usd.test_verify import ARM

pytestmark = pytest.mark.library("pxr")


@pytest.mark.slow
def test_a_stage_is_exported_to_urdf_and_sdf_and_back(urdftool, write, tmp_path):
    urdf, stage = write("arm.urdf", ARM), tmp_path / "arm.usda"
    assert urdftool("export", "usd", urdf, "-o", str(stage)).code == 0
    for name in ("urdf", "sdf"):
        out = tmp_path / f"{name}.{name}"
        assert urdftool("export", name, str(stage), "-o", str(out)).code == 0
        assert urdftool("verify", str(stage), str(out)).code == 0
        back = tmp_path / f"{name}.usdc"
        assert urdftool("export", "usd", str(out), "-o", str(back)).code == 0
        assert urdftool("verify", urdf, str(back)).code == 0


@pytest.mark.library("mujoco")
def test_a_stage_is_exported_to_mjcf(urdftool, write, tmp_path):
    urdf, stage = write("arm.urdf", ARM), tmp_path / "arm.usda"
    assert urdftool("export", "usd", urdf, "-o", str(stage)).code == 0
    out = tmp_path / "arm.xml"
    assert urdftool("export", "mjcf", str(stage), "-o", str(out), "--verify").code == 0


def test_other_commands_name_the_format(urdftool, write, tmp_path):
    urdf, stage = write("arm.urdf", ARM), tmp_path / "arm.usdc"
    assert urdftool("export", "usd", urdf, "-o", str(stage)).code == 0
    for words in (("expand",), ("inertia", "robot", "--write")):
        result = urdftool(*words, str(stage))
        assert result.code == 2
        assert "USD" in result.err
