"""Robots that a rule leaves out, and remedies that it does not propose."""

import pytest

from urdftool.api.lint import check


def _messages(path, rule, *targets):
    return [finding.message for finding in check(path, select=[rule], targets=targets)]


@pytest.mark.parametrize(
    ("folder", "count"), [("urdf", 1), ("test", 0), ("tests/data", 0), ("contest", 1)]
)
def test_descriptions_of_tests_need_no_dependency(tmp_path, folder, count):
    package = tmp_path / "tests" / "arm_description"
    file = package / folder / "arm.urdf"
    file.parent.mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>arm_description</name></package>")
    file.write_text(
        '<robot name="arm"><link name="base"><visual><geometry>'
        '<mesh filename="package://arm_meshes/arm.stl"/></geometry></visual></link></robot>'
    )
    assert len(_messages(file, "undeclared-mesh-dependency", "ros2")) == count


def test_a_planar_joint_is_reported_with_who_does_not_move_it(tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text(
        '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="planar">'
        '<parent link="a"/><child link="b"/></joint></robot>'
    )
    assert _messages(file, "planar-or-floating") == []
    assert _messages(file, "planar-or-floating", "ros2") == [
        "joint 'j' is planar: Gazebo rejects it, and robot_state_publisher does not move it; "
        "use revolute and prismatic joints, or leave the root free"
    ]


@pytest.mark.parametrize(("kind", "count"), [("planar", 0), ("continuous", 1)])
def test_the_axis_of_a_planar_joint_may_be_omitted(tmp_path, kind, count):
    file = tmp_path / "robot.urdf"
    file.write_text(
        f'<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="{kind}">'
        '<parent link="a"/><child link="b"/></joint></robot>'
    )
    assert len(_messages(file, "axis-omitted")) == count


LINKS = '<link name="a"/><link name="b"/><link name="c"/>'
DRAKE = '<drake:joint name="j" type="ball"><parent link="{}"/><child link="{}"/></drake:joint>'


@pytest.mark.parametrize(
    ("joints", "expected"),
    [
        (
            DRAKE.format("a", "b") + DRAKE.format("b", "c"),
            [
                "links 'b' and 'c' are roots, because only Drake reads the <drake:joint> that "
                "connects them; write <joint> for other readers"
            ],
        ),
        (
            DRAKE.format("a", "b"),
            [
                "link 'b' is a root, because only Drake reads the <drake:joint> that connects "
                "it; write <joint> for other readers",
                "link 'c' and root 'a' have no parent joint; connect them with joints",
            ],
        ),
        (
            DRAKE.format("world", "a"),
            ["links 'b', 'c' and root 'a' have no parent joint; connect them with joints"],
        ),
    ],
)
def test_a_joint_of_drake_joins_links_for_drake_alone(tmp_path, joints, expected):
    file = tmp_path / "robot.urdf"
    file.write_text(f'<robot name="r" xmlns:drake="drake">{LINKS}{joints}</robot>')
    assert _messages(file, "multiple-roots") == expected


@pytest.mark.parametrize(
    ("names", "remedy"),
    [
        (("elbwo",), "; did you mean 'elbow'?"),
        (("elbow", "elbwo"), ""),
        (("finger_3",), ""),
        (("fingr_2",), "; did you mean 'finger_2'?"),
    ],
)
def test_a_transmission_is_not_for_a_joint_that_has_one_or_another_number(tmp_path, names, remedy):
    file = tmp_path / "robot.urdf"
    joints = "".join(
        f'<link name="l_{name}"/><joint name="{name}" type="continuous"><parent link="a"/>'
        f'<child link="l_{name}"/></joint>'
        for name in ("elbow", "finger_1", "finger_2")
    )
    transmissions = "".join(
        f'<transmission name="t_{name}"><joint name="{name}"/></transmission>' for name in names
    )
    file.write_text(f'<robot name="r"><link name="a"/>{joints}{transmissions}</robot>')
    assert _messages(file, "transmission-unknown-joint") == [
        f"transmission 't_{names[-1]}' refers to joint '{names[-1]}', which does not exist{remedy}"
    ]


@pytest.mark.parametrize(
    ("kind", "inside", "remedy"),
    [
        (
            "fixed",
            "<provideFeedback>true</provideFeedback>",
            "remove it, because joint 'j' is fixed and lumped",
        ),
        ("fixed", "<preserveFixedJoint>true</preserveFixedJoint>", "write it for joint 'j'"),
        (
            "fixed",
            '<preserveFixedJoint value="false"/><stopCfm>1</stopCfm>',
            "remove them, because joint 'j' is fixed and lumped",
        ),
        ("continuous", "<provideFeedback>true</provideFeedback>", "write it for joint 'j'"),
    ],
)
def test_what_would_do_nothing_at_a_lumped_joint_is_to_be_removed(tmp_path, kind, inside, remedy):
    file = tmp_path / "robot.urdf"
    file.write_text(
        f'<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="{kind}">'
        '<parent link="a"/><child link="b"/></joint>'
        f'<gazebo reference="b">{inside}</gazebo></robot>'
    )
    (message,) = _messages(file, "misplaced-extension", "gazebo-classic")
    assert message.partition("; ")[2] == remedy


PLUGIN = (
    '<gazebo><plugin name="m" filename="libroboticsgroup_gazebo_mimic_joint_plugin.so">'
    "<joint>lead</joint><mimicJoint>{}</mimicJoint></plugin></gazebo>"
)


@pytest.mark.parametrize(
    ("targets", "plugged", "expected"),
    [
        (("gazebo-classic",), ("one", "two"), []),
        (("gazebo-classic",), ("one",), [{"joints": ["two"], "readers": []}]),
        (
            ("gazebo-classic", "pybullet"),
            ("one", "two"),
            [{"joints": ["one", "two"], "readers": ["PyBullet"]}],
        ),
        (
            ("mujoco", "pybullet"),
            ("one", "two"),
            [{"joints": ["one", "two"], "readers": ["MuJoCo before 4.0", "PyBullet"]}],
        ),
        (("gazebo-classic",), (), [{"joints": ["one", "two"], "readers": []}]),
    ],
)
def test_a_mimic_plugin_moves_its_joints_in_gazebo_classic(tmp_path, targets, plugged, expected):
    file = tmp_path / "robot.urdf"
    joints = "".join(
        f'<link name="l_{name}"/><joint name="{name}" type="continuous"><parent link="a"/>'
        f'<child link="l_{name}"/>{mimic}</joint>'
        for name, mimic in (
            ("lead", ""),
            ("one", '<mimic joint="lead"/>'),
            ("two", '<mimic joint="lead"/>'),
        )
    )
    plugins = "".join(map(PLUGIN.format, plugged))
    file.write_text(f'<robot name="r"><link name="a"/>{joints}{plugins}</robot>')
    found = check(file, select=["mimic-not-simulated"], targets=targets)
    assert [finding.data for finding in found] == expected
