"""Files that an included MJCF file names: beside the main file, then beside the included one."""

import numpy as np
import pytest
import trimesh

from urdftool import load

mujoco = pytest.importorskip("mujoco")

MAIN = """<mujoco><asset><include file="parts/assets.xml"/></asset><worldbody>
<body name="b"><geom type="mesh" mesh="a"/></body></worldbody></mujoco>"""
ASSETS = '<mujocoinclude><mesh name="a" file="a.stl"/></mujocoinclude>'


@pytest.mark.parametrize(
    ("folders", "size"), [(("", "parts"), 1.0), (("",), 1.0), (("parts",), 2.0)]
)
def test_a_mesh_beside_the_included_file(tmp_path, folders, size):
    (tmp_path / "parts").mkdir()
    for folder in folders:
        edge = 2.0 if folder else 1.0
        trimesh.creation.box((edge, edge, edge)).export(tmp_path / folder / "a.stl")
    (tmp_path / "parts" / "assets.xml").write_text(ASSETS)
    path = tmp_path / "main.xml"
    path.write_text(MAIN)
    compiled = mujoco.MjModel.from_xml_path(str(path))
    assert np.ptp(compiled.mesh_vert, axis=0)[0] == pytest.approx(size)
    robot = load(path)
    (visual,) = robot.link["b"].visuals
    named = robot.source.resolve(visual.geometry.filename)
    assert trimesh.load(named).extents[0] == pytest.approx(size)
