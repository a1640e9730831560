"""What a finding advises fits its case, and so does its fix."""

import pytest

from urdftool import check

MOVING = """<robot name="r">
  <link name="{root}">{inertial}</link>
  <link name="arm"><inertial><mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <joint name="turn" type="{kind}"><parent link="{root}"/><child link="arm"/><axis xyz="0 0 1"/>
    </joint>
</robot>
"""
INERTIAL = """<inertial><mass value="{mass}"/>
    <inertia ixx="{i}" ixy="0" ixz="0" iyy="{i}" iyz="0" izz="{i}"/></inertial>"""


def one(path, rule, *targets):
    """Give the only finding of a rule."""
    (found,) = check(path, select=[rule], targets=targets)
    return found


@pytest.mark.parametrize(
    ("root", "mass", "kind", "targets", "remedy", "in_pybullet"),
    [
        ("base", 5, "continuous", (), "put a link without one above it, on a fixed joint", True),
        ("base", 5, "continuous", ("ros2", "pybullet"), "", False),
        ("base", 1e-4, "fixed", (), "remove its <inertial>", True),
        ("base", 1e-4, "continuous", (), "put a link without one above it, on a fixed joint", True),
        ("world", 5, "continuous", ("ros2", "pybullet"), "remove its <inertial>", False),
    ],
    ids=["body", "pybullet", "frame of a body", "frame", "world"],
)
def test_a_root_without_inertial_has_1_kg_in_pybullet(
    write, root, mass, kind, targets, remedy, in_pybullet
):
    inertial = INERTIAL.format(mass=mass, i=mass / 100)
    path = write("r.urdf", MOVING.format(root=root, inertial=inertial, kind=kind))
    found = one(path, "root-link-has-inertia", *targets)
    assert found.message.partition("not support")[2] == (remedy and f"; {remedy}")
    assert ("PyBullet gives a root without an <inertial> 1 kg" in found.hint) is in_pybullet


def test_it_is_so_in_pybullet(write):
    pybullet = pytest.importorskip("pybullet")
    client = pybullet.connect(pybullet.DIRECT)
    try:
        masses = []
        for root in ("base", "world"):
            text = MOVING.format(root=root, inertial="", kind="continuous")
            body = pybullet.loadURDF(str(write(f"{root}.urdf", text)))
            masses.append(pybullet.getDynamicsInfo(body, -1)[0])
        assert masses == [1, 0]
    finally:
        pybullet.disconnect(client)
