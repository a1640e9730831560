"""Stages as the simulators need them: each case was a silent error of a converter."""

import math
from pathlib import Path

import pytest

from tests.formats.usd.stages import BOX, codes, export, joint, link, robot, stage_of

pytestmark = pytest.mark.library("pxr")

LIMIT = '<limit lower="-1" upper="2" effort="33.5" velocity="3"/>'


@pytest.fixture
def stage(write, tmp_path):
    """Convert a robot; gives the stage and the export."""
    made = []

    def convert(*parts, name="r", **options):
        written = export(write("r.urdf", robot(*parts, name=name)), **options)
        made.append(tmp_path / f"out{len(made)}")
        return stage_of(written, made[-1]), written

    return convert


def value(prim, name):
    return prim.GetAttribute(name).Get()


def bodies(stage):
    return [
        str(prim.GetPath())
        for prim in stage.Traverse()
        if "PhysicsRigidBodyAPI" in prim.GetAppliedSchemas()
    ]


def test_a_link_without_mass_on_a_fixed_joint_is_a_frame(stage):
    for mass in (0, None):
        result, _ = stage(link("base"), joint("f", "base", "tip"), link("tip", mass, BOX))
        assert bodies(result) == ["/r/base"]
        assert result.GetPrimAtPath("/r/base/tip/collisions/box")
        assert not result.GetPrimAtPath("/r/joints/f")


def test_every_body_has_mass_center_inertia_and_axes(stage):
    result, _ = stage(link("base", 2))
    prim = result.GetPrimAtPath("/r/base")
    assert value(prim, "physics:mass") == 2
    assert tuple(value(prim, "physics:centerOfMass")) == (0, 0, 0)
    assert prim.GetAttribute("physics:centerOfMass").HasAuthoredValue()
    assert value(prim, "physics:diagonalInertia")[0] == pytest.approx(0.1)
    assert value(prim, "physics:principalAxes").GetReal() == 1
    assert list(value(prim, "newton:inertia")) == [0.1, 0.1, 0.1, 0, 0, 0]


def test_a_massless_base_becomes_a_frame_of_its_heaviest_child(stage):
    result, written = stage(
        link("world", None),
        joint("a", "world", "light", more='<origin xyz="1 0 0"/>'),
        joint("b", "world", "heavy", more='<origin xyz="0 2 0"/>'),
        link("light", 1),
        link("heavy", 5),
    )
    assert bodies(result) == ["/r/light", "/r/heavy"]
    roots = [p for p in result.GetPrimAtPath("/r/joints").GetChildren()
             if not p.GetRelationship("physics:body0").GetTargets()]  # fmt: skip
    assert [prim.GetName() for prim in roots] == ["root_joint"]
    assert not any(code == "lossy-massless-body" for code, _ in codes(written))


def test_a_moving_link_without_mass_gets_some_and_says_so(stage):
    result, written = stage(link("a"), joint("j", "a", "b", "continuous"), link("b", None))
    assert value(result.GetPrimAtPath("/r/b"), "physics:mass") == pytest.approx(1e-6)
    assert ("lossy-massless-body", "b") in codes(written)


SINGULAR = '<inertia ixx="1e-6" ixy="1e-6" ixz="1e-6" iyy="1e-6" iyz="1e-6" izz="1e-6"/>'


def test_an_inconsistent_inertia_is_refused_unless_repaired(stage):
    from urdftool.refusal import Refused

    with pytest.raises(Refused) as refused:
        stage(link("a"), joint("j", "a", "b", "continuous"), link("b", inertia=SINGULAR))
    assert [f.code for f in refused.value.findings] == ["inertia-triangle-inequality"]
    result, written = stage(
        link("a"),
        joint("j", "a", "b", "continuous"),
        link("b", inertia=SINGULAR),
        fix_inertia="lift",
    )
    moments = sorted(value(result.GetPrimAtPath("/r/b"), "physics:diagonalInertia"))
    assert moments == pytest.approx([1.5e-6, 1.5e-6, 3e-6], rel=1e-5)
    assert ("lossy-inertia", "b") in codes(written)


