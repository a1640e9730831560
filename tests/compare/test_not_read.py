"""``verify`` says of what it did not read that it did not compare it."""

from pathlib import Path

import pytest

import urdftool
from urdftool.report import verification as report

LINK = '<link name="{}"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" \
iyz="0" izz="1"/></inertial>{}</link>'
MESH = '<visual><geometry><mesh filename="{0}"/></geometry></visual>\
<collision><geometry><mesh filename="{0}"/></geometry></collision>'
FACE = "v 0 0 0\nv {} 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n"
COLOR = "mtllib m.mtl\nusemtl m\n"

mujoco = pytest.mark.library("mujoco")


def write(folder: Path, mesh: str, files: dict[str, str]) -> Path:
    folder.mkdir(exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text)
    path = folder / "r.urdf"
    path.write_text(f'<robot name="r">{LINK.format("a", MESH.format(mesh))}</robot>')
    return path


def get_verdicts(agreement) -> dict[str, str]:
    return {check.name: check.verdict for check in agreement.pairs[0, 1].make_checks()}


MISSING = "does not exist"
TRUNCATED = "truncated"


@pytest.mark.parametrize(
    ("mesh", "files", "reason"),
    [
        ("gone.stl", {}, MISSING),
        ("cut.stl", {"cut.stl": "solid x\nfacet"}, TRUNCATED),
        ("package://nowhere/a.stl", {}, "package 'nowhere'"),
    ],
)
def test_a_mesh_that_was_not_read_is_not_equal(tmp_path, mesh, files, reason):
    paths = [write(tmp_path / name, mesh, files) for name in "AB"]
    agreement = urdftool.verify(*paths)
    comparison = agreement.pairs[0, 1]
    verdicts = get_verdicts(agreement)
    assert (verdicts["visuals"], verdicts["collisions"]) == ("not compared", "not compared")
    assert not agreement.is_equal
    assert not comparison.is_different
    assert " not read: " in comparison.list_skipped()["visuals"]
    assert reason in comparison.list_skipped()["visuals"]
    summary = report.summarize(["A", "B"], agreement, [0, 0])
    assert "no difference was found, but meshes were not read" in summary


def test_one_missing_file_of_both_robots_is_not_compared(tmp_path):
    path = write(tmp_path / "A", "gone.stl", {})
    agreement = urdftool.verify(path, path)
    reason = agreement.pairs[0, 1].list_skipped()["visuals"]
    assert reason.startswith("1 mesh not read: ")
    assert not agreement.is_equal


def test_one_file_of_both_robots_is_equal_though_it_cannot_be_read(tmp_path):
    path = write(tmp_path / "A", "bad.stl", {"bad.stl": "no mesh"})
    assert urdftool.verify(path, path).is_equal


def test_a_mesh_that_only_one_side_has_is_named(tmp_path):
    one = write(tmp_path / "A", "m.obj", {"m.obj": FACE.format(1)})
    agreement = urdftool.verify(one, write(tmp_path / "B", "m.obj", {}))
    reason = agreement.pairs[0, 1].list_skipped()["visuals"]
    assert reason.startswith("1 mesh not read: ")
    assert reason.endswith(f"m.obj, {MISSING}")


@pytest.mark.parametrize(
    ("colors", "verdict"), [(("1 0 0", "1 0 0"), "equal"), (("1 0 0", "0 0 1"), "not compared")]
)
def test_colors_of_mesh_files_are_equal_only_if_the_files_are(tmp_path, colors, verdict):
    paths = [
        write(tmp_path / name, "m.obj", {"m.obj": COLOR + FACE.format(1), "m.mtl": f"Kd {rgb}\n"})
        for name, rgb in zip("AB", colors, strict=True)
    ]
    assert get_verdicts(urdftool.verify(*paths))["colors"] == verdict


CHECKER = """<mujoco><asset><texture name="t" type="2d" builtin="checker" rgb1="{} 0 0"
 width="8" height="8"/><material name="m" texture="t"/></asset><worldbody><body name="a">
<geom type="box" size="1 1 1" material="m"/></body></worldbody></mujoco>"""


@mujoco
def test_an_image_that_mujoco_makes_is_not_compared(tmp_path):
    paths = [tmp_path / f"{red}.xml" for red in (0, 1)]
    for red, path in enumerate(paths):
        path.write_text(CHECKER.format(red))
    agreement = urdftool.verify(*paths)
    assert get_verdicts(agreement)["textures"] == "not compared"


JOINT = '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 {}"/>\
<limit lower="-2" upper="2" effort="1" velocity="1"/>{}</joint>'
SAFE = '<safety_controller soft_lower_limit="{}" soft_upper_limit="{}" k_position="{}" \
k_velocity="9"/><calibration {}="{}"/>'


def write_joint(path: Path, axis: int, inside: str) -> Path:
    links = LINK.format("a", "") + LINK.format("b", "")
    path.write_text(f'<robot name="r">{links}{JOINT.format(axis, inside)}</robot>')
    return path


@pytest.mark.parametrize(
    ("axis", "values", "whats"),
    [
        (1, (-1, 1.5, 10, "rising", 0.2), set()),
        (1, (-1, 0.1, 10, "rising", 0.2), {"soft upper limit"}),
        (1, (-1, 1.5, 90, "rising", 0.2), {"k position"}),
        (1, (-1, 1.5, 10, "rising", 1.2), {"rising"}),
        (-1, (-1.5, 1, 10, "falling", -0.2), {"axis", "lower limit", "upper limit"}),
    ],
)
def test_soft_limits_and_calibration_are_compared(tmp_path, axis, values, whats):
    one = write_joint(tmp_path / "a.urdf", 1, SAFE.format(-1, 1.5, 10, "rising", 0.2))
    two = write_joint(tmp_path / "b.urdf", axis, SAFE.format(*values))
    found = {entry.what for entry in urdftool.verify(one, two).list_disagreements()}
    assert found == (whats - {"lower limit", "upper limit"})


