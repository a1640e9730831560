"""No effect is stated on a reader that rejects the robot, or does not get the part."""

import pytest

from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings
from urdftool.model.read import read_robot
from urdftool.rules.gazebo.lumped_model import find_kept_links
from urdftool.source.description import read_description

TENSOR = '<inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/>'
BOX = '<geometry><box size="0.1 0.1 0.1"/></geometry>'


def inertial(mass):
    """Write an inertial; none for None."""
    return "" if mass is None else f'<inertial><mass value="{mass}"/>{TENSOR}</inertial>'


def robot(links, joints):
    """Write a robot of links with their content, and joints as ``parent child type``."""
    made = [f'<link name="{name}">{content}</link>' for name, content in links.items()]
    for parent, child, kind in (joint.split() for joint in joints):
        made.append(
            f'<joint name="to_{child}" type="{kind}"><parent link="{parent}"/>'
            f'<child link="{child}"/><axis xyz="0 0 1"/>'
            '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        )
    return f'<robot name="r">{"".join(made)}</robot>'


def list_findings(tmp_path, text, *rules):
    """List the findings of rules."""
    path = tmp_path / "r.urdf"
    path.write_text(text)
    found = check_file(path, Options(Settings(extend_select=rules))).findings
    return [finding for finding in found if finding.code in rules]


@pytest.mark.parametrize(
    ("masses", "joints", "kept"),
    [
        ("a1 b- c1", "a b fixed, b c revolute", "a"),
        ("a1 b1e-6 c1", "a b fixed, b c revolute", "a"),
        ("a1 b1e-5 c1", "a b fixed, b c revolute", "a c"),
        ("a1 b- c1 e1", "a b fixed, b c revolute, b e fixed", "a c"),
        ("a1 b1 d- c1", "a b revolute, b d fixed, d c revolute", "a b"),
        ("a- b1 c1", "a b fixed, a c revolute", "a c"),
        ("a1 b0 c1", "a b revolute, b c revolute", "a"),
        ("world- a- b1 c1", "world a fixed, a b fixed, a c revolute", "a c"),
        ("a0 c1", "a c revolute", ""),
    ],
)
def test_gazebo_keeps_links_whose_joint_is_on_a_link_with_mass(tmp_path, masses, joints, kept):
    """As ``ign sdf -p`` of sdformat 12.3 writes them."""
    links = {}
    for word in masses.split():
        name = "world" if word.startswith("world") else word[0]
        mass = word.removeprefix(name)
        links[name] = inertial(None if mass == "-" else mass)
    path = tmp_path / "r.urdf"
    path.write_text(robot(links, joints.split(", ")))
    read = read_robot(read_description(str(path)).document.root)
    assert find_kept_links(read) == set(kept.split())


@pytest.mark.parametrize(
    ("mass", "rule"),
    [(None, "missing-inertial"), (0, "zero-mass"), (1e-6, "zero-mass"), (1e-5, "")],
)
def test_a_link_without_mass_that_holds_a_joint_is_named_for_gazebo(tmp_path, mass, rule):
    """As ``ign sdf -p``, which omits c without a message; the frame d holds no joint."""
    links = {"a": inertial(1), "b": inertial(mass), "c": inertial(1), "d": ""}
    path = tmp_path / "r.urdf"
    path.write_text(robot(links, ["a b fixed", "b c revolute", "c d fixed"]))
    for target, codes in (("gz", [rule] * bool(rule)), ("mujoco", [])):
        options = Options(Settings(targets=frozenset({target})))
        found = [f for f in check_file(path, options).findings if "omits 'c'" in f.message]
        assert [f.code for f in found] == codes
        assert all(f.severity.label == "error" and f.name == "b" for f in found)


def test_no_effect_on_gazebo_of_a_link_that_it_omits(tmp_path):
    links = {name: inertial(mass) for name, mass in (("a", 1), ("b", 0), ("c", 0.5))}
    odd = '<inertial><mass value="0.5"/>' + TENSOR.replace("/>", ' izx="1"/>') + "</inertial>"
    links |= {"c": odd, "d": odd}
    joints = ["a b revolute", "b c revolute", "a d revolute"]
    below, beside = list_findings(tmp_path, robot(links, joints), "redundant-inertia-attributes")
    assert (below.name, beside.name) == ("c", "d")
    assert not any("gz" in key for key in below.effects)
    assert any("gz" in key for key in beside.effects)


def test_gazebo_rejects_two_links_of_mass_0_on_a_body_with_mass(tmp_path):
    odd = '<inertial><mass value="0.5"/>' + TENSOR.replace("/>", ' izx="1"/>') + "</inertial>"
    none = inertial(0).replace("1e-3", "0")
    links = {"a": inertial(1), "b": none, "c": none, "d": odd}
    joints = ["a b fixed", "b c fixed", "a d revolute"]
    text = robot(links, joints)
    pair, other = list_findings(tmp_path, text, "zero-mass", "redundant-inertia-attributes")
    if pair.code != "zero-mass":
        pair, other = other, pair
    assert "'b' and 'c'" in pair.message
    assert any("gz" in key for key in pair.effects)
    assert not any("gz" in key for key in other.effects)


def test_no_effect_on_pinocchio_of_a_shape_whose_mesh_it_does_not_find(tmp_path):
    shape = '<collision><geometry><mesh filename="{}.dae"/></geometry></collision>'
    files = [shape.format("missing"), shape.format("there")]
    links = {name: inertial(1) + file for name, file in zip("ab", files, strict=True)}
    (tmp_path / "there.dae").write_text("<COLLADA/>")
    text = robot(links, ["a b revolute"])
    found = list_findings(tmp_path, text, "dae-as-collision")
    assert found
    assert not any("pinocchio" in key for finding in found for key in finding.effects)
    (tmp_path / "missing.dae").write_text("<COLLADA/>")
    found = list_findings(tmp_path, text, "dae-as-collision")
    assert any("pinocchio" in key for finding in found for key in finding.effects)
