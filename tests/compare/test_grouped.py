"""What a report of ``verify`` prints of equal differences, and what a row compares."""

import urdftool as api
from urdftool.compare.compare import compare_robots
from urdftool.compare.several import compare_all
from urdftool.report.verification import format_text

LINK = """<link name="l{0}"><inertial><mass value="{1}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1"
iyz="0" izz="1"/></inertial></link>"""
JOINT = """<joint name="j{0}" type="continuous"><parent link="l0"/><child link="l{0}"/>
<axis xyz="0 0 1"/><dynamics damping="{1}"/></joint>"""


def _make(tmp_path, name, damping, mass=1.0):
    links = "".join(LINK.format(n, mass if n == 3 else 1) for n in range(7))
    joints = "".join(JOINT.format(n, damping if n else 0) for n in range(1, 7))
    path = tmp_path / name
    path.write_text(f'<robot name="r">{links}{joints}</robot>')
    return api.load(path)


def test_equal_differences_are_one_entry(tmp_path):
    robots = _make(tmp_path, "a.urdf", 0.5), _make(tmp_path, "b.urdf", 0.25, 2.0)
    text = format_text(["a.urdf", "b.urdf"], compare_all(robots))
    assert text.count("damping [") == 1
    assert "6 joints 'j1', 'j2', 'j3' and 3 more: damping [N·m·s/rad]" in text
    assert "link 'l3': mass [kg]" in text  # a single one stays


def test_a_tensor_is_equal_where_only_the_mass_differs(tmp_path):
    robots = _make(tmp_path, "a.urdf", 0.5), _make(tmp_path, "b.urdf", 0.5, 1.01)
    rows = {difference.row for difference in compare_robots(*robots).differences}
    assert "mass" in rows
    assert "inertia" not in rows
