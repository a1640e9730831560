"""Values of stages of other tools: drives, mimic, groups, articulations, scales, materials."""

import math
from pathlib import Path

import pytest

from tests.formats.usd.stages import BOX, body, export, joint, link, robot, stage, turning
from urdftool.errors import ModelError
from urdftool.formats.usd.read import read as read_usd

pytestmark = pytest.mark.library("pxr")

TWO = body("a"), body("b")
THREE = (*TWO, body("c"))
COLLIDER = (
    '        def Cube "box" (\n            prepend apiSchemas = ["PhysicsCollisionAPI"]\n'
    "        )\n        {\n        }\n"
)
PIXEL = (
    b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\2\0\0\0\x90wS\xde\0\0\0\x0cIDATx\x9cc\xf8"
    b"\xcf\xc0\0\0\3\1\1\0\xc9\xfe\x92\xef\0\0\0\0IEND\xaeB`\x82"
)


def schemas(text, *names):
    """Apply schemas to the joint of a text."""
    listed = ", ".join(f'"{name}"' for name in names)
    return text.replace('"j"\n', f'"j" (\n        prepend apiSchemas = [{listed}]\n    )\n', 1)


def codes(reading):
    return {loss.code: loss for loss in reading.losses}


def test_drives_are_per_degree(read):
    reading = read(stage(*TWO, turning("j", "a", "b",
        "        float drive:angular:physics:stiffness = 2\n"
        "        float drive:angular:physics:damping = 0.1\n"
        "        float drive:angular:physics:maxForce = 5\n"
        "        float physics:lowerLimit = -90\n        float newton:friction = 0.3\n"
        "        float newton:velocityLimit = 180\n"
        "        float newton:damping = 0.2")))  # fmt: skip
    joint = reading.robot.joint["j"]
    (actuator,) = reading.robot.joint_actuators
    assert joint.limit.lower == pytest.approx(-math.pi / 2)
    assert (joint.limit.upper, joint.limit.effort) == (math.inf, 5)
    assert joint.limit.velocity == pytest.approx(math.pi)
    assert joint.dynamics.damping == pytest.approx(math.degrees(0.2))
    assert joint.dynamics.friction == pytest.approx(0.3)
    assert (actuator.mode, actuator.force_range) == ("position", (-5, 5))
    assert actuator.bias == pytest.approx((0, -math.degrees(2), -math.degrees(0.1)))


def test_a_slide_without_bounds_is_not_locked_by_its_effort(read):
    text = turning("j", "a", "b", "        float drive:linear:physics:maxForce = 5")
    limit = read(stage(*TWO, text.replace("Revolute", "Prismatic"))).robot.joint["j"].limit
    assert (limit.lower, limit.upper, limit.effort) == (-math.inf, math.inf, 5)


def test_attributes_of_mujoco_are_per_radian(read):
    robot = read(stage(*TWO, turning("j", "a", "b",
        "        double mjc:damping = 0.2\n        double mjc:armature = 0.01\n"
        "        double mjc:actuatorfrcrange:min = -3\n"
        "        double mjc:actuatorfrcrange:max = 3"))).robot  # fmt: skip
    joint = robot.joint["j"]
    assert joint.dynamics.damping == pytest.approx(0.2)
    assert joint.dynamics.armature == pytest.approx(0.01)
    assert joint.limit.effort == 3


def test_a_joint_with_one_free_axis_has_its_limits(read):
    locked = "".join(
        f"        float limit:{name}:physics:low = 1\n"
        f"        float limit:{name}:physics:high = -1\n"
        for name in ("transX", "transY", "transZ", "rotX", "rotZ")
    )
    text = turning("j", "a", "b", (
        f"{locked}        float limit:rotY:physics:low = -45\n"
        "        float limit:rotY:physics:high = 45\n"
        "        float drive:rotY:physics:maxForce = 7")).replace("PhysicsRevoluteJoint", "PhysicsJoint")  # noqa: E501  # fmt: skip
    joint = read(stage(*TWO, text)).robot.joint["j"]
    assert (joint.type, joint.axis.xyz) == ("revolute", (0, 1, 0))
    assert (joint.limit.lower, joint.limit.effort) == (pytest.approx(-math.pi / 4), 7)


