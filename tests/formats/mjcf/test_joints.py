"""Joints: limits, effort, mimics, and the types that MuJoCo makes of several."""

import pytest

from urdftool.diagnostic import Severity
from urdftool.formats.mjcf.joint import get_plane
from urdftool.model.pose import compute_dot
from urdftool.refusal import Refused

from .robots import export, find, joint, link, robot, rules, tree


def two(inside, kind="revolute"):
    return robot(link("a"), link("b"), joint("j", "a", "b", kind, inside))


def exported(write, inside, kind="revolute", **choices):
    written = export(write("r.urdf", two(inside, kind)), **choices)
    return written, find(tree(written), "joint", "j")


def test_limits_effort_and_dynamics(write):
    inside = (
        '<axis xyz="0 1 0"/><limit lower="-1.5" upper="2" effort="87" velocity="2.5"/>'
        '<dynamics damping="0.3" friction="0.1"/>'
    )
    written, element = exported(write, inside)
    assert dict(element.attrib) == {
        "name": "j",
        "axis": "0 1 0",
        "range": "-1.5 2",
        "actuatorfrcrange": "-87 87",
        "damping": "0.3",
        "frictionloss": "0.1",
        "solreflimit": "0.004 1",
    }
    numeric = find(tree(written), "numeric", "j_velocity_limit")
    assert numeric.get("data") == "2.5"


@pytest.mark.parametrize(
    ("inside", "kind", "range_", "rule"),
    [
        ('<limit lower="-1" effort="1" velocity="1"/>', "revolute", "-1 0", None),
        ("", "revolute", None, "lossy-limit-missing"),
        ('<limit lower="-1" upper="1"/>', "continuous", None, "lossy-limit-unused"),
        ('<limit lower="0" upper="1" effort="0"/>', "prismatic", "0 1", "lossy-effort"),
    ],
)
def test_limits_at_the_edge(write, inside, kind, range_, rule):
    written, element = exported(write, inside, kind)
    assert element.get("range") == range_
    assert rule is None or rule in rules(written)


@pytest.mark.parametrize(
    ("limit", "value"), [('<limit lower="0.5" upper="0.5"/>', "0.5"), ("<limit/>", "0")]
)
def test_a_locked_joint_that_is_kept_is_an_equality(write, limit, value):
    written, _ = exported(write, limit, keep_locked_joints=True)
    (equality,) = tree(written).find("equality")
    assert equality.get("joint1") == "j"
    assert equality.get("joint2") is None
    assert equality.get("polycoef") == f"{value} 0 0 0 0"


@pytest.mark.parametrize(
    ("limit", "kind", "pose", "rule"),
    [
        ('<limit lower="0" upper="0"/>', "revolute", ("0 0 2", None), "lossy-limit-equal"),
        ("<limit/>", "revolute", ("0 0 2", None), "lossy-limit-missing"),
        ('<limit lower="1" upper="1"/>', "prismatic", ("0 0 3", None), "lossy-limit-equal"),
        (
            '<limit lower="3.141592653589793" upper="3.141592653589793"/>',
            "revolute",
            ("0 0 2", "0 0 0 1"),
            "lossy-limit-equal",
        ),
    ],
)
def test_a_locked_joint_is_welded_at_its_position(write, limit, kind, pose, rule):
    text = two(f'<origin xyz="0 0 2"/><axis xyz="0 0 1"/>{limit}', kind)
    written = export(write("r.urdf", text))
    model = tree(written)
    body = find(model, "body", "b")
    assert (body.get("pos"), body.get("quat")) == pose
    assert find(model, "site", "j").getparent() is body
    assert list(model.find("worldbody").iter("joint")) == []
    assert rules(written) == ["lossy-locked", rule]


@pytest.mark.parametrize(
    ("second", "kind", "locked"),
    [
        ('<limit lower="1" upper="1"/>', "prismatic", "all 2 joints"),
        ('<limit lower="-1" upper="1"/><mimic joint="j"/>', "prismatic", "the only joint"),
        ("", "fixed", "the only joint"),
        ('<limit lower="-1" upper="1"/>', "prismatic", None),
        ("", "continuous", None),
        ("", "floating", None),
    ],
)
def test_a_robot_whose_joints_are_all_locked_is_a_warning(write, second, kind, locked):
    text = robot(
        link("a"), link("b"), link("c"),
        joint("j", "a", "b", inside='<limit lower="0" upper="0"/>'),
        joint("k", "b", "c", kind, second),
    )  # fmt: skip
    losses = {loss.code: loss for loss in export(write("r.urdf", text)).losses}
    loss = losses.get("lossy-locked")
    assert (loss and loss.message.partition(" that ")[0]) == locked
    assert loss is None or loss.severity is Severity.WARNING


@pytest.mark.parametrize("limit", ['effort="1"', 'velocity="9"', 'effort="1.7" velocity="111"'])
def test_a_driven_joint_without_bounds_is_continuous(write, limit):
    written, element = exported(write, f"<limit {limit}/>", "revolute")
    assert element.get("range") is None
    assert "lossy-limit-missing" in rules(written)


