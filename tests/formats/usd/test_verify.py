"""The comparison of a stage with its source, and that it finds a changed stage."""

import re
from pathlib import Path

import pytest

from tests.cases import list_cases
from tests.formats.usd.stages import BOX, export, joint, link, robot
from urdftool.compare.check import is_faithful

pytestmark = pytest.mark.library("pxr")

ARM = robot(
    link("base", 2, BOX, origin='<origin xyz="0.1 0 0" rpy="0.1 0.2 0.3"/>'),
    joint("f", "base", "mount", more='<origin xyz="0 0 0.1" rpy="0 0 0.5"/>'),
    link("mount", None, BOX),
    joint("j", "mount", "arm", "revolute",
          '<origin xyz="0 0 0.3" rpy="0 0.5 0"/><axis xyz="0 1 1"/>'
          '<limit lower="-1" upper="2" effort="33.5" velocity="3"/>'
          '<dynamics damping="0.5" friction="0.2"/>'),
    link("arm", 1, BOX),
    joint("s", "arm", "slide", "prismatic",
          '<axis xyz="0 0 -1"/><limit lower="0" upper="0.1" effort="5" velocity="1"/>'),
    link("slide", 0.5),
    joint("m", "arm", "other", "revolute",
          '<limit lower="-2" upper="2" effort="1" velocity="1"/>'
          '<mimic joint="j" multiplier="-1.5" offset="0.2"/>'),
    link("other", 0.25),
    '<gazebo reference="arm"><mu1>0.3</mu1><mu2>0.3</mu2></gazebo>',
)  # fmt: skip


def checks_of(path, written, newton=None, **options):
    import urdftool
    from urdftool.formats.usd.verify import verify_copy

    return verify_copy(urdftool.load(path), written, newton=newton)


@pytest.mark.parametrize("name", ["r.usda", "r.usdc", "r.usdz"])
def test_an_export_is_equal_to_its_source(write, name):
    path = write("arm.urdf", ARM)
    written = export(path, file=name)
    checks = our_rows(path, written)
    assert {check.name: check.differing for check in checks if check.differing} == {}
    equal = {check.name for check in checks if check.verdict == "equal"}
    assert equal >= {"tree", "frames", "limits", "joint physics", "surface", "mass", "collisions"}


CHANGES = {
    "physics:mass = 2": ("physics:mass = 2.1", "mass"),
    "physics:centerOfMass = (0.1, 0, 0)": ("physics:centerOfMass = (0.2, 0, 0)", "center of mass"),
    "maxForce = 33.5": ("maxForce = 34", "limits"),
    "physics:upperLimit = 114.59156": ("physics:upperLimit = 110", "limits"),
    "newton:velocityLimit = 171.88734": ("newton:velocityLimit = 170", "limits"),
    "newton:friction = 0.2": ("newton:friction = 0.3", "joint physics"),
    "newton:mimicCoef1 = -1.5": ("newton:mimicCoef1 = 1.5", "tree"),
    "xformOp:scale = (0.1, 0.2, 0.3)": ("xformOp:scale = (0.1, 0.2, 0.31)", "collisions"),
    "rel physics:body1 = </r/slide>": ("rel physics:body1 = </r/base>", "tree"),
    "physics:localPos0 = (0, 0, 0.4)": ("physics:localPos0 = (0, 0, 0.5)", "frames"),
}


@pytest.mark.parametrize("old", list_cases(CHANGES, 3))
def test_a_changed_stage_differs(write, old):
    new, row = CHANGES[old]
    path = write("arm.urdf", ARM)
    written = export(path, file="r.usda")
    text = written.files["r.usda"].decode()
    assert old in text
    written.files["r.usda"] = text.replace(old, new, 1).encode()
    checks = our_rows(path, written)
    assert row in {check.name for check in checks if check.verdict == "differs"}


def our_rows(path, written):
    """The rows of our reader, without Newton's."""
    return checks_of(path, written, newton=False, file=written.main)


