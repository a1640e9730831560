import pytest

from tests.conftest import FIXTURES
from tests.graph.robots import robot, tree
from urdftool.errors import ModelError
from urdftool.inertia.judgement import FAULTS
from urdftool.lint.validate import PURPOSES, require, validate
from urdftool.model.load import load
from urdftool.rules import FAMILY_OF, get_rule

RULES = FIXTURES / "rules"


def rules_of(model, purpose="export"):
    return [finding.code for finding in validate(model, purpose)]


def test_purposes_are_made_of_rules_that_take_a_robot():
    for requirements in PURPOSES.values():
        for name in (requirement.rule for requirement in requirements):
            assert name in FAMILY_OF
            rule = get_rule(name)
            assert rule.full_check is not None or rule.needs == ("robot",)


@pytest.mark.parametrize("rule", sorted({r.rule for r in PURPOSES["export"]} - {"missing-name"}))
def test_the_bad_robot_of_a_rule_is_not_exported_and_the_good_one_is(rule):
    folder = RULES / rule
    bad = [path for path in folder.glob("bad*.urdf") if path.is_file()]
    assert any(rule in rules_of(load(path)) for path in bad)
    for path in folder.glob("good*.urdf"):
        assert rule not in rules_of(load(path))


@pytest.mark.parametrize(
    ("inside", "rule"),
    [
        ('<joint name="j" type="fixed"><parent link="a "/><child link="b"/></joint>', "unknown-pa"),
        ('<joint name="j" type="fixed"><parent link="${a}"/><child link="b"/></joint>', "unknown-"),
        ('<joint name="j" type="fixed"><parnt link="a"/><child link="b"/></joint>', "missing-pa"),
        ('<joint name="j" type="FIXED"><parent link="a"/><child link="b"/></joint>', "unknown-jo"),
        ('<jiont name="j" type="fixed"/>', "multiple-roots"),
    ],
)
def test_what_lint_leaves_to_another_rule_is_reported_too(inside, rule):
    model = robot(f'<robot name="r"><link name="a"/><link name="b"/>{inside}</robot>')
    assert any(name.startswith(rule) for name in rules_of(model))


def test_a_robot_without_a_name_is_exported_and_a_link_without_one_is_not():
    assert rules_of(load(RULES / "missing-name" / "bad.urdf")) == []
    model = robot('<robot name="r"><link/><joint type="fixed"><child link=""/></joint></robot>')
    assert rules_of(model).count("missing-name") == 2


def test_a_chain_of_followers_that_ends_at_no_joint_is_no_circle():
    mimic = '<mimic joint="{}"/></joint>'
    text = (
        '<robot name="r"><link name="a"/><link name="b"/><link name="c"/>'
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
        + mimic.format("k")
        + '<joint name="k" type="continuous"><parent link="a"/><child link="c"/>'
        + mimic.format("no")
        + "</robot>"
    )
    assert rules_of(robot(text)) == ["mimic-unknown-joint"]
    assert rules_of(robot(text.replace("no", "j"))) == ["mimic-cycle"] * 2


def test_data_decides_what_a_purpose_accepts():
    ball = tree("ab", [("j", "a", "b")])
    ball.joints[0].type = "ball"
    assert rules_of(ball) == []
    ball.joints[0].type = "universal"
    assert rules_of(ball) == ["unknown-joint-type"]
    loops = [("bc", "b", "c"), ("cb", "c", "b"), ("de", "d", "e"), ("ed", "e", "d")]
    assert rules_of(tree("abcde", loops)) == ["detached-cycle"]
    assert rules_of(tree("abcde", loops), "graph") == ["detached-cycle"] * 4


BLOCK = (
    '<robot name="r"><link name="a"/><link name="b"/>'
    '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>{}</robot>'
)


