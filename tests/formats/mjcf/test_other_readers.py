"""The test cases of MuJoCo's and Drake's readers of URDF: one meaning, or a known difference."""

import pytest

from tests.conftest import CORPUS
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.write import write as write_mjcf
from urdftool.model.load import load
from urdftool.refusal import Refused

from .robots import BOX, export, find, joint, link, robot, rules, tree

DRAKE = CORPUS / "RobotLocomotion__drake"


def test_mujoco_reads_capsule(write):
    shape = (
        '<collision><origin rpy="-1.57080 0 0"/>'
        '<geometry><capsule length="0.14000" radius="0.07000"/></geometry></collision>'
    )
    model = tree(export(write("r.urdf", robot(link("torso", shape), name=""))))
    geom = model.find(".//worldbody//geom")
    assert geom.get("size") == "0.07 0.07"


def test_mujoco_reads_geom_names(write):
    inside = (
        f'<collision name="collision_box">{BOX}</collision><visual name="visual_sphere">'
        '<geometry><sphere radius="0.5"/></geometry></visual>'
    )
    model = tree(export(write("r.urdf", robot(link("torso", inside), name=""))))
    assert find(model, "geom", "collision_box").get("type") == "box"
    assert find(model, "geom", "visual_sphere").get("size") == "0.5"


@pytest.mark.parametrize("first", ["visual", "collision"])
def test_mujoco_unnames_the_second_of_one_name_and_this_renames_it(write, first):
    parts = {
        "visual": f'<visual name="shared">{BOX}</visual>',
        "collision": f'<collision name="shared">{BOX}</collision>',
    }
    inside = parts.pop(first) + "".join(parts.values())
    model = tree(export(write("r.urdf", robot(link("torso", inside), name=""))))
    names = sorted(geom.get("name") for geom in model.iter("geom") if geom.get("name"))
    assert names == ["shared", "torso_shared"]


def test_mujoco_reads_joint_types(write):
    inside = f"<collision>{BOX}</collision>"
    text = robot(
        link("world", ""), *(link(f"link{i}", inside) for i in range(1, 5)),
        joint("floating", "world", "link1", "floating", ""),
        joint("revolute", "world", "link2", "revolute", '<axis xyz="1.0 0.0 -1.0"/>'),
        joint("spherical", "world", "link3", "spherical", ""),
        joint("prismatic", "world", "link4", "prismatic", '<axis xyz="0.0 0.0 1.0"/>'),
        name="",
    )  # fmt: skip
    written = export(write("r.urdf", text))
    model = tree(written)
    assert find(model, "freejoint", "floating") is not None
    assert find(model, "joint", "revolute").get("axis") == "1 0 -1"
    assert find(model, "joint", "spherical").get("type") == "ball"
    assert find(model, "joint", "prismatic").get("type") == "slide"
    # MuJoCo's reader infers a mass from the boxes; here nothing is inferred, and it is said
    assert rules(written).count("lossy-massless") == 4


def test_mujoco_repeated_mesh_name(write, tmp_path):
    (tmp_path / "mesh.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    )
    shape = '<visual><geometry><mesh filename="mesh.obj" scale="{0} {0} {0}"/></geometry></visual>'
    links = [link(f"geom{i}", shape.format(scale)) for i, scale in enumerate((1, 2, 3, 2))]
    joints = [joint(f"j{i}", "geom0", f"geom{i}", "fixed", "") for i in (1, 2, 3)]
    model = tree(export(write("r.urdf", robot(*links, *joints, name=""))))
    assert len(list(model.find("asset").iter("mesh"))) == 3


def test_mujoco_mimic_becomes_joint_equality(write):
    text = robot(
        link("base"), link("left"), link("right"),
        joint("right_joint", "base", "right", "prismatic",
              '<axis xyz="1 0 0"/><limit lower="-1" upper="1"/>'
              '<mimic joint="left_joint" multiplier="-1" offset="0.02"/>'),
        joint("left_joint", "base", "left", "prismatic", '<limit lower="-1" upper="1"/>'),
    )  # fmt: skip
    (equality,) = tree(export(write("r.urdf", text))).find("equality")
    assert (equality.get("joint1"), equality.get("joint2")) == ("right_joint", "left_joint")
    assert equality.get("polycoef") == "0.02 -1 0 0 0"


CASES = {
    "all_geometries_as_collision": set(),
    "all_geometries_as_visual": set(),
    "conflicting_materials": set(),
    "convex_and_nonconvex_test": set(),
    "duplicate_materials": set(),
    "duplicate_but_same_materials_with_texture": set(),
    "non_conflicting_materials_1": set(),
    "non_conflicting_materials_3": set(),
    "two_unnamed_boxes": set(),
    "zero_dof_robot": set(),
    # Drake gives each root its own free body; a URDF has one
    "collision_filter_group_parsing_test": {"multiple-roots"},
    "non_conflicting_materials_2": {"multiple-roots"},
    # Drake knows world without a <link>, and has joints of its own
    "joint_parsing_test": {
        "multiple-roots", "detached-cycle", "not-a-number", "unknown-parent-link",
    },
}  # fmt: skip


@pytest.mark.corpus
@pytest.mark.parametrize("name", CASES)
def test_drake(name):
    folder = DRAKE / "multibody" / "parsing" / "test" / "urdf_parser_test"
    path = folder / f"{name}.urdf"
    found = load(path, packages={"drake": DRAKE})
    if CASES[name]:
        with pytest.raises(Refused) as caught:
            write_mjcf(found)
        assert {finding.code for finding in caught.value.findings} <= CASES[name]
    else:
        written = write_mjcf(found, Options())
        count = sum(len(link.collisions) for link in found.links)
        model = tree(written)
        assert len([g for g in model.iter("geom") if g.get("class") == "collision"]) == count
