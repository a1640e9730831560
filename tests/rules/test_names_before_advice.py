"""Advice and fixes ask who names a part before they change it."""

import pytest

from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

ROBOT = """<robot name="r">
  <link name="base"/>
  <link name="tip"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="tip"/>
    <limit lower="0" upper="0" effort="1" velocity="1"/></joint>
  {block}
</robot>
"""
IMU = '<gazebo><plugin name="imu" filename="libimu.so"><bodyName>tip</bodyName></plugin></gazebo>'
STATE = '<gazebo><plugin name="s" filename="s"><joint_name>turn</joint_name></plugin></gazebo>'
OWN = '<gazebo reference="tip"><mu1>1</mu1></gazebo>'


@pytest.mark.parametrize(
    ("block", "named"), [("", []), (OWN, []), (IMU, ["tip"]), (STATE, ["turn"])]
)
def test_a_locked_joint_that_is_named_does_not_become_fixed(tmp_path, block, named):
    path = tmp_path / "r.urdf"
    path.write_text(ROBOT.format(block=block), "utf-8")
    options = Options(Settings(select=("locked-by-limits",)), fixes=True)
    report = check_file(path, options)
    (finding,) = report.findings
    assert finding.data["named_by"] == named
    assert ("make it fixed" in finding.message) is not bool(named)
    done = fix_description(report, options, unsafe=True)
    assert (b'type="fixed"' in b"".join(done.after.values())) is not bool(named)


def test_a_locked_joint_of_a_controller_does_not_become_fixed(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_text(ROBOT.format(block=""), "utf-8")
    (tmp_path / "controllers.yaml").write_text("joints: [turn]\n", "utf-8")
    options = Options(Settings(select=("locked-by-limits",)), fixes=True)
    report = check_file(path, options)
    assert not fix_description(report, options, unsafe=True).after
