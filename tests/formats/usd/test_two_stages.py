"""Two stages: what a simulator reads of them and no row of values holds is compared as written."""

import pytest

from tests.formats.usd.stages import body, stage, turning
from urdftool.compare.compare import compare_robots
from urdftool.compare.rows import NATIVE

pytestmark = pytest.mark.library("pxr")

DRIVE = (
    "        float drive:angular:physics:stiffness = 2\n"
    "        float drive:angular:physics:maxForce = 5\n"
    "        float newton:velocityLimit = 180\n"
    "        float physxJointAxis:angular:maxJointVelocity = 180\n"
)
SHAPE = """
        def Mesh "m" (prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"])
        {
            int[] faceVertexCounts = [3, 3, 3, 3]
            int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]
            point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
            uniform token physics:approximation = "convexHull"
        }
"""
NEWTON = "        double[] newton:inertia = [1, 2, 2.5, 0, 0, 0]\n"
SELF = (
    "    bool newton:selfCollisionEnabled = 1\n"
    "    bool physxArticulation:enabledSelfCollisions = 1\n"
)
WHOLE = (
    stage(SELF, body("a"), body("b", more=NEWTON + SHAPE), turning("j", "a", "b", DRIVE))
    .replace(
        '"b" (\n        prepend apiSchemas = [',
        '"b" (\n        prepend apiSchemas = ["NewtonMassAPI", ',
    )
    .replace('Xform "r"', 'Xform "r" (prepend apiSchemas = ["PhysicsArticulationRootAPI"])')
)

EDITS = {
    "inertia for PhysX": ("(1, 2, 2.5)\n", "(1, 2, 2)\n", "physics:diagonalInertia"),
    "inertia for PhysX removed": ("        float3 physics:diagonalInertia = (1, 2, 2.5)\n", "",
                                  "physics:diagonalInertia"),
    "self-collision for one": ("enabledSelfCollisions = 1", "enabledSelfCollisions = 0",
                               "physxArticulation:enabledSelfCollisions"),
    "approximation": ("convexHull", "boundingCube", "physics:approximation"),
    "no drive": (' (prepend apiSchemas = ["PhysicsDriveAPI:angular"])', "",
                 "PhysicsDriveAPI:angular"),
    "no articulation": (' (prepend apiSchemas = ["PhysicsArticulationRootAPI"])', "",
                        "PhysicsArticulationRootAPI"),
    "target": (DRIVE, DRIVE + "        float drive:angular:physics:targetPosition = 45\n",
               "drive:angular:physics:targetPosition"),
    "drive of accelerations": (
        DRIVE, DRIVE + '        uniform token drive:angular:physics:type = "acceleration"\n',
        "drive:angular:physics:type"),
    "links of a joint collide": (DRIVE, DRIVE + "        bool physics:collisionEnabled = 1\n",
                                 "physics:collisionEnabled"),
    "one of two limits": ("maxJointVelocity = 180", "maxJointVelocity = 90",
                          "physxJointAxis:angular:maxJointVelocity"),
    "start velocity": (NEWTON, NEWTON + "        vector3f physics:velocity = (5, 0, 0)\n",
                       "physics:velocity"),
    "up axis": ('upAxis = "Z"', 'upAxis = "Y"', "upAxis"),
    "body off its joint": ("xformOp:translate = (0, 0, 0)", "xformOp:translate = (3, 0, 0)",
                           "child moved in the frame of the joint"),
}  # fmt: skip


@pytest.fixture
def differ(read):
    """Return the attributes in which a stage differs from the whole one, of no row of values."""

    def compare(text):
        found = compare_robots(read(WHOLE).robot, read(text).robot)
        return [d.what for d in found.differences if d.row == NATIVE]

    return compare


@pytest.mark.parametrize("name", EDITS)
def test_an_edit_is_named(differ, name):
    old, new, what = EDITS[name]
    assert WHOLE.count(old) >= 1
    assert what in differ(new.join(WHOLE.rsplit(old, 1)))


def test_other_units_are_one_difference(differ):
    text = WHOLE.replace("metersPerUnit = 1", "metersPerUnit = 0.01\n    kilogramsPerUnit = 0.001")
    assert differ(text).count("units") == 1
    assert not any("PerUnit" in what for what in differ(text))


def test_equal_stages_and_values_of_rows_are_no_difference(differ):
    assert differ(WHOLE) == []
    assert differ(WHOLE.replace("stiffness = 2", "stiffness = 3").replace("= 180", "= 90")) == []