@pytest.mark.parametrize(
    ("schema", "lines", "factor", "offset"),
    [
        ("NewtonMimicAPI", ("rel newton:mimicJoint = {}", "float newton:mimicCoef1 = -2",
         "float newton:mimicCoef0 = 90"), -2, math.pi / 2),
        ("PhysxMimicJointAPI:rotZ", ("rel physxMimicJoint:rotZ:referenceJoint = {}",
         "float physxMimicJoint:rotZ:gearing = 2"), -2, 0),
        ("MjcEqualityJointAPI", ("rel mjc:target = {}", "double mjc:coef1 = 0.5",
         "double mjc:coef0 = 1"), 0.5, 1),
    ],
)  # fmt: skip
def test_mimic_in_every_spelling(read, schema, lines, factor, offset):
    more = "".join(f"        {line.format('</r/lead>')}\n" for line in lines)
    follower = schemas(turning("j", "b", "c", more), schema)
    joint = read(stage(*THREE, turning("lead", "a", "b"), follower)).robot.joint["j"]
    assert joint.mimic.joint == "lead"
    assert joint.mimic.multiplier == pytest.approx(factor)
    assert joint.mimic.offset == pytest.approx(offset)


def test_bodies_on_the_world_are_fixed_to_the_base(read):
    def hold(name, at):
        return (
            f'    def PhysicsFixedJoint "{name}"\n    {{\n        rel physics:body1 = </r/{at}>\n'
            "        point3f physics:localPos0 = (0, 0, 1)\n    }\n"
        )

    reading = read(stage(body("a", at="(0, 0, 1)"), body("b", at="(0, 0, 1)"), body("c"),
                         turning("j", "a", "c"), hold("one", "a"), hold("two", "b")))  # fmt: skip
    two = reading.robot.joint["two"]
    assert (two.type, two.parent, two.child) == ("fixed", "a", "b")
    assert two.origin.xyz == pytest.approx((0, 0, 0))
    assert "unread-anchor" in codes(reading)


def test_a_stage_of_cloned_robots_has_the_links_of_one(write, tmp_path):
    hinge = joint("j", "a", "b", "continuous")
    root = link("base", None) + joint("hold", "base", "a")
    path = write("r.urdf", robot(root, link("a", 1, BOX), hinge, link("b", 1, BOX)))
    (tmp_path / "r.usda").write_bytes(export(path, file="r.usda").files["r.usda"])
    clones = "".join(
        f'        def Xform "env_{n}" (references = @./r.usda@)\n        {{\n        }}\n'
        for n in range(2)
    )
    text = '#usda 1.0\n(\n    defaultPrim = "World"\n    upAxis = "Z"\n)\n'
    text += f'def Xform "World"\n{{\n    def Scope "envs"\n    {{\n{clones}    }}\n}}\n'
    (tmp_path / "envs.usda").write_text(text)
    reading = read_usd(tmp_path / "envs.usda")
    assert reading.robot.name == "r"
    assert set(reading.robot.link) == {"base", "a", "b"}
    assert [link.name for link in reading.robot.tree.roots] == ["base"]
    found = codes(reading)
    assert "unread-articulation" in found
    assert "unread-scenery" not in found


def test_of_two_articulations_the_larger_is_read(read):
    def arm(name, count):
        bodies = "".join(body(f"{name}{index}") for index in range(count))
        joints = "".join(
            turning(f"{name}j{index}", f"{name}/{name}{index}", f"{name}/{name}{index + 1}")
            for index in range(count - 1)
        )
        head = '        prepend apiSchemas = ["PhysicsArticulationRootAPI"]\n    )'
        return f'    def Xform "{name}" (\n{head}\n    {{\n{bodies}{joints}    }}\n'

    reading = read(stage(arm("x", 2), arm("y", 3), body("loose")))
    assert sorted(reading.robot.link) == ["y0", "y1", "y2"]
    assert codes(reading)["unread-articulation"].data["names"] == ["/r/x"]
    assert codes(reading)["unread-body"].data["names"] == ["loose"]
    text = stage(arm("x", 2), arm("y", 3), body("loose"))
    for name in ("x", "/r/x"):
        assert sorted(read(text, name=name).robot.link) == ["x0", "x1"]
    with pytest.raises(ModelError, match="no articulation 'z'; it has /r/x, /r/y"):
        read(text, name="z")


