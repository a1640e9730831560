"""Every robot of example-robot-data, kept and lumped, in the frame of every target."""

from importlib import metadata
from pathlib import Path

import pytest

from urdftool.compare.check import WITHOUT_DIFFERENCE, is_faithful
from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.verify.compare import compare, read_pair
from urdftool.formats.sdf.write import write
from urdftool.model.load import load

pytestmark = pytest.mark.slow

ANNOUNCED = {
    "alex_psyonic_hands": {"tree"},  # mimic joints whose leader does not exist
    "hyq_no_sensors": {"sensors"},  # frames that sensors of SDF do not name
    "tiago_pro": {"sensors"},
    "icub": {"inertia"},  # a tensor of 1e-18 kg·m² is lifted
    "icub_reduced": {"inertia"},
    "iris_simple": {"mass matrix", "gravity"},  # a floating joint: not compared
    "quadrotor_base": {"mass matrix", "gravity"},
    "pr2": {"looks", "other elements"},  # material scripts, elements of Gazebo before 1.0
    "romeo_laas_small": {
        "inertia",
        "visuals",
        "mass",
        "mass matrix",
    },  # impossible tensors, no mesh
    "romeo_small": {"inertia", "mass matrix"},
}
"""Rows that are announced, or not compared, by robot; all others are equal."""


def robots():
    try:
        files = metadata.distribution("example-robot-data").files or ()
    except metadata.PackageNotFoundError:
        return []
    found = [Path(str(file.locate())) for file in files if file.suffix == ".urdf"]
    return sorted(path for path in found if b"<link" in path.read_bytes())


@pytest.mark.skipif(not robots(), reason="example-robot-data is not installed")
@pytest.mark.parametrize(
    ("choices", "announced"),
    [
        ({}, ANNOUNCED),
        ({"fixed_joints": "lump"}, ANNOUNCED),
        ({"target": "gazebo-classic"}, None),
        ({"target": "gazebo-classic", "version": "1.6"}, None),
    ],
)
def test_all_are_the_same_robots(choices, announced, tmp_path):
    for path in robots():
        robot = load(path, package_paths=[path.parents[3].parent])
        options = Options(force=True, uri="file", file="m.sdf", **choices)
        written = write(robot, options)
        place = tmp_path / "m.sdf"
        place.write_bytes(written.files["m.sdf"])
        checks = compare(read_pair(robot, written, place, options))
        assert is_faithful(checks), (path, [check.differing for check in checks])
        rows = {check.name for check in checks if check.verdict not in WITHOUT_DIFFERENCE}
        assert announced is None or rows <= announced.get(path.stem, set()), path
