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

ALLOWED = 4
"""How many of the 68 may have differences, all of them announced."""


def robots():
    try:
        files = metadata.distribution("example-robot-data").files or ()
    except metadata.PackageNotFoundError:
        return []
    found = [Path(str(file.locate())) for file in files if file.suffix == ".urdf"]
    return sorted(path for path in found if b"<link" in path.read_bytes())


@pytest.mark.skipif(not robots(), reason="example-robot-data is not installed")
@pytest.mark.parametrize(
    ("choices", "allowed"),
    [
        ({}, ALLOWED),
        ({"fixed_joints": "lump"}, ALLOWED),
        ({"target": "gazebo-classic"}, 68),
        ({"target": "gazebo-classic", "version": "1.6"}, 68),
    ],
)
def test_all_are_the_same_robots(choices, allowed, tmp_path):
    other = []
    for path in robots():
        robot = load(path, package_paths=[path.parents[3].parent])
        options = Options(force=True, uri="file", file="m.sdf", **choices)
        written = write(robot, options)
        place = tmp_path / "m.sdf"
        place.write_bytes(written.files["m.sdf"])
        checks = compare(read_pair(robot, written, place, options))
        assert is_faithful(checks), (path, [check.differing for check in checks])
        if any(check.verdict not in WITHOUT_DIFFERENCE for check in checks):
            other.append(path.stem)
    assert len(other) <= allowed, other
