"""The severity of ``non-positive-dimension`` goes by what MuJoCo does, which is asked here."""

import pytest

from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

ROBOT = """<?xml version="1.0"?>
<robot name="r">{mujoco}
  <link name="a">
    <collision><geometry><box size="1 1 1"/></geometry></collision>
    <{kind}><geometry>{shape}</geometry></{kind}>
  </link>
</robot>
"""
KEPT = '<mujoco><compiler discardvisual="false"/></mujoco>'
SHAPES = ['<box size="0 0 0"/>', '<sphere radius="0"/>', '<cylinder radius="0.1" length="-0.1"/>']


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("kind", ["visual", "collision"])
@pytest.mark.parametrize("mujoco", ["", KEPT])
def test_what_mujoco_rejects_is_an_error(tmp_path, shape, kind, mujoco):
    library = pytest.importorskip("mujoco")
    text = ROBOT.format(mujoco=mujoco, kind=kind, shape=shape)
    try:
        library.MjModel.from_xml_string(text)
    except ValueError:
        expected = "error"
    else:
        expected = "warning"
    path = tmp_path / "r.urdf"
    path.write_text(text)
    settings = Settings(select=("non-positive-dimension",))
    (found,) = check_file(path, Options(settings)).findings
    assert found.severity.label == expected
    assert f"in a {kind} of link 'a'" in found.message
