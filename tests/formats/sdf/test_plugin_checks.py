"""What the plugins of a robot are given is checked by the rules of lint."""

import json

import pytest

from .robots import inertial

ROBOT = f"""\
<robot name="r">
  <link name="a">{inertial()}</link>
  <joint name="wheel" type="continuous"><parent link="a"/><child link="b"/></joint>
  <link name="b">{inertial()}</link>
  <gazebo>
    <plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">
      <left_joint>whel</left_joint>
      <right_joint>wheel</right_joint>
      <wheel_seperation>0.4</wheel_seperation>
    </plugin>
  </gazebo>
</robot>
"""


def test_a_plugin_that_cannot_work_is_a_warning_with_its_place(urdftool, write):
    done = urdftool("export", "sdf", write("r.urdf", ROBOT), "-o", "out")
    assert done.code == 0
    assert "r.urdf:7:7: warning: <left_joint> of plugin" in done.err
    assert "[plugin-unknown-entity]" in done.err
    assert "has the unknown parameter <wheel_seperation>; write <wheel_separation>" in done.err


@pytest.mark.parametrize("name", ["mjcf", "usd"])
def test_exports_that_read_drives_of_plugins_name_it_once(urdftool, write, name):
    pytest.importorskip("mujoco" if name == "mjcf" else "pxr")
    done = urdftool("export", name, write("r.urdf", ROBOT), "-o", "out")
    assert done.code == 0
    assert done.err.count("has no such joint; did you mean 'wheel'? [plugin-unknown-entity]") == 1
    assert "unknown-extension" not in done.err
    assert urdftool("export", name, "r.urdf", "-o", "strict", "--strict").code == 2


def test_strict_refuses_it(urdftool, write, tmp_path):
    done = urdftool("export", "sdf", write("r.urdf", ROBOT), "-o", "out", "--strict")
    assert done.code == 2
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("target", ["gz", "gazebo-classic"])
def test_json_has_it_too(urdftool, write, target):
    words = ["-o", "out", "--target", target, "--format", "json"]
    report = json.loads(urdftool("export", "sdf", write("r.urdf", ROBOT), *words).out)
    found = [f for f in report["findings"] if f["rule"] == "plugin-unknown-entity"]
    assert [(f["severity"], f["line"]) for f in found] == [("warning", 7)]


def test_what_lint_says_of_other_things_stays_with_lint(urdftool, write):
    text = ROBOT.replace("whel<", "wheel<").replace("seperation", "separation")
    done = urdftool("export", "sdf", write("r.urdf", text), "-o", "out")
    assert done.code == 0
    assert "plugin" not in done.err


def test_the_python_function_says_it_too(write):
    import urdftool

    path = write("r.urdf", ROBOT)
    written = urdftool.export_sdf(urdftool.load(path))
    assert "plugin-unknown-entity" in [loss.code for loss in written.losses]


@pytest.mark.parametrize(("joint", "count"), [("whel", 1), ("wheel", 0)])
def test_a_simulation_says_it_too(write, joint, count):
    import urdftool
    from urdftool.simulation.settings import Settings

    pytest.importorskip("mujoco")
    robot = urdftool.load(write("r.urdf", ROBOT.replace("whel<", f"{joint}<")))
    (verdict,) = urdftool.simulate(robot, Settings(duration=0.1), engine="mujoco")
    found = [fault for fault in verdict.faults if fault.code == "plugin-mismatch"]
    assert [fault.rule for fault in found] == ["plugin-unknown-entity"] * count
    assert [fault.severity.label for fault in found] == ["warning"] * count
