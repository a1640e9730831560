"""What a rule leaves out: another says it, or nothing is wrong."""

import pytest

from urdftool.api.lint import check
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

ARM = '<link name="base"/><link name="arm"/>'
JOINT = """<joint name="swing" type="{kind}">
  <parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>{more}
</joint>"""


def _messages(tmp_path, inside, rule, *targets):
    path = tmp_path / "r.urdf"
    path.write_text(f'<robot name="r">{inside}</robot>')
    settings = Settings(select=(rule,), targets=frozenset(targets))
    return [finding.message for finding in check_file(path, Options(settings)).findings]


def _joint(kind="revolute", more=""):
    return ARM + JOINT.format(kind=kind, more=more)


@pytest.mark.parametrize("rule", ["missing-dynamics", "implausible-velocity"])
def test_a_joint_that_its_limits_lock_does_not_move(tmp_path, rule):
    limit = '<limit lower="{}" upper="0.5" effort="2" velocity="3000"/>'
    assert len(_messages(tmp_path, _joint(more=limit.format(0.4)), rule, "pybullet")) == 1
    assert not _messages(tmp_path, _joint(more=limit.format(0.5)), rule, "pybullet")


def test_what_slows_a_leader_slows_its_followers(tmp_path):
    robot = _joint("continuous", '<dynamics damping="0.1"/>')
    finger = '<link name="f"/><joint name="follow" type="continuous"><parent link="base"/>'
    finger += '<child link="f"/><axis xyz="0 1 0"/>{}</joint>'
    mimic = '<mimic joint="{}"/>'
    assert not _messages(
        tmp_path, robot + finger.format(mimic.format("swing")), "missing-dynamics", "mujoco"
    )
    for other in ("", mimic.format("nobody")):
        (text,) = _messages(tmp_path, robot + finger.format(other), "missing-dynamics", "mujoco")
        assert text.startswith("joint 'follow' has")


def test_of_two_soft_limits_the_one_beyond_is_named(tmp_path):
    def said(low, high):
        limit = '<limit lower="-1.5" upper="1.5" effort="2" velocity="3"/>'
        soft = f'soft_lower_limit="{low}" soft_upper_limit="{high}" k_velocity="10"'
        more = f"{limit}<safety_controller {soft}/>"
        return _messages(tmp_path, _joint(more=more), "soft-limits-outside-hard", "moveit")

    assert said(-1.6, 1.4) == [
        "soft lower limit -1.6 of joint 'swing' is beyond its lower limit -1.5, so it has no effect"
    ]
    assert said(-1.4, 1.7) == [
        "soft upper limit 1.7 of joint 'swing' is beyond its upper limit 1.5, so it has no effect"
    ]
    (both,) = said(-1.6, 1.7)
    assert both.endswith("are beyond its limits -1.5 to 1.5, so they have no effect")


@pytest.mark.parametrize(("soft", "count"), [("-1.64", 0), ("-1.65", 0), ("-1.66", 1)])
def test_soft_limits_beyond_the_hard_ones_may_still_slow_the_joint(tmp_path, soft, count):
    limit = '<limit lower="-1.5" upper="1.5" effort="2" velocity="3"/>'
    gains = 'k_position="20" k_velocity="10"'
    safety = f'<safety_controller soft_lower_limit="{soft}" soft_upper_limit="1.4" {gains}/>'
    robot = _joint(more=limit + safety)
    assert len(_messages(tmp_path, robot, "soft-limits-outside-hard", "moveit")) == count


@pytest.mark.parametrize(
    ("rule", "soft"),
    [
        ("soft-limits-outside-hard", 'soft_lower_limit="-2" soft_upper_limit="2"'),
        ("soft-limits-far-inside", 'soft_lower_limit="-0.5" soft_upper_limit="0.5"'),
        ("soft-limits-lock-joint", ""),
    ],
)
def test_soft_limits_matter_where_something_reads_them(tmp_path, rule, soft):
    limit = '<limit lower="-1.5" upper="1.5" effort="2" velocity="3"/>'
    robot = _joint(more=f'{limit}<safety_controller {soft} k_velocity="10"/>')
    driven = robot + '<transmission name="t"><joint name="swing"/></transmission>'
    assert not _messages(tmp_path, robot, rule, "mujoco")
    assert len(_messages(tmp_path, robot, rule, "moveit")) == 1
    assert len(_messages(tmp_path, driven, rule, "mujoco")) == 1
    assert len(_messages(tmp_path, robot, rule, "ros2")) == (rule == "soft-limits-lock-joint")


@pytest.mark.parametrize(
    ("least", "rule"),
    [
        ("200", "radius-of-gyration"),
        ("0", "singular-inertia"),
        ("-200", "inertia-not-positive-definite"),
    ],
)
def test_a_tensor_that_no_body_has_is_said_once(tmp_path, least, rule):
    inertia = f'ixx="13400" ixy="0" ixz="0" iyy="13400" iyz="0" izz="{least}"'
    inertial = f'<inertial><mass value="1"/><inertia {inertia}/></inertial>'
    inside = _joint("continuous").replace(
        '<link name="arm"/>', f'<link name="arm">{inertial}</link>'
    )
    for one in ("radius-of-gyration", "singular-inertia", "inertia-not-positive-definite"):
        assert len(_messages(tmp_path, inside, one)) == (one == rule)