def test_an_inconsistent_inertia_of_what_never_moves_is_repaired_and_named(stage):
    _, written = stage(
        link("a", inertia=SINGULAR),
        joint("f", "a", "b"),
        link("b", inertia=SINGULAR),
        joint("j", "b", "c", "continuous"),
        link("c"),
    )
    assert {("lossy-inertia", "a"), ("lossy-inertia", "b")} <= set(codes(written))


def test_a_moment_below_the_floor_of_newton_is_raised(stage):
    tensor = '<inertia ixx="1e-14" ixy="0" ixz="0" iyy="1e-14" iyz="0" izz="1e-14"/>'
    result, written = stage(link("a", inertia=tensor))
    assert min(value(result.GetPrimAtPath("/r/a"), "physics:diagonalInertia")) >= 1e-10
    assert ("lossy-inertia-raised", "a") in codes(written)


def test_joint_values_have_the_units_of_each_schema(stage):
    dynamics = '<dynamics damping="0.5" friction="0.2"/>'
    parts = link("a"), joint("j", "a", "b", "revolute", LIMIT + dynamics), link("b")
    result, _ = stage(*parts, actuators="described")
    prim = result.GetPrimAtPath("/r/joints/j")
    assert value(prim, "physics:lowerLimit") == pytest.approx(math.degrees(-1))
    assert value(prim, "drive:angular:physics:maxForce") == 33.5
    assert value(prim, "drive:angular:physics:stiffness") == 0
    assert value(prim, "newton:velocityLimit") == pytest.approx(math.degrees(3))
    assert value(prim, "newton:damping") == pytest.approx(math.radians(0.5))
    assert value(prim, "newton:friction") == pytest.approx(0.2)
    axis = "physxJointAxis:angular"
    assert value(prim, f"{axis}:maxJointVelocity") == pytest.approx(math.degrees(3))
    assert value(prim, f"{axis}:staticFrictionEffort") == pytest.approx(0.2)
    assert value(prim, f"{axis}:viscousFrictionCoefficient") == pytest.approx(math.radians(0.5))


def test_a_prismatic_joint_is_in_meters(stage):
    result, _ = stage(link("a"), joint("j", "a", "b", "prismatic", LIMIT), link("b"))
    prim = result.GetPrimAtPath("/r/joints/j")
    assert value(prim, "physics:upperLimit") == 2
    assert value(prim, "newton:velocityLimit") == 3
    assert value(prim, "drive:linear:physics:maxForce") == 33.5


@pytest.mark.parametrize(
    ("axis", "token", "turned"),
    [("0 0 2", "Z", False), ("0 1 0", "Y", False), ("0 0 -1", "X", True), ("1 1 1", "X", True)],
)
def test_axes_are_a_token_or_a_rotation(stage, axis, token, turned):
    more = f'<axis xyz="{axis}"/>{LIMIT}'
    result, _ = stage(link("a"), joint("j", "a", "b", "revolute", more), link("b"))
    prim = result.GetPrimAtPath("/r/joints/j")
    assert value(prim, "physics:axis") == token
    assert (value(prim, "physics:localRot1").GetReal() != 1) == turned


def test_a_planar_joint_locks_three_axes_and_frees_three(stage):
    result, _ = stage(link("a"), joint("j", "a", "b", "planar", '<axis xyz="0 0 1"/>'), link("b"))
    prim = result.GetPrimAtPath("/r/joints/j")
    for name in ("transX", "transY", "rotZ"):
        assert value(prim, f"limit:{name}:physics:low") == -math.inf
    for name in ("transZ", "rotX", "rotY"):
        assert value(prim, f"limit:{name}:physics:low") > value(prim, f"limit:{name}:physics:high")


