import pytest

from urdftool import check

TWO = """<robot name="r">
  <link name="a"/>
  <link name="b">
    <inertial>
      <mass value="1"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>
    </inertial>
  </link>
  <joint name="j" type="continuous">
    <parent link="a"/>
    <child link="b"/>
    <axis xyz="0 0 2"/>
  </joint>
</robot>
"""


@pytest.fixture
def robot(write):
    return write("src/r.urdf", TWO)


def rules(path, **options):
    return {(f.code, f.severity.label) for f in check(path, **options)}


def config(write, text, name="urdftool.toml"):
    return write(name, text)


def test_the_nearest_configuration_above_the_file_holds(robot, write):
    assert ("axis-not-unit", "warning") in rules(robot)
    config(write, '[lint]\nignore = ["axis-not-unit"]\n')
    assert not {r for r, _ in rules(robot)} & {"axis-not-unit"}
    config(write, "[lint]\n", "src/.urdftool.toml")
    assert ("axis-not-unit", "warning") in rules(robot)


def test_pyproject_has_it_under_tool(robot, write):
    config(
        write, '[tool.other]\nx = 1\n[tool.urdftool.lint]\nselect = ["tree"]\n', "pyproject.toml"
    )
    assert "axis-not-unit" not in {r for r, _ in rules(robot)}


def test_severity_and_off(robot, write):
    config(write, '[lint.severity]\naxis-not-unit = "error"\n')
    assert ("axis-not-unit", "error") in rules(robot)
    config(write, '[lint.severity]\naxis-not-unit = "off"\n')
    assert "axis-not-unit" not in {r for r, _ in rules(robot)}


def test_thresholds(robot, write):
    config(write, "[lint.axis-not-unit]\ntolerance = 5\n")
    assert "axis-not-unit" not in {r for r, _ in rules(robot)}


def test_per_file_ignores(robot, write):
    config(write, '[lint.per-file-ignores]\n"src/*" = ["joint"]\n')
    assert "axis-not-unit" not in {r for r, _ in rules(robot)}
    config(write, '[lint.per-file-ignores]\n"test/*" = ["joint"]\n')
    assert "axis-not-unit" in {r for r, _ in rules(robot)}


def test_the_command_line_counts_more(robot, write):
    config(write, '[lint]\nselect = ["tree"]\n')
    assert "axis-not-unit" in {r for r, _ in rules(robot, select=["joint"])}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[lint]\nselct = []", "did you mean 'select'?"),
        ('[lint]\nselect = "all"', "must be a list"),
        ('[lint]\nignore = ["zero-axes"]', "did you mean 'zero-axis'?"),
        ('[lint]\ntargets = ["gazbo"]', "no target"),
        ('[lint.severity]\nzero-axis = "fatal"', "there are off, info"),
        ("[lint.zero-axis]\nsize = 1", "it has shortest"),
        ('[lint.zero-axis]\nshortest = "x"', "must be a number"),
        ("[lnt]", "table 'lnt' is unknown"),
        ("[lint", "not valid TOML"),
        ("[packages]\na = 1", "requires entries like"),
    ],
)
def test_a_wrong_configuration_says_what_is_right(robot, write, urdftool, text, message):
    config(write, text)
    result = urdftool("lint", robot)
    assert result.code == 2
    assert message in result.err
    assert "urdftool.toml" in result.err


def test_targets_are_inferred_and_said(robot, urdftool, write):
    assert "(targets: any reader of URDF)" in urdftool("lint", robot).err
    write(
        "src/package.xml",
        "<package><name>p</name><exec_depend>ros_gz_sim</exec_depend>"
        "<export><build_type>ament_cmake</build_type></export></package>",
    )
    assert "(targets: gz, ros2)" in urdftool("lint", robot).err
    assert "(targets: mujoco)" in urdftool("lint", robot, "--target", "mujoco").err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[lnit]", "table 'lnit' is unknown; did you mean 'lint'?"),
        ("[lint]\nselct = []", "there is no option lint.selct; did you mean 'select'?"),
        ("[lint]\nselect = ['zero-axes']", "did you mean 'zero-axis'?"),
        ("[lint]\nextend-select = ['zero-axes']", "did you mean 'zero-axis'?"),
        ("[lint]\nignore = ['inertai']", "did you mean 'inertia'?"),
        ("[lint]\nselect = 'mesh'", "lint.select must be a list of names"),
        ("[lint]\ntargets = ['gazebo-clasic']", "did you mean 'gazebo-classic'?"),
        ("[lint.severity]\nzero-axes = 'info'", "did you mean 'zero-axis'?"),
        ("[lint.severity]\nzero-axis = 'warn'", "is 'warn'; did you mean 'warning'?"),
        ("[lint.severity]\nzero-axis = 3", "is '3'; there are off, info, warning, error"),
        ("[lint.zero-axis]\nshortes = 1", "no threshold 'shortes'; did you mean 'shortest'?"),
        ("[lint.zero-axis]\nlength = 1", "no threshold 'length'; it has shortest"),
        ("[lint.zero-axis]\nshortest = 'a'", "lint.zero-axis.shortest must be a number"),
        ("[lint.zero-axes]\nshortest = 1", "did you mean 'zero-axis'?"),
        ("[lint.per-file-ignores]\n'*' = ['mehs']", "did you mean 'mesh'?"),
        ("[lint.per-file-ignores]\n'*' = [1]", "must be a list of names"),
        ("[lint]\nper-file-ignore = {}", "did you mean 'per-file-ignores'?"),
        ("[[lint.variants]]\nfiel = 'r.urdf'", "no option 'fiel'; did you mean 'file'?"),
        ("[[lint.variants]]\nfile = 'q.urdf'", "file q.urdf does not exist"),
    ],
)
def test_whatever_is_wrong_in_it_names_what_would_be_right(write, urdftool, text, message):
    write("urdftool.toml", text)
    result = urdftool("lint", write("r.urdf", "<robot name='r'/>"))
    assert result.code == 2
    assert message in result.err
    assert "urdftool.toml: " in result.err


@pytest.mark.parametrize(
    "options", [("--select", ""), ("--ignore", "*"), ("--select", "mesh", "--ignore", "mesh")]
)
def test_options_that_leave_no_rule_are_refused(write, urdftool, options):
    result = urdftool("lint", write("r.urdf", "<robot name='r'><link/></robot>"), *options)
    assert result.code == 2
    assert "leave no rule" in result.err
    assert "no findings" not in result.err


@pytest.mark.parametrize(
    "text",
    ["[lint]\nselect = []", "[lint]\nignore = ['*']", "[lint.per-file-ignores]\n'*' = ['all']"],
)
def test_a_robot_whose_configuration_leaves_no_rule_is_skipped(write, urdftool, text):
    write("urdftool.toml", text)
    result = urdftool("lint", write("r.urdf", "<robot name='r'><link/></robot>"))
    assert result.err.endswith("r.urdf: skipped, its configuration leaves no rule\n")
    assert urdftool("lint", write("s.urdf", "<robot")).code == 2
