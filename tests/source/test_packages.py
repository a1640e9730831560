from pathlib import Path

import pytest

from urdftool.errors import PackageNotFound
from urdftool.source.install_rules import read_install_rules
from urdftool.source.packages import Packages, find_own_package
from urdftool.workspace import Workspace


def package(folder: Path, name: str, cmake: str = "") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(
        f"<package><!-- <name>wrong</name> --><name> {name} </name></package>"
    )
    if cmake:
        (folder / "CMakeLists.txt").write_text(cmake)
    return folder


def robot(folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "robot.urdf"
    file.write_text("<robot name='r'/>")
    return file


def test_the_files_own_package_is_found_by_its_name_not_its_folder(tmp_path):
    home = package(tmp_path / "src" / "folder", "my_robot")
    file = robot(home / "urdf")
    assert Packages(file).find("my_robot") == home
    assert find_own_package(file) == ("my_robot", home)


def test_packages_beside_and_below_the_workspace_are_found(tmp_path):
    home = package(tmp_path / "ws" / "src" / "repo_a" / "arm", "arm")
    beside = package(tmp_path / "ws" / "src" / "repo_a" / "meshes", "arm_meshes")
    far = package(tmp_path / "ws" / "src" / "repo_b" / "deep" / "hand", "hand")
    (tmp_path / "ws" / "src" / ".git").mkdir()
    finder = Packages(robot(home / "urdf"))
    assert finder.find("arm_meshes") == beside
    assert finder.find("hand") == far


def test_ignored_and_built_folders_are_passed_over(tmp_path):
    home = package(tmp_path / "ws" / "arm", "arm")
    package(tmp_path / "ws" / "build" / "hand", "hand")
    package(tmp_path / "ws" / "old" / "hand", "hand")
    (tmp_path / "ws" / "old" / "COLCON_IGNORE").touch()
    with pytest.raises(PackageNotFound):
        Packages(robot(home)).find("hand")


def test_what_the_user_says_comes_first(tmp_path):
    home = package(tmp_path / "ws" / "arm", "arm")
    named = package(tmp_path / "other", "arm")
    below = package(tmp_path / "more" / "x" / "arm", "arm")
    file = robot(home)
    assert Packages(file, named={"arm": named}).find("arm") == named
    assert Packages(file, paths=[tmp_path / "more"]).find("arm") == below
    assert Packages(file, configured={"arm": named}).find("arm") == home
    assert Packages(file, configured={"hand": named}).find("hand") == named


def test_the_environment_of_ros_counts(tmp_path, monkeypatch):
    file = robot(tmp_path / "a" / "b" / "c")
    one = package(tmp_path / "ros1" / "arm", "arm")
    two = package(tmp_path / "ros2" / "share" / "hand", "hand")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "ros1"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "ros2"))
    assert Packages(file).find("arm") == one
    assert Packages(file).find("hand") == two


def test_a_folder_above_that_bears_the_name_is_the_last_resort(tmp_path):
    file = robot(tmp_path / "panda_description" / "urdf")
    assert Packages(file).find("panda_description") == tmp_path / "panda_description"


def test_what_is_not_found_says_where_it_was_looked_for(tmp_path):
    home = package(tmp_path / "ws" / "arm", "arm")
    with pytest.raises(PackageNotFound, match="--package hand=DIR") as caught:
        Packages(robot(home), paths=[tmp_path]).find("hand")
    notes = "\n".join(caught.value.notes)
    for word in (str(tmp_path), "own package 'arm'", "ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
        assert word in notes


CMAKE = """
cmake_minimum_required(VERSION 3.8)
project(demo) # install(DIRECTORY wrong DESTINATION share/demo)
set(WHERE share/${PROJECT_NAME})
install(
  DIRECTORY description/urdf description/config/
  DESTINATION share/${PROJECT_NAME}
)
install(FILES data/limits.yaml DESTINATION ${WHERE}/params RENAME joint_limits.yaml)
install(DIRECTORY include/ DESTINATION include)
install(TARGETS lib EXPORT x LIBRARY DESTINATION lib)
"""


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("arm_descripton", "arm_description"),
        ("arm_descriptions", "arm_description"),
        ("ur_descripton", ""),
        ("pr2_description", ""),
    ],
)
def test_the_package_with_the_nearest_name_is_suggested(tmp_path, name, meant):
    home = package(tmp_path / "ws" / "arm_description", "arm_description")
    assert Packages(robot(home)).suggest_package(name) == meant