def mimic(leader, more=""):
    return f'<mimic joint="{leader}" {more}/>' + LIMIT


def test_chains_of_mimic_end_at_a_joint_that_follows_none(stage):
    result, _ = stage(
        link("a"), link("b"), link("c"), link("d"),
        joint("one", "a", "b", "revolute", LIMIT),
        joint("two", "b", "c", "revolute", mimic("one", 'multiplier="2" offset="0.1"')),
        joint("three", "c", "d", "revolute", mimic("two", 'multiplier="3"')),
    )  # fmt: skip
    prim = result.GetPrimAtPath("/r/joints/three")
    targets = prim.GetRelationship("newton:mimicJoint").GetTargets()
    assert [str(path) for path in targets] == ["/r/joints/one"]
    assert value(prim, "newton:mimicCoef1") == 6
    assert value(prim, "newton:mimicCoef0") == pytest.approx(math.degrees(0.3))


def test_a_mimic_on_a_fixed_joint_is_dropped_and_reported(stage):
    result, written = stage(
        link("a"), link("b"), link("c"),
        joint("one", "a", "b", "revolute", LIMIT),
        joint("two", "b", "c", "fixed", '<mimic joint="one"/>'),
    )  # fmt: skip
    schemas = [prim.GetMetadata("apiSchemas") for prim in result.Traverse()]
    assert not any("NewtonMimicAPI" in str(schema) for schema in schemas)
    assert ("lossy-mimic", "two") in codes(written)


def test_a_velocity_limit_of_zero_is_left_out(stage):
    more = '<limit lower="0" upper="1" effort="1" velocity="0"/>'
    result, written = stage(link("a"), joint("j", "a", "b", "revolute", more), link("b"))
    assert not result.GetPrimAtPath("/r/joints/j").GetAttribute("newton:velocityLimit")
    assert ("lossy-velocity", "j") in codes(written)


def test_names_become_identifiers_and_stay_in_the_custom_data(stage):
    result, written = stage(
        link("link_8.0"), link("8link"), link("größe"), link("joints"),
        joint("a/b", "link_8.0", "8link", "continuous"),
        joint("größe", "8link", "größe", "continuous"),
        joint("joints", "größe", "joints", "continuous"),
        name="my robot",
    )  # fmt: skip
    root = str(result.GetDefaultPrim().GetPath())
    assert root == "/my_robot"
    prims = map(result.GetPrimAtPath, bodies(result))
    names = {str(prim.GetPath()): prim.GetCustomDataByKey("urdf:link") for prim in prims}
    assert names == {
        f"{root}/link_8_0": "link_8.0",
        f"{root}/_8link": "8link",
        f"{root}/gr__e": "größe",
        f"{root}/joints_1": "joints",
    }
    assert {("lossy-name", "link_8.0"), ("lossy-name", "8link")} <= codes(written)


def test_a_free_base_has_no_joint_to_the_world_and_the_root_on_its_body(stage):
    fixed, _ = stage(link("a"))
    assert fixed.GetPrimAtPath("/r/joints/root_joint")
    assert "PhysicsArticulationRootAPI" in fixed.GetPrimAtPath("/r").GetAppliedSchemas()
    free, _ = stage(link("a"), base="free")
    assert not free.GetPrimAtPath("/r/joints/root_joint")
    assert "PhysicsArticulationRootAPI" in free.GetPrimAtPath("/r/a").GetAppliedSchemas()


def test_targets_choose_the_attributes(stage):
    parts = (link("a"), joint("j", "a", "b", "revolute", LIMIT), link("b"))
    newton = stage(*parts, target="newton")[0].ExportToString()
    assert "physx" not in newton
    assert "newton:velocityLimit" in newton
    isaac = stage(*parts, target="isaac")[0].ExportToString()
    assert "IsaacRobotAPI" in isaac
    assert "physxJointAxis:angular:maxJointVelocity" in isaac


