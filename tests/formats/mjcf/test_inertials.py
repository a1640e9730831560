"""Masses: verbatim, moved inside a rigid body, repaired on demand, or refused."""

import numpy as np
import pytest

from urdftool.refusal import Refused

from .robots import INERTIAL, export, find, joint, link, robot, rules, tree


def inertial(mass, moments, products=(0, 0, 0), origin=""):
    xx, yy, zz = moments
    xy, xz, yz = products
    return (
        f'<inertial>{origin}<mass value="{mass}"/><inertia ixx="{xx}" ixy="{xy}" ixz="{xz}" '
        f'iyy="{yy}" iyz="{yz}" izz="{zz}"/></inertial>'
    )


def written_inertial(model, name):
    return find(model, "body", name).find("inertial")


def tensor_of(element):
    """The tensor of an element along its body's axes."""
    from urdftool.model.pose import rotation_from_quaternion

    if element.get("fullinertia"):
        xx, yy, zz, xy, xz, yz = map(float, element.get("fullinertia").split())
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    quaternion = tuple(map(float, element.get("quat", "1 0 0 0").split()))
    turn = np.array(rotation_from_quaternion(quaternion))
    return turn @ np.diag(list(map(float, element.get("diaginertia").split()))) @ turn.T


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (inertial(2, (1, 2, 2.5)), {"mass": "2", "diaginertia": "1 2 2.5"}),
        (inertial(2, (1, 2, 2.5), (0.1, 0, 0)), {"fullinertia": "1 2 2.5 0.1 0 0"}),
        (
            inertial(2, (1, 2, 2.5), origin='<origin xyz="1 2 3" rpy="1.5707963267948966 0 0"/>'),
            {"pos": "1 2 3", "quat": "1 1 0 0", "diaginertia": "1 2 2.5"},
        ),
        (inertial(2, (1, 1, 1), origin='<origin rpy="0.3 0.1 0.2"/>'), {"diaginertia": "1 1 1"}),
        (inertial("0.1", ("1e-7", "2e-7", "2.5e-7")), {"diaginertia": "1e-07 2e-07 2.5e-07"}),
    ],
)
def test_numbers_stay_as_they_are(write, text, expected):
    element = written_inertial(tree(export(write("r.urdf", robot(link("a", text))))), "a")
    assert {name: element.get(name) for name in expected} == expected


def test_a_turned_tensor_is_the_same(write):
    text = inertial(1, (1, 2, 2.5), (0.1, 0.2, 0.3), '<origin rpy="0.3 -0.4 0.5"/>')
    element = written_inertial(tree(export(write("r.urdf", robot(link("a", text))))), "a")
    from urdftool.mechanics.reference import turn

    rotation = np.eye(3)
    for axis, angle in zip(np.eye(3), (0.3, -0.4, 0.5), strict=True):
        rotation = turn(axis, angle) @ rotation
    given = np.array([[1, 0.1, 0.2], [0.1, 2, 0.3], [0.2, 0.3, 2.5]])
    assert tensor_of(element) == pytest.approx(rotation @ given @ rotation.T, abs=1e-15)


def test_nothing_is_inferred_where_nothing_is_written(write):
    written = export(write("r.urdf", robot(link("a", ""))))
    assert written_inertial(tree(written), "a") is None
    assert tree(written).find("compiler").get("inertiafromgeom") == "false"


BAD = inertial(1, (1, 1, 3))


def test_an_impossible_tensor_of_a_moving_body_is_refused_with_its_place(write):
    path = write("r.urdf", robot("", link("base"), "", link("a", BAD), joint("j", "base", "a")))
    with pytest.raises(Refused) as caught:
        export(path)
    assert caught.value.findings[0].code == "inertia-triangle-inequality"
    assert caught.value.line == 4


@pytest.mark.parametrize("format", ["mjcf", "sdf", "usd"])
def test_many_impossible_tensors_are_one_line(urdftool, write, tmp_path, format):
    if format == "usd":
        pytest.importorskip("pxr")
    names = "abcde"
    links = [link(n, inertial(1, (1, 1, 3 + k))) for k, n in enumerate(names)]
    joints = [joint(f"j{n}", "base", n) for n in names]
    path = write("r.urdf", robot("", link("base", inertial(1, (1, 1, 1))), *links, *joints))
    words = "export", format, path, "-o", tmp_path / "out"
    refused = urdftool(*words)
    assert refused.code == 2
    [line] = [text for text in refused.err.splitlines() if "inconsistent" in text]
    assert "link 'e'" in line and "(the largest of 5; -v shows all)" in line  # noqa: PT018
    assert "5 errors" in refused.err
    assert urdftool("-v", *words).err.count("inconsistent") == 5
    assert urdftool(*words, "--fix-inertia", "lift").err.count("inconsistent") == 1


