"""What readers do with a robot as a whole, for defects that MuJoCo alone rejects or takes."""

import struct

import pytest

from tests.lint.test_imported_readers import ROBOT
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

BOTH = Options(settings=Settings(targets=frozenset(("mujoco", "pybullet"))))


def _list_rejecting(tmp_path, text):
    path = tmp_path / "cart.urdf"
    path.write_text(text)
    report = check_file(path, BOTH)
    return {"mujoco", "pybullet"} & set(report.rejected), {
        finding.code for finding in report.findings
    }


@pytest.mark.parametrize(("kind", "rejecting"), [("revolute", {"mujoco"}), ("fixed", set())])
def test_mujoco_takes_a_moved_link_named_world_for_its_world(tmp_path, kind, rejecting):
    text = ROBOT.replace('"finger"', '"world"').replace('"revolute"', f'"{kind}"')
    found, codes = _list_rejecting(tmp_path, text)
    assert found == rejecting
    assert ("reserved-name" in codes) is bool(rejecting)


@pytest.mark.parametrize(
    ("number", "rejecting"),
    [("0x10", set()), ("1E", {"mujoco"}), ("1.", set()), ("1_0", {"mujoco"})],
)
def test_mujoco_and_pybullet_read_hexadecimal_numbers(tmp_path, number, rejecting):
    found, codes = _list_rejecting(tmp_path, ROBOT.replace('"0.04"', f'"{number}"'))
    assert found == rejecting
    assert ("not-a-number" in codes) is (number != "1.")


@pytest.mark.parametrize(
    ("height", "rejecting"), [(0.0, {"mujoco"}), (1e-6, set())], ids=["flat", "thin"]
)
def test_mujoco_computes_a_hull_of_a_collision_mesh(tmp_path, height, rejecting):
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, height)]
    faces = [(0, 1, 2), (1, 3, 2), (0, 3, 1), (0, 2, 3)]
    data = bytearray(b" " * 80 + struct.pack("<I", len(faces)))
    for face in faces:
        numbers = [x for corner in face for x in corners[corner]]
        data += struct.pack("<12f", 0, 0, 0, *numbers) + b"\0\0"
    (tmp_path / "sheet.stl").write_bytes(data)
    text = ROBOT.replace('<box size="0.1 0.1 0.1"/>', '<mesh filename="sheet.stl"/>')
    found, codes = _list_rejecting(tmp_path, text)
    assert found == rejecting
    assert ("flat-collision-mesh" in codes) is bool(rejecting)
    visual = text.replace("collision>", "visual>")
    assert not _list_rejecting(tmp_path, visual)[0]