def test_soft_limits_that_sdf_lacks_are_named(tmp_path):
    one = write_joint(tmp_path / "a.urdf", 1, SAFE.format(-1, 1.5, 10, "rising", 0.2))
    urdftool.export_sdf(urdftool.load(one), tmp_path / "o")
    pair = urdftool.verify(one, tmp_path / "o" / "model.sdf").pairs[0, 1]
    missing = {text.partition(":")[0] for text in pair.not_comparable}
    assert {"<safety_controller>", "<calibration>"} <= missing


BASE = '<sdf version="1.9"><model name="m">{}<link name="a"/></model></sdf>'
WELD = '<joint name="w" type="fixed"><parent>world</parent><child>a</child></joint>'


def test_a_value_that_was_not_compared_is_not_printed(tmp_path):
    plain = tmp_path / "a.urdf"
    plain.write_text(f'<robot name="m">{LINK.format("a", "")}</robot>')
    paths = [plain]
    for name, inside in (("b.sdf", ""), ("c.sdf", WELD)):
        paths.append(tmp_path / name)
        mass = "<inertial><mass>1</mass></inertial>"
        text = BASE.format(inside).replace('<link name="a"/>', f'<link name="a">{mass}</link>')
        paths[-1].write_text(text)
    agreement = urdftool.verify(*paths)
    base = next(one for one in agreement.list_disagreements() if one.what == "base")
    assert (base.values, base.compared, base.alone) == ([None, "free", "fixed"], {1, 2}, None)
    assert "  A  not compared\n" in report.format_text(["a", "b", "c"], agreement)


BLOCK = '<gazebo reference="a"><material>Gazebo/Red</material></gazebo>'


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_a_part_has_no_place_in_the_file_that_lacks_it(tmp_path, order):
    paths = [tmp_path / "with.urdf", tmp_path / "without.urdf"]
    for path, block in zip(paths, (BLOCK, ""), strict=True):
        path.write_text(f'<robot name="m">{LINK.format("a", "")}{block}</robot>')
    given = [paths[number] for number in order]
    entry = urdftool.verify(*given).list_disagreements()[0]
    assert entry.places[order.index(1)] is None
    assert entry.places[order.index(0)].path == str(paths[0])


FLOATING = '<joint name="j" type="floating"><parent link="a"/><child link="b"/>\
<origin xyz="0 0 0.5"/></joint>'


@pytest.mark.parametrize(("height", "rows"), [(0.5, set()), (0.51, {"frames"})])
def test_a_floating_joint_is_a_free_link_of_sdf(tmp_path, height, rows):
    links = LINK.format("a", "") + LINK.format("b", "")
    path = tmp_path / "a.urdf"
    path.write_text(f'<robot name="m">{links}{FLOATING}</robot>')
    inertial = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia>\
</inertial>"
    other = tmp_path / "b.sdf"
    other.write_text(
        f'<sdf version="1.9"><model name="m"><link name="a">{inertial}</link><link name="b">'
        f'<pose relative_to="a">0 0 {height} 0 0 0</pose>{inertial}</link></model></sdf>'
    )
    for pair in ((path, other), (other, path)):
        found = urdftool.verify(*pair).list_disagreements()
        assert {entry.row for entry in found} == rows


TWICE = """<mujoco><worldbody><body name="a"><geom name="b" type="box" size="1 1 1"/>
<geom type="box" size="1 1 1" contype="0" conaffinity="0" group="2" rgba="0.2 0.3 0.4 1"/>
</body></worldbody></mujoco>"""


@mujoco
def test_visuals_at_one_place_are_matched_by_color(tmp_path):
    path = tmp_path / "m.xml"
    path.write_text(TWICE)
    urdftool.export_sdf(urdftool.load(path), tmp_path / "o")
    model = tmp_path / "o" / "model.sdf"
    assert get_verdicts(urdftool.verify(path, model))["colors"] == "equal"
    model.write_text(model.read_text().replace("0.5 0.5 0.5", "0.5 0.5 0.9"))
    assert get_verdicts(urdftool.verify(path, model))["colors"] == "differs"


SITE = """<mujoco><worldbody><site name="ws" euler="0 0 {}"/><geom name="w" size="1 1 1" type="box"
 pos="0 0 -{}"/><body name="b"><freejoint/><geom name="g" size=".1"/><site name="bs"/></body>
</worldbody><contact><pair geom1="g" geom2="w"/></contact><actuator>
<general name="a" site="bs" refsite="ws" gear="1 0 0 0 0 0"/></actuator></mujoco>"""


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("values", [("0", "2"), ("90", "2"), ("0", "3")])
def test_sites_and_geoms_of_the_world_that_others_name(write, urdftool, values):
    write("one.xml", SITE.format("0", "2"))
    write("two.xml", SITE.format(*values))
    result = urdftool("verify", "one.xml", "two.xml")
    is_equal = values == ("0", "2")
    assert ("equal in every compared property" in result.err) is is_equal
    assert ("contact pairs (1 part not read: w" in result.out) is not is_equal
    assert ("sensors (1 part not read: ws" in result.out) is not is_equal
