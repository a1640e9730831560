"""Elements of plugins that name several joints: some plugins take lists, others one name each."""

from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

ROBOT = """<?xml version="1.0"?>
<robot name="r">
  <link name="a"/>
  <link name="b"/>
  <joint name="one" type="continuous"><parent link="a"/><child link="b"/></joint>
  <link name="c"/>
  <joint name="two" type="continuous"><parent link="a"/><child link="c"/></joint>
  <gazebo>
    <plugin name="{name}" filename="{library}">
      {element}
    </plugin>
  </gazebo>
</robot>
"""
CLASSIC = "libgazebo_ros_joint_state_publisher.so"
GZ = "gz-sim-joint-state-publisher-system"


def _found(tmp_path, library, element):
    path = tmp_path / "r.urdf"
    path.write_text(ROBOT.format(name="p", library=library, element=element))
    report = check_file(path, Options(Settings(select=("plugin-unknown-entity",))))
    return path, [finding.message for finding in report.findings]


def test_a_list_of_joints_that_are_there_is_right(tmp_path):
    assert _found(tmp_path, CLASSIC, "<jointName>one, two</jointName>")[1] == []
    assert _found(tmp_path, CLASSIC, "<jointName>one,two</jointName>")[1] == []


def test_of_a_list_those_are_named_that_are_missing(tmp_path):
    (message,) = _found(tmp_path, CLASSIC, "<jointName>one, twoo, three</jointName>")[1]
    assert "lists 'twoo' and 'three'" in message
    assert "did you mean 'two'?" in message
    assert "'one'" not in message


def test_new_gazebo_takes_one_joint_in_each_element(tmp_path, urdftool):
    path, (message,) = _found(tmp_path, GZ, "<joint_name>one, two</joint_name>")
    assert "write one <joint_name> for each" in message
    select = ("--select", "plugin-unknown-entity", "--fix", "--unsafe-fixes", "--no-cache")
    urdftool("lint", path, *select)
    assert "<joint_name>one</joint_name>\n      <joint_name>two</joint_name>" in path.read_text()