def test_a_name_of_two_articulations_is_refused(read):
    head = '        prepend apiSchemas = ["PhysicsArticulationRootAPI"]\n    )\n    {\n'

    def make_robot(folder):
        joint = turning("j", f"{folder}/x/a", f"{folder}/x/b")
        inner = f'    def Xform "x" (\n{head}{body("a")}{body("b")}{joint}    }}\n'
        return f'    def Xform "{folder}"\n    {{\n{inner}    }}\n'

    with pytest.raises(ModelError, match="2 articulations with the name 'x'; it has /r/p/x, /r/q"):
        read(stage(make_robot("p"), make_robot("q")), name="x")


def test_scale_counts_for_joint_frames_and_centers_of_mass(read):
    text = stage(*TWO, turning("j", "a", "b",
        "        point3f physics:localPos0 = (0.5, 0, 0)\n"
        "        point3f physics:localPos1 = (-0.25, 0, 0)"))  # fmt: skip
    text = text.replace("centerOfMass = (0, 0, 0)", "centerOfMass = (0, 0, 0.5)")
    text = text.replace(
        'def Xform "r"\n{\n',
        'def Xform "r"\n{\n    double3 xformOp:scale = (2, 2, 2)\n'
        '    uniform token[] xformOpOrder = ["xformOp:scale"]\n',
    )
    robot = read(text).robot
    assert robot.joint["j"].origin.xyz == pytest.approx((1, 0, 0))
    assert robot.link["b"].inertial.origin.xyz == pytest.approx((0.5, 0, 1))


def test_pairs_and_groups_become_exclusions(read):
    groups = "".join(
        f'    def PhysicsCollisionGroup "g{name}"\n    {{\n'
        f"        rel collection:colliders:includes = </r/{name}>\n"
        f"        rel physics:filteredGroups = {target}\n    }}\n"
        for name, target in (("a", "</r/gb>"), ("b", "[]"))
    )
    pair = "        rel physics:filteredPairs = </r/a/box>\n"
    text = stage(body("a", more=COLLIDER), body("b", more=COLLIDER),
                 body("c", more=COLLIDER + pair), turning("j", "a", "b"), turning("k", "b", "c"),
                 groups)  # fmt: skip
    found = {frozenset((e.link, e.other)) for e in read(text).robot.exclusions}
    assert found == {frozenset("ab"), frozenset("ac")}


def test_disabled_parts_are_not_read(read):
    off = COLLIDER.replace(
        "        {\n", "        {\n            bool physics:collisionEnabled = 0\n"
    )
    static = body("b").replace("float physics:mass", "bool physics:rigidBodyEnabled = 0\n        float physics:mass")  # noqa: E501  # fmt: skip
    robot = read(stage(body("a", more=off), static)).robot
    assert list(robot.link) == ["a"]
    assert not robot.link["a"].collisions
    assert len(robot.link["a"].visuals) == 1


def test_what_is_not_read_is_reported_once(read):
    more = (
        "        float physxRigidBody:linearDamping = 0.1\n"
        "        int physxRigidBody:solverPositionIterationCount = 4\n"
    )
    text = stage(body("a", more=more), body("b", more=more), turning("j", "a", "b"))
    off = ("bool newton:selfCollisionEnabled", "bool physxArticulation:enabledSelfCollisions")
    lines = "".join(f"    custom {name} = 0\n" for name in off)
    text = text.replace('def Xform "r"\n{\n', f'def Xform "r"\n{{\n{lines}')
    found = codes(read(text))
    assert found["unread-self-collision"].data["names"] == ["r"]
    loss = found["unread-attribute"]
    assert loss.data["names"] == ["physxRigidBody:linearDamping"]
    assert text[loss.location.start :].startswith("float physxRigidBody:linearDamping")
    assert found["unread-setting"].data["names"] == ["physxRigidBody:solverPositionIterationCount"]


MESH = """        def Mesh "m" (
            prepend apiSchemas = ["MaterialBindingAPI"]
        )
        {
            int[] faceVertexCounts = [4, 3]
            int[] faceVertexIndices = [0, 1, 2, 3, 0, 1, 2]
            point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
            texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (
                interpolation = "vertex"
            )
            rel material:binding = </r/image>
            uniform token subsetFamily:materialBind:familyType = "partition"

            def GeomSubset "red" (
                prepend apiSchemas = ["MaterialBindingAPI"]
            )
            {
                uniform token elementType = "face"
                uniform token familyName = "materialBind"
                int[] indices = [1]
                rel material:binding = </r/red>
            }
        }
"""
MATERIALS = """    def Material "red"
    {
        color3f inputs:diffuseColor = (1, 0, 0)
        token outputs:surface.connect = </r/red/s.outputs:surface>

        def Shader "s"
        {
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </r/red.inputs:diffuseColor>
            token outputs:surface
        }
    }

    def Material "image"
    {
        token outputs:surface.connect = </r/image/s.outputs:surface>

        def Shader "s"
        {
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </r/image/t.outputs:rgb>
            token outputs:surface
        }

        def Shader "t"
        {
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @./pixel.png@
            float3 outputs:rgb
        }
    }
"""


