"""Joints of SDF in ``<gazebo>`` blocks, and what is left of links and joints in Gazebo."""

import pytest

from urdftool import check

MASS = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
)
BOX = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def link(name, inside=MASS):
    return f'<link name="{name}">{inside}</link>'


def joint(name, kind, parent, child, inside=LIMIT):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<axis xyz="0 0 1"/>{inside}</joint>'
    )


def loop(name, parent, child):
    ends = f"<parent>{parent}</parent><child>{child}</child>"
    return f'<gazebo><joint name="{name}" type="ball">{ends}</joint></gazebo>'


CHAIN = (
    *map(link, "abcd"),
    joint("j", "revolute", "a", "b"),
    joint("k", "revolute", "b", "c"),
    joint("f", "fixed", "c", "d"),
)


def found(write, parts, *rules, targets=("gz",)):
    path = write("r.urdf", f'<robot name="r">{"".join(parts)}</robot>')
    return check(path, select=rules, targets=targets)


def gazebo_of(finding):
    return [says for key, says in finding.effects.items() if "gz" in key.split(", ")]


@pytest.mark.parametrize(
    ("parts", "severity", "says"),
    [
        ((joint("b", "revolute", "a", "b"), joint("k", "revolute", "b", "c")), "error", "reject"),
        ((joint("c", "revolute", "a", "b"), joint("f", "fixed", "b", "c")), "warning", "load"),
        ((joint("c", "fixed", "a", "b"), joint("k", "revolute", "a", "c")), "warning", "load"),
        (
            (
                joint("b", "fixed", "a", "b"),
                joint("k", "revolute", "b", "c"),
                '<gazebo reference="b"><preserveFixedJoint>true</preserveFixedJoint></gazebo>',
            ),
            "error",
            "reject",
        ),
    ],
    ids=["both stay", "the link is lumped", "the joint is lumped", "the joint is preserved"],
)
def test_a_name_that_gazebo_has_twice_rejects_the_model(write, parts, severity, says):
    (finding,) = found(write, (*map(link, "abc"), *parts), "link-joint-name-clash")
    assert finding.severity.label == severity
    assert gazebo_of(finding)[0].startswith(says)


def test_what_gazebo_leaves_out_makes_no_clash(write):
    parts = link("a"), link("b"), link("c", ""), joint("j", "revolute", "a", "b")
    (finding,) = found(write, (*parts, joint("b", "revolute", "b", "c")), "link-joint-name-clash")
    assert gazebo_of(finding) == []


@pytest.mark.parametrize(
    ("name", "count"), [("loop", 0), ("b", 1), ("j", 1), ("world", 1), ("d", 0), ("f", 0)]
)
def test_a_joint_of_sdf_needs_a_name_of_its_own(write, name, count):
    findings = found(write, (*CHAIN, loop(name, "a", "c")), "link-joint-name-clash")
    assert [f.severity.label for f in findings] == ["error"] * count
    assert all(gazebo_of(f)[0].startswith("reject") for f in findings)


def test_of_two_joints_of_sdf_with_one_name_the_second_is_reported(write):
    parts = *CHAIN, loop("loop", "a", "c"), loop("loop", "a", "b")
    (finding,) = found(write, parts, "link-joint-name-clash")
    assert "another joint in <gazebo>" in finding.message


@pytest.mark.parametrize(
    ("child", "severity"), [("c", None), ("d", "warning"), ("gone", "error"), ("world", None)]
)
def test_a_joint_of_sdf_needs_links_that_gazebo_has(write, child, severity):
    findings = found(write, (*CHAIN, loop("loop", "a", child)), "dangling-reference")
    assert [f.severity.label for f in findings] == [severity] * bool(severity)
    assert all(gazebo_of(f)[0].startswith("reject the model") for f in findings)


def test_gazebo_takes_no_inertia_of_a_model_that_it_rejects(write):
    rules = "placeholder-inertia", "dangling-reference", "link-joint-name-clash"
    for extra, taken in ((loop("loop", "a", "c"), True), (loop("b", "a", "c"), False)):
        findings = found(write, (*CHAIN, extra), *rules)
        inertias = [f for f in findings if f.code == "placeholder-inertia"]
        assert inertias
        assert all(bool(gazebo_of(f)) == taken for f in inertias)
    assert not any(
        gazebo_of(f)
        for f in found(write, (*CHAIN, loop("loop", "a", "d")), *rules)
        if f.code == "placeholder-inertia"
    )