def test_a_joint_of_an_unknown_type_is_not_asked_for_its_effort(tmp_path):
    rule = "limit-without-effort-or-velocity"
    limit = '<limit lower="-1" upper="1" effort="2"/>'
    for kind in ("revolute", "continuous", "fixed"):
        assert len(_messages(tmp_path, _joint(kind, limit), rule)) == 1
    assert not _messages(tmp_path, _joint("spherical", limit), rule)
    assert _messages(tmp_path, _joint("spherical", limit), "unknown-joint-type")


def test_both_frictions_of_a_block_are_one_finding(tmp_path):
    def said(inside):
        block = f'<gazebo reference="arm">{inside}</gazebo>'
        rule = "implausible-friction"
        return _messages(tmp_path, _joint("continuous") + block, rule, "gazebo-classic")

    assert said("<mu1>100</mu1><mu2>50</mu2>") == [
        "mu1 of 'arm' is 100 and mu2 is 50; rubber on concrete has about 1"
    ]
    assert said("<mu1>1</mu1><mu2>50</mu2>") == [
        "mu2 of 'arm' is 50; rubber on concrete has about 1"
    ]
    assert said("<mu1>-1</mu1><mu2>50</mu2><kp>0</kp>") == [
        "mu2 of 'arm' is 50; rubber on concrete has about 1",
        "kp of 'arm' is 0, so contacts do not support the link; the default is 1e12",
    ]


def test_an_old_name_beside_the_new_one_is_to_be_removed(tmp_path):
    def said(inside):
        block = f'<gazebo reference="swing"><cfmDamping>1</cfmDamping>{inside}</gazebo>'
        rule = "deprecated-cfm-damping"
        return _messages(tmp_path, _joint("continuous") + block, rule, "gazebo-classic")

    assert said("") == ["cfmDamping is deprecated; write implicitSpringDamper"]
    assert said("<implicitSpringDamper>1</implicitSpringDamper>") == [
        "cfmDamping is deprecated, and the block has implicitSpringDamper; remove it"
    ]


def test_the_state_of_a_command_may_be_in_another_block(tmp_path):
    def said(state):
        blocks = ""
        for kind, inside in (
            ("actuator", '<command_interface name="position"/>'),
            ("sensor", f'<state_interface name="{state}"/>'),
        ):
            plugin = "<hardware><plugin>a/B</plugin></hardware>"
            joint = f'<joint name="swing">{inside}</joint>'
            blocks += f'<ros2_control name="{kind}" type="{kind}">{plugin}{joint}</ros2_control>'
        return _messages(tmp_path, _joint("continuous") + blocks, "command-without-state", "ros2")

    assert not said("position")
    assert said("velocity") == [
        "joint 'swing' has the command interface 'position' but no such state interface"
    ]


def test_a_robot_without_elements_needs_no_name(tmp_path):
    def said(text):
        path = tmp_path / "part.urdf"
        path.write_text(text)
        found = check_file(path, Options(Settings(select=("missing-name",)))).findings
        return [finding.message for finding in found]

    assert not said("<robot/>")
    assert not said("<robot><!-- later --></robot>")
    assert said('<robot><link name="a"/></robot>') == ['<robot> has no name; write name="…"']


@pytest.mark.parametrize("link", ["base", "arm"])
def test_a_slide_on_a_beam_of_its_length_is_in_meters(tmp_path, link):
    def said(length):
        limit = '<limit lower="0" upper="40" effort="2" velocity="3"/>'
        inside = _joint("prismatic", limit)
        for name in ("base", "arm"):
            size = f"{length if name == link else 0.1} 0.1 0.1"
            shape = f'<visual><geometry><box size="{size}"/></geometry></visual>'
            inside = inside.replace(f'<link name="{name}"/>', f'<link name="{name}">{shape}</link>')
        return _messages(tmp_path, inside, "prismatic-in-millimeters")

    assert not said(42)
    assert len(said(0.1)) == 1


@pytest.mark.parametrize(("damping", "severity"), [('damping="1" ', []), ("", ["warning"])])
def test_further_parameters_of_dynamics_are_a_remark(tmp_path, damping, severity):
    file = tmp_path / "robot.urdf"
    more = f'<dynamics {damping}friction="0.1" mu_coulomb="0" K="7000"/>'
    file.write_text(f'<robot name="r">{_joint("continuous", more=more)}</robot>')
    found = check(file, select=["unknown-attribute"])
    assert [finding.severity.label for finding in found] == severity


@pytest.mark.parametrize(
    ("driven", "effort", "rules"),
    [
        ("", 1, ["implausible-velocity"]),
        ("", 0, ["zero-effort-limit"]),
        ("swing", 1, ["implausible-velocity"]),
        ("swing", 0, ["zero-effort-limit"]),
        ("other", 1, ["implausible-velocity"]),
        ("other", 0, []),
        ("measured", 1, []),
    ],
)
def test_nothing_is_asked_of_a_joint_that_is_left_passive(tmp_path, driven, effort, rules):
    limit = f'<limit lower="-1" upper="1" effort="{effort}" velocity="3000"/>'
    other = '<link name="tip"/><joint name="other" type="continuous"><parent link="arm"/>'
    robot = f'{_joint(more=limit)}{other}<child link="tip"/></joint>'
    if driven == "measured":
        state = '<state_interface name="position"/>'
        robot += f'<ros2_control name="c" type="system"><joint name="swing">{state}</joint>'
        robot += "</ros2_control>"
    elif driven:
        robot += f'<transmission name="t"><joint name="{driven}"/></transmission>'
    found = [
        rule
        for rule in ("implausible-velocity", "zero-effort-limit")
        if _messages(tmp_path, robot, rule, "gz")
    ]
    assert found == rules