def test_what_mimics_a_locked_joint_is_held_where_it_leads(write):
    text = robot(
        link("a"), link("b"), link("c"),
        joint("lead", "a", "b", inside='<limit lower="0.5" upper="0.5"/>'),
        joint("follow", "a", "c", inside='<limit lower="-9" upper="9"/>'
              '<mimic joint="lead" multiplier="2" offset="0.1"/>'),
    )  # fmt: skip
    (equality,) = tree(export(write("r.urdf", text))).find("equality")
    assert equality.get("polycoef") == "1.1 0 0 0 0"


def test_mimic_has_its_follower_first(write):
    text = robot(
        link("a"), link("b"), link("c"),
        joint("lead", "a", "b"),
        joint("follow", "a", "c", inside='<limit lower="-9" upper="9"/>'
              '<mimic joint="lead" multiplier="-2" offset="0.1"/>'),
    )  # fmt: skip
    (equality,) = tree(export(write("r.urdf", text))).find("equality")
    assert [equality.get(n) for n in ("joint1", "joint2", "polycoef")] == [
        "follow",
        "lead",
        "0.1 -2 0 0 0",
    ]


def test_mimic_of_a_fixed_joint_is_held_at_its_offset(write):
    text = robot(
        link("a"), link("b"), link("c"),
        joint("lead", "a", "b", "fixed", ""),
        joint("follow", "a", "c", inside='<limit lower="-9" upper="9"/>'
              '<mimic joint="lead" offset="0.1"/>'),
    )  # fmt: skip
    written = export(write("r.urdf", text))
    assert tree(written).find("equality")[0].get("polycoef") == "0.1 0 0 0 0"
    assert "lossy-mimic-fixed" in rules(written)


@pytest.mark.parametrize(
    ("inside", "rule"),
    [
        ('<axis xyz="0 0 0"/><limit lower="0" upper="1"/>', "zero-axis"),
        ('<limit lower="1" upper="0"/>', "lower-above-upper"),
        ('<limit lower="0" upper="1"/><mimic joint="j"/>', "mimic-cycle"),
        ('<limit lower="0" upper="1"/><mimic joint="ghost"/>', "mimic-unknown-joint"),
        ('<limit lower="0" upper="${x}"/>', "not-a-number"),
    ],
)
def test_defects_are_refused_and_forced(write, inside, rule):
    path = write("r.urdf", two(inside))
    with pytest.raises(Refused) as caught:
        export(path)
    assert [finding.code for finding in caught.value.findings] == [rule]
    assert caught.value.line == 3 or rule == "zero-axis"
    assert rule in rules(export(path, force=True))


def test_unknown_type(write):
    with pytest.raises(Refused, match="type 'screw'"):
        export(write("r.urdf", two("", "screw")))


def test_planar_is_two_slides_and_a_hinge(write):
    text = two('<axis xyz="0 0 1"/>', "planar")
    elements = list(tree(export(write("r.urdf", text))).iter("joint"))
    named = [element for element in elements if element.get("name")]
    assert [(e.get("name"), e.get("type"), e.get("axis", "0 0 1")) for e in named] == [
        ("j_TX", "slide", "1 0 0"),
        ("j_TY", "slide", "0 1 0"),
        ("j_RZ", None, "0 0 1"),
    ]


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -2), (1, 0, 0), (1, 2, 3), (-1, 0.1, -9)])
def test_a_plane_has_a_right_handed_frame(normal):
    x, y, z = get_plane(tuple(map(float, normal)))
    for one, other, expected in ((x, x, 1), (y, y, 1), (x, y, 0), (x, z, 0), (y, z, 0)):
        assert compute_dot(one, other) == pytest.approx(expected, abs=1e-12)
    from urdftool.model.pose import compute_cross

    assert compute_cross(x, y) == pytest.approx(z)


def test_floating_below_the_world_is_a_free_joint(write):
    text = robot(
        link("world", ""), link("a"), joint("j", "world", "a", "floating", '<origin xyz="0 0 2"/>')
    )
    model = tree(export(write("r.urdf", text)))
    body = find(model, "body", "a")
    assert body.getparent().tag == "worldbody"
    assert body.get("pos") == "0 0 2"
    assert find(model, "freejoint", "j") is not None


def test_floating_below_a_moving_link_is_said(write):
    text = robot(
        link("a"), link("b"), link("c"),
        joint("j", "a", "b", inside='<origin xyz="1 0 0"/><limit lower="-1" upper="1"/>'),
        joint("f", "b", "c", "floating", '<origin xyz="0 0 2"/>'),
    )  # fmt: skip
    written = export(write("r.urdf", text))
    assert find(tree(written), "body", "c").get("pos") == "1 0 2"
    assert "lossy-floating" in rules(written)


def test_spring_of_gazebo(write):
    text = two('<limit lower="-1" upper="1"/>').replace(
        "</robot>",
        '<gazebo reference="j"><springStiffness>3</springStiffness>'
        "<springReference>0.2</springReference></gazebo></robot>",
    )
    element = find(tree(export(write("r.urdf", text))), "joint", "j")
    assert (element.get("stiffness"), element.get("springref")) == ("3", "0.2")
