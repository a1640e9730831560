import os

from urdftool.model.files import list_sources
from urdftool.viewer.watch import Watch

from .robots import read, urdf


def later(path):
    state = os.stat(path)
    os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns + 1_000_000))


def test_a_change_counts_once_it_rests(tmp_path):
    file = tmp_path / "a"
    file.write_text("one")
    watch = Watch([file])
    assert watch.find_changes() == []
    file.write_text("two, longer")
    assert watch.find_changes() == []  # perhaps more is coming
    file.write_text("three, longer still")
    assert watch.find_changes() == []
    assert watch.find_changes() == [str(file)]
    assert watch.find_changes() == []


def test_a_file_that_comes_or_goes_is_a_change(tmp_path):
    there, missing = tmp_path / "there", tmp_path / "missing"
    there.write_text("x")
    watch = Watch([there, missing])
    there.unlink()
    missing.write_text("y")
    watch.find_changes()
    assert watch.find_changes() == sorted([str(there), str(missing)])


def test_a_file_replaced_by_a_neighbour_is_a_change(tmp_path):
    file, neighbour = tmp_path / "a", tmp_path / "b"
    file.write_text("same")
    watch = Watch([file])
    neighbour.write_text("same")
    os.replace(neighbour, file)
    watch.find_changes()
    assert watch.find_changes() == [str(file)]


def test_what_is_written_while_it_is_read_again_counts(tmp_path):
    file = tmp_path / "a"
    file.write_text("x")
    watch = Watch([file])
    later(file)
    watch.take([file])
    watch.find_changes()
    assert watch.find_changes() == [str(file)]


def test_sources_are_includes_meshes_and_images(tmp_path):
    (tmp_path / "inner.xacro").write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="p" value="1"/>'
        "</robot>"
    )
    text = urdf(
        '<xacro:include filename="inner.xacro"/>',
        '<link name="a"><visual><geometry><mesh filename="missing.obj"/></geometry>'
        '<material name="m"><texture filename="wood.png"/></material></visual></link>',
    ).replace("<robot", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"')
    robot = read(tmp_path / "r.urdf.xacro", text)
    names = {os.path.basename(path) for path in list_sources(robot)}
    assert names == {"r.urdf.xacro", "inner.xacro", "missing.obj", "missing.mtl", "wood.png"}
