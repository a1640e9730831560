"""Lint of stages: findings at the lines of their layers, or at prims of binary stages."""

import json

import pytest

pytestmark = pytest.mark.library("pxr")

HEAD = '#usda 1.0\n(\n    defaultPrim = "r"\n    metersPerUnit = 1\n    upAxis = "Z"\n{})\n'
BODY = """def Xform "r"
{
    def Xform "base" (
        prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
    )
    {
        float physics:mass = 2
        point3f physics:centerOfMass = (0, 0, 0)
        float3 physics:diagonalInertia = (1, 1, 9)

        def Xform "arm" (
            prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
        )
        {
            float physics:mass = 1
            float3 physics:diagonalInertia = (1, 1, 1.5)
        }
    }

    def PhysicsRevoluteJoint "elbow"
    {
        rel physics:body0 = </r/base>
        rel physics:body1 = </r/base/arm>
        float physics:lowerLimit = 90
        float physics:upperLimit = -90
    }
}
"""


@pytest.fixture
def found(urdftool):
    """Check a stage; gives its findings by rule, and the result."""

    def check(path, *options):
        result = urdftool("lint", path, "--no-cache", "--format", "json", *options)
        return {f["rule"]: f for f in json.loads(result.out)["findings"]}, result

    return check


def line_of(text, part):
    return text[: text.index(part)].count("\n") + 1


def test_findings_have_the_lines_of_attributes(write, found):
    text = HEAD.format("") + BODY
    path = write("r.usda", text)
    findings, result = found(path)
    assert result.code == 1
    for code, part in (
        ("inertia-triangle-inequality", "float3 physics:diagonalInertia = (1, 1, 9)"),
        ("lower-above-upper", "float physics:lowerLimit"),
    ):
        finding = findings[code]
        assert (finding["path"], finding["line"]) == (path, line_of(text, part)), code
        assert (finding["effects"], finding["fix"]) == ({}, None)
    assert result.err.count("[unread-center-of-mass]") == 1
    arm = line_of(text, 'def Xform "arm"')
    assert f"{path}:{arm}:9: warning:" in result.err


def test_inertia_that_newton_raises(write, found):
    text = HEAD.format("") + BODY.replace("(1, 1, 1.5)", "(1e-12, 1e-12, 1e-12)")
    findings, _ = found(write("r.usda", text), "--select", "newton-raised-inertia")
    finding = findings["newton-raised-inertia"]
    assert finding["line"] == line_of(text, "float3 physics:diagonalInertia = (1e-12")
    assert finding["element"]["name"] == "arm"


def test_findings_are_in_the_layer_that_has_the_opinion(write, found):
    write("base.usda", "#usda 1.0\n" + BODY)
    path = write("r.usda", HEAD.format("    subLayers = [@./base.usda@]\n") + (
        'over "r"\n{\n    over "base"\n    {\n'
        "        float3 physics:diagonalInertia = (1, 9, 1)\n    }\n}\n"
    ))  # fmt: skip
    findings, _ = found(path)
    tensor, limit = findings["inertia-triangle-inequality"], findings["lower-above-upper"]
    assert (tensor["path"].endswith("r.usda"), tensor["line"]) == (True, 12)
    assert limit["path"].endswith("base.usda")


def test_findings_of_a_binary_stage_name_the_prim(write, tmp_path, urdftool):
    from pxr import Sdf

    layer = Sdf.Layer.FindOrOpen(str(write("r.usda", HEAD.format("") + BODY)))
    path = tmp_path / "r.usdc"
    layer.Export(str(path))
    result = urdftool("lint", str(path), "--no-cache")
    assert result.code == 1
    assert f"{path}</r/base>: error: inertia of link 'base'" in result.out


def test_a_stage_that_is_not_opened_is_an_error(write, urdftool):
    path = write("r.usda", "#usda 1.0\ndef Xform {")
    result = urdftool("lint", path, "--no-cache")
    assert result.code == 2
    assert result.out.count("[unreadable-model]") == 1


def test_a_layer_that_is_repaired_is_read_again(urdftool, write):
    stage = write("r.usda", HEAD.format("    subLayers = [@./b.usda@]\n"))
    write("b.usda", HEAD.format("") + BODY[:-2])
    assert "1 file not checked" in urdftool("lint", stage).err
    write("b.usda", HEAD.format("") + BODY)
    assert "not checked" not in urdftool("lint", stage).err


MIMIC = """
    def PhysicsRevoluteJoint "wrist" (
        prepend apiSchemas = ["NewtonMimicAPI", "PhysxMimicJointAPI:rotX"]
    )
    {{
        rel physics:body0 = </r/base>
        rel physics:body1 = </r/base/hand>
        float physics:lowerLimit = -90
        float physics:upperLimit = 90
        rel newton:mimicJoint = </r/elbow>
        float newton:mimicCoef1 = 2
        rel physxMimicJoint:rotX:referenceJoint = </r/{}>
        float physxMimicJoint:rotX:gearing = {}
    }}
}}
"""
HAND = """
        def Xform "hand" (
            prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
        )
        {
            float physics:mass = 1
            float3 physics:diagonalInertia = (1, 1, 1.5)
        }
    }

    def Ph"""


@pytest.mark.parametrize(
    ("leader", "gearing", "part"),
    [
        ("elbow", -2, ""),
        ("elbow", 2, "float physxMimicJoint:rotX:gearing"),
        ("other", -2, "rel physxMimicJoint:rotX:referenceJoint"),
    ],
)
def test_mimic_joints_of_two_simulators_that_differ_are_one_finding(
    write, found, leader, gearing, part
):
    text = BODY.replace("    }\n\n    def Ph", HAND, 1).rstrip("}\n") + "\n    }\n"
    text = HEAD.format("") + text + MIMIC.format(leader, gearing)
    path = write("r.usda", text)
    findings, result = found(path, "--select", "contradicting-simulators")
    finding = findings.get("contradicting-simulators")
    assert (finding is not None) == bool(part)
    if finding is not None:
        assert finding["line"] == line_of(text, part)
        assert finding["element"]["name"] == "wrist"
    assert "[unread-contradiction]" not in result.err