TRIANGLES = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def test_a_mesh_used_twice_is_instanced_and_a_mirrored_one_is_turned(stage, write):
    write("m.obj", TRIANGLES)
    shape = '<visual><geometry><mesh filename="m.obj"{}/></geometry></visual>'
    result, _ = stage(link("a", shapes=shape.format("") * 2 + shape.format(' scale="-1 1 1"')))
    prims = result.GetPrimAtPath("/r/a/visuals").GetChildren()
    assert [prim.IsInstance() for prim in prims] == [True, True, False]
    mesh = result.GetPrimAtPath("/r/a/visuals/mesh_2/mesh") or next(
        child for child in prims[2].GetChildren()
    )
    assert value(mesh, "subdivisionScheme") == "none"
    import numpy as np

    points = np.array(value(mesh, "points"))
    corners = points[np.array(value(mesh, "faceVertexIndices")).reshape(-1, 3)]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(1 / 6)


def test_colors_are_linear_and_colliders_are_guides(stage):
    visual = (
        '<visual><geometry><sphere radius="1"/></geometry>'
        '<material name="m"><color rgba="1 0.5 0 0.25"/></material></visual>'
    )
    result, _ = stage(link("a", shapes=visual + BOX))
    shader = result.GetPrimAtPath("/r/materials/m/surface")
    assert value(shader, "inputs:diffuseColor")[1] == pytest.approx(0.2140, abs=1e-4)
    assert value(shader, "inputs:opacity") == 0.25
    box = result.GetPrimAtPath("/r/a/collisions/box")
    assert value(box, "purpose") == "guide"
    assert tuple(value(box, "xformOp:scale")) == (0.1, 0.2, 0.3)
    assert value(box, "size") == 1


@pytest.mark.parametrize("target", ["both", "newton", "isaac"])
@pytest.mark.parametrize("layers", ["single", "payload"])
def test_usd_validation_finds_nothing(stage, layers, target):
    from pxr import Usd, UsdValidation

    if Usd.GetVersion() < (0, 25, 8):
        pytest.skip("the wheel of this usd-core has no validators")
    result, _ = stage(
        link("world", None),
        joint("f", "world", "a"),
        link("a", shapes=BOX),
        joint("j", "a", "b", "revolute", LIMIT),
        link("b", None, BOX),
        layers=layers,
        target=target,
    )
    assert len(bodies(result)) == 2
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 20
    found = UsdValidation.ValidationContext(validators).Validate(result)
    assert [error.GetMessage() for error in found] == []


def test_pairs_of_an_srdf_are_filtered_by_body(stage, write):
    srdf = write(
        "r.srdf",
        '<robot name="r"><disable_collisions link1="tip" link2="b" reason="Never"/></robot>',
    )
    result, _ = stage(
        link("a"), joint("f", "a", "tip"), link("tip", None),
        joint("j", "a", "b", "continuous"), link("b"), srdf=srdf,
    )  # fmt: skip
    targets = result.GetPrimAtPath("/r/a").GetRelationship("physics:filteredPairs").GetTargets()
    assert [str(path) for path in targets] == ["/r/b"]
    assert value(result.GetPrimAtPath("/r"), "newton:selfCollisionEnabled") is True


def test_the_api_writes_and_compares(write, tmp_path):
    import urdftool
    from urdftool.compare.check import is_faithful

    tensor = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    path = write("r.urdf", robot(link("a"), joint("f", "a", "b"), link("b", 0, inertia=tensor)))
    written = urdftool.export_usd(urdftool.load(path), tmp_path / "r.usdc")
    assert (tmp_path / "r.usdc").read_bytes().startswith(b"PXR-USDC")
    assert is_faithful(written.checks)
    assert ("lossy-inertia-without-mass", "b") in codes(written)


