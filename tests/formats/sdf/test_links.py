"""Links: masses, shapes, colours, names."""

import subprocess

import numpy as np
import pytest

from urdftool.model.pose import rotation_from_rpy

from .robots import BOX, CUBE, TWO, WELDED, export, inertial, joint, link, named, names, rules, tree


def test_numbers_are_as_written_without_noise():
    part = link("a", inertial(0.1, (1e-9, 0.30000000000000004, 0.3), xyz="0.1 -0 1e30"))
    body = named(tree(export(part)), "link", "a").find("inertial")
    assert body.findtext("mass") == "0.1"
    assert body.findtext("pose") == "0.1 0 1e+30 0 0 0"
    assert body.findtext("inertia/iyy") == "0.3"


def test_a_moving_link_without_mass_stays_with_all_below_it():
    parts = (*TWO[:2], link("b", ""), joint("k", "b", "c"), link("c"))
    written = export(*parts)
    model = tree(written)
    assert names(model, "link") == ["a", "b", "c"]
    assert named(model, "link", "b").findtext("inertial/mass") == "1e-12"
    assert [(x.code, x.name, x.severity.label) for x in written.losses] == [
        ("lossy-mass", "b", "info")
    ]


def test_a_leaf_without_mass_is_a_warning():
    written = export(*TWO[:2], link("b", ""))
    assert [(x.code, x.severity.label) for x in written.losses] == [("lossy-mass", "warning")]


def test_lumped_masses_are_one():
    parts = (
        link("a", inertial(1)),
        joint("j", "a", "b", "fixed", origin="2 0 0"),
        link("b", inertial(3)),
    )
    body = named(tree(export(*parts, fixed_joints="lump")), "link", "a").find("inertial")
    assert body.findtext("mass") == "4"
    assert body.findtext("pose") == "1.5 0 0 0 0 0"
    assert [float(body.findtext(f"inertia/{n}")) for n in ("ixx", "iyy", "izz")] == pytest.approx(
        [0.2, 0.2 + 1 * 1.5**2 + 3 * 0.5**2, 0.2 + 1 * 1.5**2 + 3 * 0.5**2]
    )


def test_a_rounded_plate_is_mended_and_said():
    plate = inertial(1, (0.1, 0.1, 0.200001))
    written = export(link("a", plate))
    assert rules(written) == ["lossy-inertia"]
    body = named(tree(written), "link", "a").find("inertial/inertia")
    low, middle, high = sorted(float(body.findtext(n)) for n in ("ixx", "iyy", "izz"))
    assert low + middle >= high


def test_an_exact_plate_is_left_alone():
    written = export(link("a", inertial(1, (0.1, 0.1, 0.2))))
    assert rules(written) == []
    assert named(tree(written), "link", "a").findtext("inertial/inertia/izz") == "0.2"


def make_tilted_rods(count):
    """Links with the tensor of a rod without radius, each tilted otherwise."""
    links = [link("base")]
    for number in range(count):
        turn = np.array(rotation_from_rpy((0.1 + number, 0.4 * number, 0.2)))
        full = turn @ np.diag([0.0, 0.2, 0.2]) @ turn.T
        xy, xz, yz = full[0, 1], full[0, 2], full[1, 2]
        links.append(link(f"rod{number}", inertial(1, np.diag(full), (xy, xz, yz))))
        links.append(joint(f"j{number}", "base", f"rod{number}"))
    return "".join(links)


def test_a_tilted_rod_has_a_radius_that_rounding_does_not_hide():
    exported = export(make_tilted_rods(20))
    named_links = {loss.name for loss in exported.losses if loss.code == "lossy-inertia"}
    assert named_links == {f"rod{number}" for number in range(20)}
    written = tree(exported)
    for number in range(20):
        inertia = named(written, "link", f"rod{number}").find("inertial/inertia")
        xx, xy, xz, yy, yz, zz = (float(part.text) for part in inertia)
        low, middle, high = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        assert 5e-8 < (low + middle - high) / high < 2e-7
        assert high == pytest.approx(0.2, rel=1e-6)


@pytest.mark.program("ign")
def test_tilted_rods_are_accepted(tmp_path):
    written = export(make_tilted_rods(40), version="1.9")
    path = tmp_path / "model.sdf"
    path.write_bytes(written.files[written.main])
    words = ["ign", "sdf", "-k", str(path)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.strip()) == (0, "Valid."), done.stderr


