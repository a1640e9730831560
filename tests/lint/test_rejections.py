"""What readers do with the robot as a whole, at the end of the report."""

import pytest

HEAD = '<robot name="r"><link name="a"/>'
JOINT = (
    '<joint name="j" type="{}"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
)
LINK = '<link name="b"><inertial><mass value="{}"/>' + (
    '<inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial></link>'
)
SOUND = HEAD + LINK.format(1) + JOINT.format("revolute")
UNKNOWN = HEAD + LINK.format(1) + JOINT.format("hinge")
MASSLESS = HEAD + LINK.format(0) + JOINT.format("revolute")


@pytest.mark.parametrize(
    ("text", "rejecting", "accepting"),
    [
        (SOUND, (), ("urdfdom", "mujoco", "pybullet", "gz")),
        (UNKNOWN, ("urdfdom", "gz"), ()),
        (MASSLESS, ("mujoco",), ("urdfdom",)),
    ],
)
def test_the_last_lines_name_the_readers_that_reject(
    tmp_path, urdftool, text, rejecting, accepting
):
    path = tmp_path / "r.urdf"
    path.write_text(text)
    err = urdftool("lint", path, "--no-cache").err
    lines = [line for line in err.splitlines() if "the robot: " in line]
    readers = {reader for line in lines for reader in line.split(" reject")[0].split(", ")}
    assert readers.issuperset(rejecting)
    assert readers.isdisjoint(accepting)
    assert all("(r.urdf:1)" in line for line in lines)


def test_readers_of_several_robots_are_counted(tmp_path, urdftool):
    for name, text in (("a", SOUND), ("b", MASSLESS), ("c", MASSLESS)):
        (tmp_path / f"{name}.urdf").write_text(text.replace('"r"', f'"{name}"'))
    (tmp_path / "floor.xml").write_text("<mujoco><worldbody/></mujoco>")  # no robot
    err = urdftool("lint", tmp_path, "--no-cache", "-j", "1").err
    (line,) = (line for line in err.splitlines() if line.endswith("2 of 3 robots"))
    assert "mujoco" in line


def test_the_cache_keeps_them(tmp_path, urdftool):
    path = tmp_path / "r.urdf"
    path.write_text(MASSLESS)
    first, second = (urdftool("lint", path, "--cache-dir", tmp_path / "c").err for _ in range(2))
    assert first == second
    assert "mujoco" in first