def test_install_rules_are_followed(tmp_path):
    home = package(tmp_path / "demo", "demo", CMAKE)
    file = robot(home / "description" / "urdf")
    (home / "description" / "config").mkdir()
    (home / "description" / "config" / "pid.yaml").touch()
    (home / "data").mkdir()
    (home / "data" / "limits.yaml").touch()
    finder = Packages(file)
    assert finder.resolve("package://demo/urdf/robot.urdf") == file
    assert finder.resolve("package:///demo/urdf/robot.urdf") == file
    assert finder.resolve("package://demo/pid.yaml") == home / "description/config/pid.yaml"
    assert finder.resolve("model://demo/params/joint_limits.yaml") == home / "data/limits.yaml"
    assert finder.resolve("package://demo/urdf/absent.stl") == home / "urdf/absent.stl"


def test_catkin_destinations_are_known(tmp_path):
    home = package(
        tmp_path / "demo",
        "demo",
        "project(demo)\ninstall(DIRECTORY urdf DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})",
    )
    assert [rule.target for rule in read_install_rules(home, "demo", Workspace())] == ["./urdf"]


def test_uris_and_relative_paths(tmp_path):
    file = robot(tmp_path / "urdf")
    finder = Packages(file)
    assert finder.resolve("meshes/a.stl") == tmp_path / "urdf" / "meshes" / "a.stl"
    assert finder.resolve("file:///x/a.stl") == Path("/x/a.stl")
    assert finder.resolve("/x/a.stl") == Path("/x/a.stl")


def test_a_package_under_a_former_name_is_offered(tmp_path):
    home = package(tmp_path / "ws" / "arm_description", "arm_description")
    (home / "meshes").mkdir()
    (home / "meshes" / "base.stl").write_text("")
    finder = Packages(robot(home / "urdf"))
    with pytest.raises(PackageNotFound) as caught:
        finder.resolve("package://arm_support/meshes/base.stl")
    assert "package 'arm_support'" in caught.value.message
    assert caught.value.message.endswith(f"--package arm_support={home}")
    with pytest.raises(PackageNotFound, match="--package arm_support=DIR"):
        finder.resolve("package://arm_support/meshes/other.stl")


def test_a_package_is_offered_where_a_neighbour_has_the_file(tmp_path):
    home = package(tmp_path / "ws" / "arm", "arm")
    beside = package(tmp_path / "ws" / "meshes", "arm_meshes")
    (beside / "base.stl").write_text("")
    with pytest.raises(PackageNotFound, match=f"--package arm_shapes={beside}$"):
        Packages(robot(home / "urdf")).resolve("package://arm_shapes/base.stl")


@pytest.mark.parametrize("inside", [".", "urdf", "urdf/arms"])
def test_a_folder_of_the_name_stands_for_a_package_that_is_not_found(tmp_path, inside):
    home = tmp_path / "panda"
    (home / "meshes" / "collision").mkdir(parents=True)
    (home / "meshes" / "collision" / "base.obj").write_text("")
    (home / ".git").mkdir()
    finder = Packages(robot(home / inside))
    found = finder.resolve("package://meshes/collision/base.obj")
    assert found == home / "meshes" / "collision" / "base.obj"
    assert finder.assumed == {"meshes": home / "meshes"}
    assert finder.resolve("package://meshes/lost.obj") == home / "meshes" / "lost.obj"
    with pytest.raises(PackageNotFound):
        finder.find("meshes")


def test_of_two_folders_of_the_name_none_is_taken(tmp_path):
    for home in (tmp_path / "panda", tmp_path / "panda" / "urdf"):
        (home / "meshes").mkdir(parents=True)
        (home / "meshes" / "base.obj").write_text("")
    finder = Packages(robot(tmp_path / "panda" / "urdf"))
    with pytest.raises(PackageNotFound, match="--package meshes="):
        finder.resolve("package://meshes/base.obj")
    assert finder.assumed == {}


def test_a_package_of_the_name_comes_before_a_folder(tmp_path):
    home = package(tmp_path / "ws" / "panda", "panda")
    other = package(tmp_path / "ws" / "shapes", "meshes")
    (home / "meshes").mkdir()
    (home / "meshes" / "base.obj").write_text("")
    finder = Packages(robot(home))
    assert finder.resolve("package://meshes/base.obj") == other / "base.obj"


def test_no_file_outside_is_offered(tmp_path):
    home = package(tmp_path / "ws" / "arm", "arm")
    (tmp_path / "secret").write_text("")
    with pytest.raises(PackageNotFound, match="--package p=DIR"):
        Packages(robot(home / "urdf")).resolve("package://p/../../../../secret")
