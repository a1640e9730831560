"""What the rules of inertia propose, in their messages."""

import pytest

from tests.conftest import FIXTURES
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

ARM = FIXTURES / "robots" / "ros2_arm" / "urdf" / "robot2_base_inertia.urdf.xacro"

LINK = """<robot name="r"><link name="base">
<inertial><origin xyz="{xyz}" rpy="{rpy}"/><mass value="2"/>
<inertia ixx="{0}" ixy="{1}" ixz="{2}" iyy="{3}" iyz="{4}" izz="{5}"/></inertial>
<collision><origin xyz="{xyz}"/><geometry>{shape}</geometry></collision>
</link></robot>
"""
BOX = '<box size="0.1 0.2 0.4"/>'
MESH = '<mesh filename="part.stl"/>'


def messages(path):
    report = check_file(path, Options(Settings(select=("inertia", "pedantic"))))
    assert not report.failed_rules
    return {finding.code: finding.message for finding in report.findings}


def of_link(tmp_path, *six, xyz="0 0 0", rpy="0 0 0", shape=BOX):
    path = tmp_path / "r.urdf"
    path.write_text(LINK.format(*six, xyz=xyz, rpy=rpy, shape=shape))
    return messages(path)


def test_a_moment_copied_to_all_axes():
    assert "106.667, 106.667, 170.667" in messages(ARM)["inertia-exceeds-geometry"]


def test_a_sign(tmp_path):
    found = of_link(tmp_path, 0.0333, 0, 0, -0.0283, 0, 0.00833)
    assert "; iyy = 0.0283 with the other sign" in found["inertia-not-positive-definite"]


def test_square_millimetres(tmp_path):
    found = of_link(tmp_path, 33333, 0, 0, 28333, 0, 8333)
    text = found["inertia-exceeds-geometry"]
    assert "kg·mm² instead of kg·m²" in text
    assert 'write ixx="0.033333" ixy="0" ixz="0" iyy="0.028333" iyz="0" izz="0.008333"' in text


def test_about_the_origin(tmp_path):
    found = of_link(tmp_path, 2.0333, 0, 0, 2.0283, 0, 0.00833, xyz="0 0 1")
    text = found["inertia-about-link-frame"]
    assert 'ixx="0.0333" ' in text
    assert "inertia-exceeds-geometry" not in found


def test_a_center_of_mass_elsewhere_is_not_another_origin(tmp_path):
    path = tmp_path / "r.urdf"
    six = (0.0333, 0, 0, 0.0283, 0, 0.00833)
    text = LINK.format(*six, xyz="0 0 0.15", rpy="0 0 0", shape=BOX)
    path.write_text(text.replace('<collision><origin xyz="0 0 0.15"/>', "<collision>"))
    assert "inertia-about-link-frame" not in messages(path)


def test_an_inertial_on_its_side(tmp_path):
    found = of_link(tmp_path, 0.00833, 0, 0, 0.0283, 0, 3.33, rpy="0 1.5707963 0")
    assert found["inertia-off-by-power-of-ten"].endswith("write 0.0333")


@pytest.mark.parametrize("shape", [BOX, MESH])
def test_the_order_needs_no_shape(tmp_path, shape):
    found = of_link(tmp_path, 0.0333, 0.0283, 0.00833, 0, 0, 0, shape=shape)
    assert 'iyy="0.0283" iyz="0" izz="0.00833"' in found["inertia-component-typo"]


def test_what_nothing_explains_is_told_with_the_solid(tmp_path):
    found = of_link(tmp_path, 1, 0, 0, 2, 0, 40)
    assert "a solid box of 2 kg has ixx 0.03333" in found["inertia-triangle-inequality"]


@pytest.mark.parametrize("size", ["1e-12", "-1e-13"])
def test_noise_is_no_inertia(tmp_path, size):
    found = of_link(tmp_path, size, 0, 0, "1e-13", 0, "1e-14")
    assert "almost zero" in found["zero-inertia"]
    assert not found.keys() & {"inertia-triangle-inequality", "inertia-not-positive-definite"}


@pytest.mark.parametrize("size", ["1e-110", "1e110", "1e300"])
def test_numbers_of_no_robot(tmp_path, size):
    of_link(tmp_path, size, size, 0, size, 0, "-" + size)


def test_what_computing_the_moments_leaves_over_is_shown_as_zero(tmp_path):
    found = of_link(tmp_path, 0.034, -0.003, -0.005, 0.026, -0.015, 0.01)  # a thin rod
    assert "is zero about one axis (0, 0.035, 0.035)" in found["singular-inertia"]


def test_a_dummy_is_not_told_to_take_an_inertia_of_next_to_nothing(tmp_path):
    shape = '<sphere radius="0.001"/>'
    assert "placeholder-inertia" not in of_link(tmp_path, 0.1, 0, 0, 0.1, 0, 0.1, shape=shape)
    text = of_link(tmp_path, 1, 0, 0, 1, 0, 1, shape=shape)["placeholder-inertia"]
    assert "a solid sphere" not in text
    shape = '<sphere radius="0.01"/>'
    text = of_link(tmp_path, 0.1, 0, 0, 0.1, 0, 0.1, shape=shape)["placeholder-inertia"]
    assert "a solid sphere of 2 kg has ixx 8e-05" in text


def test_no_command_is_named_that_refuses_the_file(tmp_path):
    def hints(head):
        path = tmp_path / "r.urdf"
        path.write_text(head + LINK.format(1, 0, 0, 1, 0, 1, xyz="0 0 0", rpy="0 0 0", shape=BOX))
        report = check_file(path, Options(Settings(select=("placeholder-inertia",))))
        return [f.hint for f in report.findings if f.code == "placeholder-inertia"]

    (hint,) = hints('<?xml version="1.0"?>\n')
    assert "urdftool inertia robot" in hint
    assert hints('<?xml verison="1.0"?>\n') == [""], "'inertia robot' refuses a wrong declaration"