@pytest.mark.parametrize(
    ("content", "meant"),
    [
        ("<implicitSpringDamper>1</implicitSpringDamper>", "arm_1_joint"),
        ("<provideFeedback>true</provideFeedback>", "arm_1_joint"),
        ("<kp>1</kp>", "arm_1_link"),
        ('<sensor name="s" type="imu"/>', "arm_1_link"),
    ],
)
def test_settings_of_a_joint_are_meant_for_a_joint(write, content, meant):
    block = f'<gazebo reference="arm_1_lik">{content}</gazebo>'
    block = block.replace("arm_1_lik", "arm_1_join" if "joint" in meant else "arm_1_lin")
    parts = link("base"), link("arm_1_link"), joint("arm_1_joint", "revolute", "base", "arm_1_link")
    (finding,) = found(write, (*parts, block), "dangling-reference")
    assert finding.message.endswith(f"did you mean '{meant}'?")


def test_a_link_is_not_meant_where_the_joint_is_missing(write):
    block = '<gazebo reference="arm_1_joint"><kp>1</kp></gazebo>'.replace(
        "<kp>1</kp>", "<implicitSpringDamper>1</implicitSpringDamper>"
    )
    parts = link("base"), link("arm_1_link"), joint("swing", "revolute", "base", "arm_1_link")
    (finding,) = found(write, (*parts, block), "dangling-reference")
    assert "did you mean" not in finding.message


MIMIC = f'{LIMIT}<mimic joint="j"/>'


def test_a_follower_whose_link_a_joint_of_sdf_holds_does_not_hang_free(write):
    parts = (
        *map(link, "abc"),
        joint("j", "revolute", "a", "b"),
        joint("k", "revolute", "a", "c", MIMIC),
    )
    rule, targets = "mimic-not-simulated", ("gazebo-classic",)
    assert len(found(write, parts, rule, targets=targets)) == 1
    assert found(write, (*parts, loop("loop", "b", "c")), rule, targets=targets) == []
    (finding,) = found(write, (*parts, loop("loop", "b", "c")), rule, targets=("pybullet",))
    assert "PyBullet" in finding.message


@pytest.mark.parametrize(
    ("parts", "says"),
    [
        ((link("a", ""), link("b"), joint("j", "revolute", "a", "b")), None),
        ((link("a", BOX), link("b"), joint("j", "fixed", "a", "b")), None),
        ((link("a", BOX), link("b"), joint("j", "revolute", "a", "b")), "load nothing"),
        ((link("a"), link("b", BOX), joint("j", "revolute", "a", "b")), "omit"),
        ((link("world", ""), link("a", BOX), joint("j", "revolute", "world", "a")), "load nothing"),
        ((link("a", BOX), link("b")), None),
    ],
)
def test_what_gazebo_leaves_of_a_link_without_mass(write, parts, says):
    findings = found(write, parts, "missing-inertial")
    assert (
        [gazebo_of(f)[0].startswith(says) for f in findings] == [True]
        if says
        else not any(map(gazebo_of, findings))
    )


def test_gazebo_takes_nothing_below_a_root_without_mass(write):
    parts = link("a", ""), link("b"), joint("j", "revolute", "a", "b")
    for select in (("placeholder-inertia",), ("placeholder-inertia", "massless-root-body")):
        finding = next(f for f in found(write, parts, *select) if f.code == "placeholder-inertia")
        assert gazebo_of(finding) == []
        assert finding.effects


@pytest.mark.parametrize(
    ("targets", "parts", "has_hint"),
    [
        (("gz",), (link("a"), link("b", BOX), joint("j", "revolute", "a", "b")), True),
        (("gz",), (link("a", BOX), link("b"), joint("j", "fixed", "a", "b")), False),
        (("ros2",), (link("a", BOX), link("b"), joint("j", "revolute", "a", "b")), False),
    ],
)
def test_a_command_is_named_only_where_it_helps(write, targets, parts, has_hint):
    (finding,) = found(write, parts, "missing-inertial", targets=targets)
    assert bool(finding.hint) == has_hint


@pytest.mark.parametrize(
    ("specular", "count"),
    [('<specular rgb="1 1 1"/>', 0), ("<specular>1 1 1 1</specular>", 1)],
)
def test_pybullet_reads_a_specular_of_its_own(write, specular, count):
    material = f'<material name="m"><color rgba="1 1 1 1"/>{specular}</material>'
    parts = (link("a", BOX.replace("</visual>", f"{material}</visual>")),)
    assert len(found(write, parts, "unknown-element")) == count


def test_a_deformable_of_pybullet_is_known(write):
    assert found(write, (link("a"), '<deformable name="d"/>'), "unknown-element") == []
