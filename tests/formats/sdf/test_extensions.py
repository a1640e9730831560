"""What <gazebo> says of links, joints and the robot."""

import pytest

from urdftool.formats.registry import format_named
from urdftool.formats.sdf.options import Options
from urdftool.model.settings import JOINT_TAGS, SURFACE_TAGS, list_rows

from .robots import (
    BOX,
    CUBE,
    TWO,
    export,
    gazebo,
    inertial,
    joint,
    link,
    named,
    names,
    robot,
    rules,
    tree,
)

NAMED = f'{inertial()}<collision name="a_foot">{BOX}</collision><collision>{BOX}</collision>'
VALUES = {"number": "0.25", "count": "7", "vector": "0 1 0", "flag": "true"}


@pytest.mark.parametrize("tag", sorted(SURFACE_TAGS))
@pytest.mark.parametrize("form", ["<{0}>{1}</{0}>", '<{0} value="{1}"/>'])
def test_contact_values_reach_each_collision(tag, form):
    (row,) = list_rows(tag)
    value = VALUES[row.kind]
    model = tree(export(link("a", NAMED), gazebo("a", form.format(tag, value))))
    assert [e.findtext(row.path) for e in model.iter("collision")] == [value, value]


@pytest.mark.parametrize("tag", sorted(JOINT_TAGS))
def test_joint_values(tag):
    (row,) = list_rows(tag)
    value = VALUES[row.kind]
    written = export(*TWO, gazebo("j", f"<{tag}>{value}</{tag}>"))
    assert named(tree(written), "joint", "j").findtext(row.path) == value
    assert rules(written) == []


def test_the_friction_of_a_lumped_link_is_that_of_its_own_shapes():
    parts = (link("base", inertial() + CUBE), joint("j", "base", "base_cam", "fixed"),
             link("base_cam", inertial() + CUBE))  # fmt: skip
    said = gazebo("base", "<mu1>1</mu1>"), gazebo("base_cam", "<mu1>0</mu1>")
    model = tree(export(*parts, *said, fixed_joints="lump"))
    assert [e.text for e in model.iter("mu")] == ["1", "0"]


def test_gravity_of_a_lumped_link_is_said_and_not_spread():
    parts = (link("a"), joint("j", "a", "b", "fixed"), link("b"))
    said = gazebo("b", "<turnGravityOff>true</turnGravityOff><dampingFactor>0.1</dampingFactor>")
    written = export(*parts, said, fixed_joints="lump")
    assert next(tree(written).iter("gravity"), None) is None
    assert rules(written).count("lossy-link-flag") == 2
    kept = named(tree(export(*parts, said)), "link", "b")
    assert (kept.findtext("gravity"), kept.findtext("velocity_decay/linear")) == ("false", "0.1")


def test_blocks_of_sdf_are_merged_into_each_shape():
    inside = (
        "<mu1>0.7</mu1><collision><surface><friction><ode><mu2>0.71</mu2></ode></friction>"
        "</surface></collision>"
    )
    model = tree(export(link("a", NAMED), gazebo("a", inside)))
    for collision in model.iter("collision"):
        ode = collision.find("surface/friction/ode")
        assert (ode.findtext("mu"), ode.findtext("mu2")) == ("0.7", "0.71")


def test_what_is_set_twice_is_said_and_the_last_holds():
    written = export(link("a", NAMED), gazebo("a", "<mu1>1</mu1>"), gazebo("a", "<mu1>2</mu1>"))
    assert next(tree(written).iter("mu")).text == "2"
    assert rules(written) == []  # the model has a remark for every command


def test_a_link_and_a_joint_of_one_name_each_get_their_own():
    parts = (link("a"), joint("b", "a", "b"), link("b", NAMED))
    said = gazebo("b", "<mu1>1</mu1><springStiffness>2</springStiffness><gravity>0</gravity>")
    model = tree(export(*parts, said))
    assert named(model, "link", "b_link").findtext("gravity") == "false"
    assert next(model.iter("mu")).text == "1"
    assert named(model, "joint", "b").findtext("axis/dynamics/spring_stiffness") == "2"


def test_a_reference_to_nothing_is_said():
    blocks = gazebo("{prefix}a", "<mu1>1</mu1>"), gazebo("a_foot", "")
    written = format_named("sdf").write(robot(link("a", NAMED), *blocks), Options())
    assert rules(written) == ["dangling-reference", "dangling-reference"]
    assert "it is a shape of link 'a'" in written.losses[1].message


