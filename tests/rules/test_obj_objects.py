"""MuJoCo reads the first object of an OBJ file, and rejects one that is flat (run with 4.0)."""

import pytest

from urdftool import check

POINTS = "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1))
FACES = ("f 1 2 4 3", "f 5 7 8 6", "f 1 5 6 2", "f 3 4 8 7", "f 1 3 7 5", "f 2 6 8 4")
ROBOT = """<robot name="r"><link name="a"/><link name="b">
<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
<{0}><geometry><mesh filename="m.obj"/></geometry></{0}></link>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
</robot>"""


def obj(first, second="o b\n"):
    """Write a cube whose first ``first`` faces are an object, and the others a second one."""
    lines = "\n".join(FACES[:first]) + "\n" + second + "\n".join(FACES[first:])
    return f"{POINTS}o a\n{lines}\n"


@pytest.mark.parametrize(
    ("mesh", "shape", "loads"),
    [
        (obj(1), "collision", False),
        (obj(1, "g b\n"), "collision", False),
        (obj(1).replace("f 1 2 4 3", "f -8//1 -7//1 -5//1 -6//1"), "collision", False),
        (obj(1), "visual", True),  # MuJoCo discards visuals
        (obj(5), "collision", True),
        (obj(1, ""), "collision", True),
        (obj(1, "usemtl b\n"), "collision", True),
        ("o a\nf 1 2 3\no b\nf 1 2 3\n", "collision", True),  # another defect
    ],
)
def test_a_flat_first_object_keeps_mujoco_from_loading(write, mesh, shape, loads):
    write("m.obj", mesh)
    found = check(write("r.urdf", ROBOT.format(shape)), select=["placeholder-inertia"])
    readers = [key for finding in found for key in finding.effects]
    assert len(readers) == 1
    assert ("mujoco" in readers[0]) is loads