def test_the_command_verifies(urdftool, write):
    path = write("arm.urdf", ARM)
    result = urdftool("export", "usd", path, "-o", "arm.usda", "--verify")
    assert result.code == 0
    assert "differs" not in result.out
    again = urdftool("export", "usd", path, "-o", "arm.usda")
    assert again.code == 0
    write("arm.usda", "#usda 1.0\n")
    assert urdftool("export", "usd", path, "-o", "arm.usda").code == 2


def test_only_reported_losses_excuse_a_difference(write):
    path = write("arm.urdf", robot(link("a"), joint("j", "a", "b", "continuous"), link("b", None)))
    written = export(path, file="r.usda")
    assert is_faithful(our_rows(path, written))
    written.losses.clear()
    assert not is_faithful(our_rows(path, written))


@pytest.mark.slow
@pytest.mark.library("newton")
def test_newton_reads_the_same(write):
    path = write("arm.urdf", ARM)
    written = export(path, file="r.usda")
    rows = {check.name: check for check in checks_of(path, written, file="r.usda")}
    assert rows["Newton: import"].verdict == "equal"
    assert not any(row.differing for row in rows.values())
    assert {row.verdict for name, row in rows.items() if "Newton" in name} == {"equal"}
    written.files["r.usda"] = written.files["r.usda"].replace(b"maxForce = 33.5", b"maxForce = 30")
    rows = {check.name: check for check in checks_of(path, written, file="r.usda")}
    assert rows["Newton: joint values"].differing == ["effort of joint 'j'"]
    place = b"xformOp:scale = (0.1, 0.2, 0.3)"
    written.files["r.usda"] = written.files["r.usda"].replace(place, place.replace(b"0.3", b"0.31"))
    rows = {check.name: check for check in checks_of(path, written, file="r.usda")}
    assert rows["Newton: shapes"].verdict == "differs"
    assert rows["Newton: colliders"].verdict == "equal"
    assert rows["Newton: friction"].verdict == "equal"
    assert b"dynamicFriction = 0.3" in written.files["r.usda"]
    written.files["r.usda"] = written.files["r.usda"].replace(
        b"dynamicFriction = 0.3", b"dynamicFriction = 0.5"
    )
    rows = {check.name: check for check in checks_of(path, written, file="r.usda")}
    assert rows["Newton: friction"].verdict == "differs"


@pytest.mark.parametrize("name", ["arm.usdc", "arm.usdz"])
def test_a_binary_file_of_the_user_is_kept(write, name):
    import urdftool
    from urdftool.errors import OutputError

    model = urdftool.load(write("arm.urdf", ARM))
    place = Path(write(name, b"mine"))
    with pytest.raises(OutputError):
        urdftool.export_usd(model, place)
    assert place.read_bytes() == b"mine"
    urdftool.export_usd(model, place, overwrite=True)
    urdftool.export_usd(model, place)
    assert place.read_bytes() != b"mine"


def test_gains_of_an_actuator_file_are_compared(write):
    path = write("arm.urdf", ARM)
    config = Path(write("gains.toml", "[joints.j]\nkp = 120\nkd = 3\narmature = 0.1\n"))
    written = export(path, file="r.usda", actuator_config=config)
    assert is_faithful(our_rows(path, written))
    written.files["r.usda"] = export(path, file="r.usda").files["r.usda"]
    wrong = {check.name for check in our_rows(path, written) if check.verdict == "differs"}
    assert wrong == {"actuators", "joint physics"}


LIMIT = '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="20" velocity="9"/>'
TENSOR = '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>'
POLE = '<geometry><box size="0.04 0.04 0.4"/></geometry>'
LEG = f'<collision><origin xyz="0 0 -0.2"/>{POLE}</collision>'
STANDING = robot(
    link("base", 4, BOX),
    *(
        joint(f"hip{n}", "base", f"leg{n}", "revolute", f'<origin xyz="{x} {y} 0"/>{LIMIT}')
        + link(f"leg{n}", 0.5, LEG, TENSOR, '<origin xyz="0 0 -0.2"/>')
        for n, (x, y) in enumerate((x, y) for x in (0.2, -0.2) for y in (0.1, -0.1))
    ),
)