@pytest.mark.parametrize("packed", [False, True])
def test_colors_textures_and_subsets_of_meshes(write, tmp_path, packed):
    from pxr import UsdUtils

    from urdftool.formats.usd.read import read

    (tmp_path / "pixel.png").write_bytes(PIXEL)
    path = write("s.usda", stage(body("a", more=MESH), MATERIALS))
    if packed:
        assert UsdUtils.CreateNewUsdzPackage(str(path), str(tmp_path / "s.usdz"))
        path = tmp_path / "s.usdz"
    red, image = read(path, mesh_folder=tmp_path / "meshes").robot.link["a"].visuals
    assert red.material.color == pytest.approx((1, 0, 0, 1))
    assert red.geometry.filename.endswith(".stl")
    assert Path(image.material.texture).read_bytes() == PIXEL
    text = Path(image.geometry.filename).read_text()
    assert (text.count("\nvt "), text.count("\nf ")) == (4, 2)


@pytest.mark.parametrize("arc", ["references", "payload"])
@pytest.mark.parametrize("instanceable", ["true", "false"])
def test_a_robot_that_is_referred_to(write, read, arc, instanceable):
    write("arm.usda", stage(body("a", more=COLLIDER), body("b"), turning("j", "a", "b")))
    robot = read(
        '#usda 1.0\n(\n    defaultPrim = "cell"\n    metersPerUnit = 1\n    upAxis = "Z"\n)\n'
        f'def Xform "cell"\n{{\n    def "arm" (\n        instanceable = {instanceable}\n'
        f"        prepend {arc} = @./arm.usda@\n    )\n    {{\n    }}\n}}\n"
    ).robot
    assert (robot.joint["j"].parent, robot.joint["j"].child) == ("a", "b")
    assert len(robot.link["a"].collisions) == 1
    assert robot.link["a"].place.path.endswith("arm.usda")
    assert len(robot.source.files) == 2


def test_variants_that_are_not_selected_are_reported(read):
    text = stage(*TWO, turning("j", "a", "b")).replace(
        'def Xform "r"\n{\n',
        'def Xform "r" (\n    variants = {\n        string hand = "none"\n    }\n'
        '    prepend variantSets = "hand"\n)\n{\n    variantSet "hand" = {\n'
        '        "none" {\n        }\n        "gripper" {\n        }\n    }\n',
    )
    loss = codes(read(text))["unread-variant"]
    assert loss.data["names"] == ["hand: none, not gripper"]


SCENE = 'def PhysicsScene "scene"\n{{\n{}}}\n'
MAGNITUDE = "    float physics:gravityMagnitude = {}\n"
DIRECTION = "    vector3f physics:gravityDirection = ({})\n"


@pytest.mark.parametrize(
    ("scene", "units", "gravity"),
    [
        (MAGNITUDE.format(1.62), (1, "Z"), (0, 0, -1.62)),
        (MAGNITUDE.format(162), (0.01, "Y"), (0, 0, -1.62)),
        (MAGNITUDE.format(2) + DIRECTION.format("2, 0, 0"), (1, "Z"), (2, 0, 0)),
        (MAGNITUDE.format(2) + DIRECTION.format("0, 0, 1"), (1, "Y"), (0, -2, 0)),
        (DIRECTION.format("0, 0, 1"), (1, "Z"), (0, 0, 9.81)),
        ("", (1, "Z"), None),
    ],
)
def test_gravity_of_a_scene(read, scene, units, gravity):
    from urdftool.compare.compare import compare_robots

    text = stage(*TWO, turning("j", "a", "b"), unit=units[0], up=units[1])
    robot, plain = read(text + SCENE.format(scene)).robot, read(text).robot
    assert "gravity" not in plain.world
    found = [d.what for d in compare_robots(robot, plain).differences if d.row == "world"]
    assert found == ([] if gravity is None else ["gravity"])
    if gravity is not None:
        assert robot.world["gravity"].content == pytest.approx(gravity)
        assert robot.world["gravity"].place.line > text.count("\n")