@pytest.mark.parametrize(
    ("fix", "moments"),
    [("lift", [1.5, 1.5, 3]), ("balance", [5 / 3] * 3), ("box", [13 / 12, 10 / 12, 5 / 12])],
)
def test_it_is_repaired_as_asked_and_reported_in_numbers(write, fix, moments):
    shape = '<collision><geometry><box size="1 2 3"/></geometry></collision>'
    text = robot(link("base"), link("a", BAD + shape), joint("j", "base", "a"))
    written = export(write("r.urdf", text), fix_inertia=fix)
    tensor = tensor_of(written_inertial(tree(written), "a"))
    assert np.diag(tensor) == pytest.approx(moments)
    (loss,) = [loss for loss in written.losses if loss.code == "lossy-inertia"]
    assert "1, 1, 3" in loss.message


def test_in_a_rigid_body_the_surplus_moves_and_the_whole_is_the_same(write):
    text = robot(
        link("base"),
        link("a", inertial(2, (9, 9, 9))),
        link("b", BAD),
        joint("j", "base", "a"),
        joint("w", "a", "b", "fixed", '<origin xyz="1 2 3" rpy="0.3 0.2 0.1"/>'),
    )
    written = export(write("r.urdf", text))
    assert "lossy-inertia-moved" in rules(written)
    model = tree(written)
    from urdftool.model.pose import rotation_from_rpy

    turn = np.array(rotation_from_rpy((0.3, 0.2, 0.1)))
    total = tensor_of(written_inertial(model, "a"))
    total = total + turn @ tensor_of(written_inertial(model, "b")) @ turn.T
    assert total == pytest.approx(9 * np.eye(3) + turn @ np.diag([1, 1, 3]) @ turn.T)


def test_a_held_link_with_an_impossible_tensor_is_lifted_and_said(write):
    written = export(write("r.urdf", robot(link("a", BAD))))
    assert "lossy-inertia" in rules(written)


def test_massless_last_link(write):
    text = robot(link("base"), link("a", ""), joint("j", "base", "a"))
    written = export(write("r.urdf", text))
    model = tree(written)
    assert float(written_inertial(model, "a").get("mass")) < 1e-14
    assert find(model, "joint", "j").get("armature") == "0.0001"
    assert "lossy-massless" in rules(written)


def test_massless_link_with_mass_below_has_no_armature(write):
    text = robot(
        link("base"), link("a", ""), link("b"), joint("j", "base", "a"), joint("k", "a", "b")
    )
    model = tree(export(write("r.urdf", text)))
    assert find(model, "joint", "j").get("armature") is None


def test_noise_in_place_of_zeros_is_a_point(write):
    noise = inertial(0.5, ("-5e-20", "-5e-20", "0"))
    written = export(
        write("r.urdf", robot(link("base"), link("a", noise), joint("j", "base", "a")))
    )
    assert "lossy-point-mass" in rules(written)


def test_negative_mass_is_refused(write):
    text = INERTIAL.replace('value="1"', 'value="-1"')
    with pytest.raises(Refused, match=r"mass of link .* is negative \(-1 kg\)"):
        export(write("r.urdf", robot(link("a", text))))


POINT = inertial(2, ("0", "0", "0"))
BOX = '<collision><geometry><box size="0.6 0.3 0.1"/></geometry></collision>'
LIMIT = '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="9" velocity="9"/>'
LEG = '<collision><origin xyz="0 0 -0.2"/><geometry><sphere radius="0.05"/></geometry></collision>'


def make_legged(root, leg):
    """A robot on four legs, whose root and legs have the given mass properties."""
    legs = [f"{side}_leg" for side in ("fl", "fr", "rl", "rr")]
    corners = ("0.2 0.1 0", "0.2 -0.1 0", "-0.2 0.1 0", "-0.2 -0.1 0")
    joints = [joint(f"{name}_hip", "base", name, inside=f'<origin xyz="{at}"/>{LIMIT}')
              for name, at in zip(legs, corners, strict=True)]  # fmt: skip
    return robot(link("base", root + BOX), *(link(name, leg + LEG) for name in legs), *joints)


def test_a_free_base_without_inertia_gets_that_of_a_box(write):
    written = export(write("r.urdf", make_legged(POINT, POINT)))
    model = tree(written)
    base = tensor_of(written_inertial(model, "base"))
    expected = np.diag([0.09 + 0.01, 0.36 + 0.01, 0.36 + 0.09]) * 2 / 12
    np.testing.assert_allclose(base, expected, rtol=1e-12)
    np.testing.assert_allclose(
        tensor_of(written_inertial(model, "fl_leg")), np.eye(3) * 2 * 0.02 / 12, rtol=1e-12
    )
    texts = [loss.message for loss in written.losses if loss.code == "lossy-point-mass"]
    assert len(texts) == 5
    assert all("tensor of a box around its geometry" in text for text in texts)


@pytest.mark.parametrize("base", ["free", "fixed"])
def test_other_point_masses_stay_points(write, base):
    is_free = base == "free"
    text = make_legged(inertial(2, (1, 1, 1)) if is_free else POINT, POINT)
    model = tree(export(write("r.urdf", text), base=base))
    assert tensor_of(written_inertial(model, "fl_leg")).max() < 1e-11