@pytest.mark.parametrize(
    ("block", "refused"),
    [
        ('<gazebo reference="a"><mu1>x</mu1></gazebo>', {"sdf": "link", "mjcf": "link"}),
        ('<gazebo reference="a"><fdir1>x</fdir1></gazebo>', {"sdf": "link"}),
        ('<gazebo reference="a"><selfCollide>x</selfCollide></gazebo>', {"sdf": "link"}),
        ('<gazebo reference="j"><stopErp>x</stopErp></gazebo>', {"sdf": "joint", "mjcf": "joint"}),
        ('<gazebo reference="a"><stopErp>x</stopErp></gazebo>', {}),
        ('<gazebo reference="no"><mu1>x</mu1></gazebo>', {}),
        ('<gazebo><light name="l"><pose>x</pose></light></gazebo>', {"sdf": "gazebo"}),
        (
            '<gazebo><joint name="k"><pose>x</pose></joint></gazebo>',
            {"sdf": "gazebo", "mjcf": "gazebo"},
        ),
        ('<gazebo><joint name="k"><pose/></joint></gazebo>', {}),
        (
            '<gazebo><joint name="k"><axis><xyz>1 0</xyz></axis></joint></gazebo>',
            {"sdf": "gazebo", "mjcf": "gazebo"},
        ),
        ('<gazebo><plugin name="p" filename="p"><pose>x</pose></plugin></gazebo>', {}),
        ('<mujoco><option timestep="x"/></mujoco>', {"mjcf": "robot"}),
    ],
)
def test_a_value_of_an_extension_keeps_a_robot_from_the_formats_that_write_it(block, refused):
    model = robot(BLOCK.format(block))
    found = {
        name: [(f.code, f.kind) for f in validate(model, f"export:{name}")]
        for name in ("sdf", "mjcf")
    }
    for name, findings in found.items():
        codes = {"gazebo": "invalid-sdf-value", "robot": "bad-mujoco-value"}
        code = codes.get(refused.get(name), "bad-extension-number")
        expected = [(code, refused[name])] if name in refused else []
        assert findings == expected


def test_what_lint_accepts_of_a_number_is_refused_where_it_is_written():
    model = robot(BLOCK.format('<origin xyz="0 0 x"/>'))
    assert rules_of(model) == []
    assert rules_of(model, "export:sdf") == ["not-a-number"]
    assert rules_of(model, "export:mjcf") == []


def test_every_follower_of_a_fixed_joint_is_reported_and_its_own_type_is_not():
    follower = '<joint name="{0}" type="{1}"><parent link="b"/><child link="{0}"/>{2}</joint>'
    mimic = '<mimic joint="j"/><limit lower="0" upper="1" effort="1" velocity="1"/>'
    parts = "".join(f'<link name="{name}"/>' for name in "kl")
    parts += follower.format("k", "revolute", mimic) + follower.format("l", "prismatic", mimic)
    found = validate(robot(BLOCK.format(parts)), "export:sdf")
    assert [(f.code, f.name) for f in found] == [("mimic-dof-mismatch", name) for name in "kl"]


def test_the_plugin_without_a_name_is_written_and_the_one_without_a_library_is_not():
    text = '<gazebo><plugin name="p"/><plugin filename="p"/></gazebo>'
    found = validate(robot(BLOCK.format(text)), "export:sdf")
    assert [(f.code, f.name) for f in found] == [("plugin-without-filename", "p")]


@pytest.mark.parametrize(
    ("number", "found"),
    [("1e30", []), ("2e30", ["immense-number"]), ("1" * 32, ["immense-number"])],
)
def test_a_number_above_1e30_is_immense_and_a_limit_may_be(number, found):
    sphere = f'<geometry><sphere radius="{number}"/></geometry>'
    shape = f'<link name="c"><visual>{sphere}</visual></link>'
    joint = (
        '<joint name="k" type="revolute"><parent link="b"/><child link="c"/>'
        '<limit lower="-1e40" upper="1e40" effort="1e300" velocity="1"/></joint>'
    )
    assert rules_of(robot(BLOCK.format(shape + joint))) == found


def test_every_fault_of_an_inertia_is_asked_for():
    asked = {requirement.rule for requirement in PURPOSES["inertia"]}
    assert asked - set(FAULTS) == {"inertia-triangle-inequality-rounding"}
    assert set(FAULTS) <= asked


def test_a_robot_that_cannot_be_used_is_refused_with_all_that_is_wrong():
    with pytest.raises(ModelError, match="has no link") as caught:
        require(robot('<robot name="r"/>'), "links")
    assert caught.value.line == 1
    with pytest.raises(ModelError) as caught:
        require(tree("abc", [("j", "a", "x"), ("k", "b", "y")]), "join")
    assert len(caught.value.notes) == 1
    whole = tree("ab", [("j", "a", "b")])
    assert require(whole, "export") is whole