def test_a_robot_on_legs_has_a_free_base(write, tmp_path):
    from tests.formats.mjcf.test_base import quadruped

    written = export(write("legs.urdf", quadruped()), file="r.usda")
    stage = stage_of(written, tmp_path / "free")
    assert ("lossy-free-base", "trunk") in codes(written)
    assert not stage.GetPrimAtPath("/r/joints/root_joint")
    assert stage.GetPrimAtPath("/r/trunk").HasAPI("PhysicsArticulationRootAPI")
    fixed = export(write("legs.urdf", quadruped()), file="r.usda", base="fixed")
    assert stage_of(fixed, tmp_path / "fixed").GetPrimAtPath("/r/joints/root_joint")


CONFIG = """[joints."*"]
kp = 120
kd = 3
armature = 0.02
force-range = 40
"""


def test_an_actuator_file_sets_the_gains_of_the_drives(stage, write):
    parts = (link("a"), joint("j", "a", "b", "revolute", LIMIT), link("b"))
    plain, written = stage(*parts, actuators="none")
    drive = plain.GetPrimAtPath("/r/joints/j")
    assert value(drive, "drive:angular:physics:stiffness") == 0
    assert ("lossy-gains", "") in codes(written)
    made, written = stage(*parts, actuator_config=Path(write("gains.toml", CONFIG)), target="isaac")
    drive = made.GetPrimAtPath("/r/joints/j")
    assert value(drive, "drive:angular:physics:stiffness") == pytest.approx(math.radians(120))
    assert value(drive, "drive:angular:physics:damping") == pytest.approx(math.radians(3))
    assert value(drive, "drive:angular:physics:maxForce") == 40
    assert value(drive, "newton:armature") == pytest.approx(0.02)
    assert value(drive, "physxJoint:maxJointVelocity") == pytest.approx(math.degrees(3))
    assert {code for code, _ in codes(written)} >= {"lossy-actuator-config"}
    assert ("lossy-gains", "") not in codes(written)


def test_joints_with_a_position_interface_are_named(stage):
    control = (
        '<ros2_control name="c" type="system"><joint name="j">'
        '<command_interface name="position"/></joint></ros2_control>'
    )
    parts = (link("a"), joint("j", "a", "b", "revolute", LIMIT), link("b"), control)
    _, written = stage(*parts, actuators="none")
    (gains,) = [loss for loss in written.losses if loss.code == "lossy-gains"]
    assert "'j' have a position" in gains.message


@pytest.mark.parametrize(
    ("kinds", "gearing", "offset"),
    [
        (("revolute", "revolute"), 1.5, math.degrees(-0.2)),
        (("revolute", "prismatic"), math.degrees(1.5), math.degrees(-0.2)),
        (("prismatic", "revolute"), math.radians(1.5), -0.2),
    ],
)
def test_a_mimic_joint_of_isaac_is_in_degrees(stage, kinds, gearing, offset):
    follower, leader = kinds
    mimic = '<mimic joint="j" multiplier="-1.5" offset="0.2"/>'
    parts = (
        link("a"), joint("j", "a", "b", leader, LIMIT), link("b"),
        joint("m", "a", "c", follower, LIMIT + mimic), link("c"),
    )  # fmt: skip
    made, _ = stage(*parts, target="isaac")
    prim = made.GetPrimAtPath("/r/joints/m")
    assert value(prim, "physxMimicJoint:rotX:gearing") == pytest.approx(gearing)
    assert value(prim, "physxMimicJoint:rotX:offset") == pytest.approx(offset)
    both, _ = stage(*parts)
    assert not both.GetPrimAtPath("/r/joints/m").HasAttribute("physxMimicJoint:rotX:gearing")


def test_a_mimic_joint_without_limits_is_reported_for_physx(stage):
    parts = (
        link("a"), joint("j", "a", "b", "continuous"), link("b"),
        joint("m", "a", "c", "revolute", LIMIT + '<mimic joint="j"/>'), link("c"),
    )  # fmt: skip
    assert ("lossy-physx-mimic", "m") in codes(stage(*parts)[1])
    assert ("lossy-physx-mimic", "m") not in codes(stage(*parts, target="newton")[1])


