"""A mesh of a shape that urdfdom drops is looked for by no reader that reads with urdfdom."""

import pytest

from urdftool import check

MASS = '<mass value="1"/>'
INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'


def shape(tag, inside='<mesh filename="{}"/>'):
    return f"<{tag}><geometry>{inside}</geometry></{tag}>"


@pytest.mark.parametrize(
    ("inertial", "others", "mesh_in", "shown"),
    [
        (MASS + INERTIA, "", "visual", True),
        (MASS, "", "visual", False),
        (INERTIA, "", "visual", False),
        (MASS + INERTIA.replace('ixy="0"', ""), "", "visual", False),
        (MASS.replace("1", "1 kg") + INERTIA, "", "visual", False),
        (MASS + INERTIA, shape("visual", '<capsule radius="1" length="1"/>'), "visual", False),
        (MASS + INERTIA, shape("visual", '<box size="1 1"/>'), "visual", False),
        (MASS + INERTIA, shape("collision", '<box size="1 1"/>'), "visual", True),
        (MASS + INERTIA, shape("collision", '<box size="1 1"/>'), "collision", False),
    ],
)
@pytest.mark.parametrize(
    ("rule", "uri"),
    [("package-not-found", "package://gone_away/a.stl"), ("mesh-not-found", "gone/a.stl")],
)
def test_rviz_looks_for_the_mesh(write, rule, uri, inertial, others, mesh_in, shown):
    inside = f"<inertial>{inertial}</inertial>{others}{shape(mesh_in).format(uri)}"
    path = write("r.urdf", f'<robot name="r"><link name="a">{inside}</link></robot>')
    (finding,) = check(path, select=[rule])
    assert ("rviz" in finding.effects) == shown
    assert any("drake" in key for key in finding.effects)