@pytest.mark.slow
@pytest.mark.library("mujoco")
def test_the_stage_is_stepped_as_it_was_read_back(write):
    path = write("legs.urdf", STANDING)
    written = export(path, file="r.usda", pose={"hip*": 0.3})
    assert rows_by_name(path, written)["runs"].verdict == "equal"
    text = written.files["r.usda"].decode()
    weak = re.sub(r"physics:(stiffness|damping) = \S+", r"physics:\1 = 0.001", text)
    written.files["r.usda"] = weak.encode()
    fallen = rows_by_name(path, written)["runs"]
    assert fallen.verdict == "announced"
    assert any(text.startswith("falls: the base moves") for text in fallen.announced)


BOB = '<collision><origin xyz="0 0 -0.2"/><geometry><sphere radius="0.05"/></geometry></collision>'
CROSSED = robot(
    link("base", 4, BOX),
    *(
        joint(name, "base", f"{name}_bob", "revolute",
              f'<origin xyz="{x} 0 -0.2"/><axis xyz="0 1 0"/>'
              '<limit lower="-0.1" upper="0.1" effort="0.5" velocity="9"/>')
        + link(f"{name}_bob", 0.5, BOB, TENSOR)
        for name, x in (("one", 0), ("two", 0.02))
    ),
)  # fmt: skip


@pytest.mark.library("mujoco")
def test_the_stage_is_stepped_with_contacts_between_links_only_if_it_has_them(write):
    path = write("crossed.urdf", CROSSED)
    written = export(path, file="r.usda", base="fixed")
    text = written.files["r.usda"].decode()
    assert "newton:selfCollisionEnabled = 0" in text
    assert rows_by_name(path, written)["runs"].verdict == "equal"
    collides = text.replace("selfCollisionEnabled = 0", "selfCollisionEnabled = 1")
    written.files["r.usda"] = collides.encode()
    assert rows_by_name(path, written)["runs"].verdict == "differs"


def test_without_mujoco_the_stage_is_not_stepped(write, monkeypatch):
    monkeypatch.setattr("urdftool.formats.step_read_back.is_installed", lambda name: False)
    path = write("arm.urdf", ARM)
    row = rows_by_name(path, export(path, file="r.usda"))["runs"]
    assert (row.verdict, row.skipped) == ("not compared", "not stepped: MuJoCo is not installed")


def rows_by_name(path, written):
    return {check.name: check for check in our_rows(path, written)}


@pytest.mark.library("mujoco")
def test_what_only_a_mjcf_has_is_reported_and_no_row(urdftool, write):
    body = '<joint name="j"/><geom size=".1"/><site name="s" group="4"/><camera mode="track"/>'
    text = f'<mujoco><worldbody><body name="a">{body}</body></worldbody></mujoco>'
    done = urdftool("-v", "export", "usd", write("r.xml", text), "-o", "r.usda", "--verify")
    assert done.code == 0
    assert "other elements" not in done.out
    assert "camera" in done.err


@pytest.mark.parametrize(("pose", "code"), [("0 0 0", 0), ("0 0 1", 1)])
def test_equal_meshes_of_two_files_at_one_place_are_drawn_once(urdftool, write, pose, code):
    """A stage has one file of equal meshes; a mesh at another place is missed."""
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
    for name in ("a.obj", "b.obj"):
        write(name, text)
    mesh = '<visual>{}<geometry><mesh filename="{}"/></geometry></visual>'
    first = mesh.format("", "a.obj")
    source = write("r.urdf", robot(link("base", 2, first + mesh.format("", "b.obj"))))
    assert urdftool("export", "usd", source, "-o", "r.usda").code == 0
    second = mesh.format(f'<origin xyz="{pose}"/>', "b.obj")
    moved = write("m.urdf", robot(link("base", 2, first + second)))
    assert urdftool("verify", moved, "r.usda").code == code