def test_scenery_without_mass_has_no_body(stage, write):
    import urdftool

    made, written = stage(link("ground", 0, BOX, inertia=""))
    assert bodies(made) == []
    assert made.GetPrimAtPath("/r/ground/collisions/box").HasAPI("PhysicsCollisionAPI")
    assert not made.GetPrimAtPath("/r/joints/root_joint")
    assert "lossy-massless-body" not in {code for code, _ in codes(written)}
    path = write("ground.usda", "")
    made.Export(path)
    read = urdftool.load(path)
    assert list(read.link) == ["ground"]
    assert len(read.link["ground"].collisions) == 1


def test_friction_of_contact_is_a_physics_material(stage):
    from pxr import UsdShade

    contact = '<contact><lateral_friction value="0.4"/></contact>'
    block = '<gazebo reference="b"><mu1>0.2</mu1><mu2>0.1</mu2></gazebo>'
    made, written = stage(
        link("a", 1, BOX + contact), joint("j", "a", "b"), link("b", 1, BOX), block,
        joint("k", "a", "c"), link("c", 1, BOX),
    )  # fmt: skip
    found = {}
    for name in "abc":
        prim = made.GetPrimAtPath(f"/r/{name}/collisions/box")
        material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")
        if material:
            found[name] = value(material.GetPrim(), "physics:dynamicFriction")
    assert found == {"a": pytest.approx(0.4), "b": pytest.approx(0.2)}
    assert ("lossy-friction", "b") in codes(written)


def test_friction_of_a_mesh_that_two_links_use_is_that_of_each(stage, write):
    from pxr import UsdShade

    write("tetra.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    shape = '<collision><geometry><mesh filename="tetra.obj"/></geometry></collision>'
    made, _ = stage(
        link("a", 1, shape), joint("j", "a", "b"), link("b", 1, shape), joint("k", "a", "c"),
        link("c", 1, shape), '<gazebo reference="b"><mu1>0.2</mu1></gazebo>',
    )  # fmt: skip
    found = {}
    for name in "abc":
        prim = made.GetPrimAtPath(f"/r/{name}/collisions/mesh")
        collider = prim.GetChild("mesh")
        assert prim.IsInstance() == (name != "b")
        material = UsdShade.MaterialBindingAPI(collider).GetDirectBinding("physics").GetMaterial()
        found[name] = bool(material)
    assert found == {"a": False, "b": True, "c": False}


def test_collision_meshes_are_decomposed_into_scaled_pieces(stage, write):
    import numpy as np

    from urdftool.formats.common.cut import Cut

    write("tetra.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    shape = '<{}><geometry><mesh filename="tetra.obj" scale="1 1 -2"/></geometry></{}>'
    shapes = shape.format("collision", "collision") + shape.format("visual", "visual")
    piece = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]), np.array([[0, 2, 1]])

    def cutter(paths):
        return {path: Cut([piece, piece], 0.01) for path in paths}

    made, written = stage(link("a", 1, shapes), decompose=True, cutter=cutter)
    prims = made.GetPrimAtPath("/r/a/collisions/mesh").GetChildren()
    assert [prim.GetName() for prim in prims] == ["mesh_0", "mesh_1"]
    assert {value(prim, "physics:approximation") for prim in prims} == {"convexHull"}
    assert {value(prim, "newton:maxHullVertices") for prim in prims} == {-1}
    points = np.array(value(prims[0], "points"))
    corners = value(prims[0], "faceVertexIndices")
    assert points[:, 2].min() == -2 or len(points) == 3
    normal = np.cross(*(points[corners[i]] - points[corners[0]] for i in (1, 2)))
    assert normal[2] > 0
    assert ("lossy-convex", "a") in codes(written)
    assert len(made.GetPrimAtPath("/r/a/visuals/mesh").GetChildren()) == 1