def test_shapes_keep_their_names_and_are_unique():
    visual, collision = (f'<{tag} name="v">{BOX}</{tag}>' for tag in ("visual", "collision"))
    shapes = f"{visual}{visual}{collision}<visual>{BOX}</visual>"
    model = tree(export(link("a", inertial() + shapes)))
    assert [e.get("name") for e in model.iter("visual")] == ["v_visual", "v_visual_1", "a_visual_2"]
    assert [e.get("name") for e in model.iter("collision")] == ["v"]


def test_shapes_of_a_lumped_link_keep_their_numbers():
    inside = f'{inertial()}<collision><origin xyz="0.1 0.2 0.3" rpy="1 2 3"/>{BOX}</collision>'
    parts = (link("a"), joint("j", "a", "b", "fixed", origin="5 0 0"), link("b", inside))
    pose = next(tree(export(*parts, fixed_joints="lump")).iter("collision")).find("pose")
    assert (pose.text, pose.get("relative_to")) == ("0.1 0.2 0.3 1 2 3", "b")
    pose = next(tree(export(*parts, target="gazebo-classic")).iter("collision")).find("pose")
    assert pose.text.startswith("5.1 0.2 0.3 ")
    assert pose.get("relative_to") is None


COLOR = '<material name="m"><color rgba="0.1 0.2 0.3 0.25"/></material>'


def test_a_colour_is_not_made_brighter():
    model = tree(export(link("a", f"{inertial()}<visual>{BOX}{COLOR}</visual>")))
    visual = next(model.iter("visual"))
    for light in ("ambient", "diffuse"):
        assert visual.findtext(f"material/{light}") == "0.1 0.2 0.3 0.25"
    assert visual.findtext("transparency") == "0.75"


def test_a_named_colour_is_looked_up():
    parts = (COLOR, link("a", f'{inertial()}<visual>{BOX}<material name="m"/></visual>'))
    assert next(tree(export(*parts)).iter("diffuse")).text == "0.1 0.2 0.3 0.25"


def test_a_capsule_is_three_shapes_where_there_is_none():
    capsule = '<collision><geometry><capsule radius="0.1" length="0.4"/></geometry></collision>'
    part = link("a", inertial() + capsule)
    assert [e.tag for e in next(tree(export(part)).iter("geometry"))] == ["capsule"]
    written = export(part, target="gazebo-classic")
    kinds = [e[0].tag for e in tree(written).iter("geometry")]
    assert kinds == ["cylinder", "sphere", "sphere"]
    assert "lossy-capsule" in rules(written)


def test_a_link_and_a_joint_of_one_name():
    written = export(link("a"), joint("b", "a", "b"), link("b"))
    model = tree(written)
    assert names(model, "link") == ["a", "b_link"]
    assert names(model, "joint") == ["b"]
    assert written.renamed == {("link", "b"): "b_link"}
    assert '"b": "b_link"' in written.files["names.json"].decode()


@pytest.mark.parametrize(
    ("old", "new"), [("arm::b", "arm_b"), ("__b__", "b"), ("__model__", "model")]
)
def test_names_that_sdf_forbids(old, new):
    written = export(link("a"), joint("j", "a", old), link(old))
    assert names(tree(written), "link") == ["a", new]
    assert rules(written) == ["lossy-name"]


def test_world_below_a_root_is_a_link_of_another_name():
    assert names(tree(export(link("a"), joint("j", "a", "world"), link("world"))), "link") == [
        "a",
        "world_link",
    ]


def test_a_quaternion_is_kept_where_there_is_a_word_for_it():
    weld = (
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/>'
        '<origin xyz="1 2 3" quat_xyzw="0 0 0.6 0.8"/></joint>'
    )
    parts = (weld, link("a"), link("b"))
    pose = named(tree(export(*parts)), "joint", "j").find("pose")
    assert (pose.text, pose.get("rotation_format")) == ("1 2 3 0 0 0.6 0.8", "quat_xyzw")
    old = named(tree(export(*parts, target="gazebo-classic", fixed_joints="keep")), "joint", "j")
    assert float(old.findtext("pose").split()[5]) == pytest.approx(1.2870022175866)


def test_what_is_written_twice_is_the_same():
    assert export(*WELDED, link("c", CUBE), joint("k", "a", "c", "fixed")).files == (
        export(*WELDED, link("c", CUBE), joint("k", "a", "c", "fixed")).files
    )


def test_a_joint_called_world():
    assert names(tree(export(link("a"), joint("world", "a", "b"), link("b"))), "joint") == [
        "world_joint"
    ]