def test_a_light_of_a_lumped_link_stays_where_it_is():
    parts = (link("a"), joint("j", "a", "b", "fixed", origin="1 0 0"), link("b"))
    said = gazebo("b", '<light name="l" type="point"><pose>0 1 0 0 0 0</pose></light>')
    pose = next(tree(export(*parts, said, fixed_joints="lump")).iter("light")).find("pose")
    assert (pose.text, pose.get("relative_to")) == ("0 1 0 0 0 0", "b")
    pose = next(tree(export(*parts, said, target="gazebo-classic")).iter("light")).find("pose")
    assert pose.text == "1 1 0 0 0 0"


def test_what_is_no_sdf_is_a_comment():
    written = export(*TWO, gazebo("j", "<stopKd>3</stopKd>"), gazebo("a", "<gravty>0</gravty>"))
    assert rules(written) == ["lossy-element", "lossy-element"]
    text = written.files["model.sdf"].decode()
    assert "<!-- stopKd 3 -->" in text
    assert "<!-- gravty 0 -->" in text


def test_a_prefix_is_kept():
    said = gazebo("a", '<my:tag xmlns:my="urn:mine">1</my:tag>')
    assert b'<my:tag xmlns:my="urn:mine">1</my:tag>' in export(link("a"), said).files["model.sdf"]


@pytest.mark.parametrize("ends", [("b", "b"), ("a", "c")])
def test_a_joint_from_a_link_to_itself_is_left_out(ends):
    parts = (*TWO, joint("k", "a", "c", "fixed"), link("c"))
    said = (
        '<gazebo><joint name="q" type="ball"><parent>{}</parent><child>{}</child></joint></gazebo>'
    )
    model = robot(*parts, said.format(*ends))
    written = format_named("sdf").write(model, Options(fixed_joints="lump"))
    assert "q" not in names(tree(written), "joint")
    code = "dangling-reference" if ends == ("b", "b") else "lossy-reference"
    assert [rule for rule in rules(written) if "reference" in rule] == [code]


def test_the_model_is_static_and_closed_by_a_joint():
    block = (
        "<gazebo><static>true</static><self_collide>1</self_collide>"
        '<joint name="j" type="revolute"><parent>a</parent><child>b</child></joint></gazebo>'
    )
    written = export(*TWO, block)
    model = tree(written)
    assert (model.findtext("static"), model.findtext("self_collide")) == ("true", "1")
    assert names(model, "joint") == ["j", "j_2"]
    assert rules(written) == ["lossy-name"]


@pytest.mark.parametrize("target", ["gz", "gazebo-classic"])
def test_named_materials_of_gazebo(target):
    part = link("a", f"{inertial()}<visual>{BOX}</visual>")
    said = gazebo("a", "<material>Gazebo/Red</material>")
    material = next(tree(export(part, said, target=target)).iter("material"))
    if target == "gz":
        assert material.findtext("diffuse") == "1 0 0 1"
    else:
        assert material.findtext("script/name") == "Gazebo/Red"


def test_an_unknown_material_is_said():
    part = link("a", f"{inertial()}<visual>{BOX}</visual><visual>{BOX}</visual>")
    written = export(part, gazebo("a", "<material>PR2/Shiny</material>"))
    assert rules(written) == ["lossy-material"]
    said = gazebo("a", "<material><diffuse>0 1 0 1</diffuse></material>")
    assert next(tree(export(part, said)).iter("diffuse")).text == "0 1 0 1"


def test_a_rejected_setting_is_reported_once(urdftool, write):
    block = "<gazebo><static>x</static></gazebo><gazebo reference='a'><mu1>abc</mu1></gazebo>"
    path = write("r.urdf", f"<robot name='r'><link name='a'>{inertial()}</link>{block}</robot>")
    lines = urdftool("export", "sdf", path, "-o", "out", "--force").err.splitlines()
    assert sum("'abc'" in line for line in lines) == 1
    assert sum("'x'" in line for line in lines) == 1


@pytest.mark.parametrize("tag", ["link", "frame", "model"])
def test_a_name_that_is_taken_is_written_once(tag):
    block = f'<gazebo><{tag} name="b"/></gazebo>'
    written = export(link("a", inertial()), joint("j", "a", "b"), link("b", inertial()), block)
    model = tree(written)
    assert [child.tag for child in model if child.get("name") == "b"] == ["link"]
    assert "lossy-reference" in rules(written)


@pytest.mark.parametrize(("model", "copied"), [("", False), ('<model name="x"/>', True)])
def test_a_joint_to_a_link_of_a_model_that_is_not_there_is_not_copied(model, copied):
    ends = "<parent>a</parent><child>x::y</child>"
    block = f'<gazebo>{model}<joint name="q" type="ball">{ends}</joint></gazebo>'
    written = export(link("a"), block, force=True)
    assert ('name="q"' in written.files["model.sdf"].decode()) is copied
