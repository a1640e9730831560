"""Export of robots that were read from SDF or MJCF, compared with their source."""

import pytest

import urdftool as api
from tests.conftest import FIXTURES
from tests.formats.defective import joint, link, mjcf, sdf

READERS = FIXTURES / "readers"
FORMATS = FIXTURES / "formats"
ROBOTS = {
    "mechanism of MJCF": READERS / "mechanism.xml",
    "arm of MJCF": FORMATS / "mjcf" / "arm.xml",
    "gripper of SDF": FORMATS / "sdf" / "gripper_arm.gz.sdf",
}
BOX = '<geom type="box" size=".1 .1 .1"/>'

pytestmark = pytest.mark.library("mujoco")


def differing(written):
    return {check.name: check.differing for check in written.checks if check.differing}


@pytest.mark.parametrize("path", ROBOTS.values(), ids=ROBOTS)
@pytest.mark.parametrize("export", [api.export_sdf, api.export_mjcf])
def test_an_export_equals_its_source(path, export, tmp_path):
    written = export(api.load(path), tmp_path / "out", verify=True)
    assert len(written.checks) > 5
    assert differing(written) == {}


def test_every_part_that_is_left_out_is_reported():
    robot = api.load(READERS / "mechanism.xml")
    written = api.export_sdf(robot)
    codes = {loss.code for loss in written.losses}
    assert {"lossy-closure", "lossy-joint-actuator", "lossy-joint-spring"} <= codes
    assert {loss.code for loss in robot.unread} <= codes
    assert all(loss.location.path for loss in written.losses)


@pytest.mark.parametrize(
    ("body", "fixed"),
    [(f'<body name="a">\n{BOX}</body>', True), (f'<body name="a"><freejoint/>{BOX}</body>', False)],
)
def test_the_base_is_as_in_the_source(write, body, fixed, tmp_path):
    robot = api.load(write("m.xml", mjcf(body)))
    text = api.export_sdf(robot, tmp_path / "a.sdf", verify=True).text
    assert ("<parent>world</parent>" in text) is fixed
    text = api.export_mjcf(robot, tmp_path / "a.xml", verify=True).text
    assert ("<freejoint" in text) is not fixed


def test_a_slide_without_limits_stays_so(write):
    robot = api.load(write("m.sdf", sdf(link("a") + link("b") + joint("a", "b", kind="prismatic"))))
    assert "range=" not in api.export_mjcf(robot).text.partition("<worldbody>")[2]
    again = api.load(write("m.xml", api.export_mjcf(robot).text))
    assert "<lower>" not in api.export_sdf(again).text


def test_a_world_without_a_body_is_no_model_of_sdf(write):
    robot = api.load(write("m.xml", mjcf('<body name="a"/><body name="b"/>')))
    with pytest.raises(api.UrdftoolError) as refused:
        api.export_sdf(api.load(write("n.xml", mjcf('<geom type="plane" size="1 1 1"/>'))))
    assert refused.value.path
    assert robot.links


@pytest.mark.parametrize("kind", ["sdf", "mjcf"])
def test_the_command_takes_any_format(urdftool, kind, tmp_path):
    for path in (ROBOTS["arm of MJCF"], ROBOTS["gripper of SDF"]):
        result = urdftool("export", kind, path, "-o", tmp_path / path.stem, "--verify")
        assert result.code == 0, result.err
        assert "differs" not in result.out


def test_strict_counts_what_was_not_read(urdftool, tmp_path):
    path = READERS / "mechanism.xml"
    result = urdftool("export", "sdf", path, "-o", tmp_path / "a.sdf", "--strict")
    assert result.code == 2
    assert result.err.count("[unread-actuator]") == 1
    assert not (tmp_path / "a.sdf").exists()
