"""What exports say: in the linter's words, once, and with what would help."""

import ast
from pathlib import Path

import pytest

from urdftool.compare.check import Check
from urdftool.report.exports import format_check_table
from urdftool.rules import FAMILY_OF
from urdftool.source.description_formats import NAMES

FORMATS = Path(__file__).parents[2] / "urdftool" / "formats"

BALL = '<visual><geometry><mesh filename="package://gone/meshes/{}.stl"/></geometry></visual>'
ARM = (
    '<robot name="r"><link name="a">' + BALL.format("a") + "</link>"
    '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'
    '<link name="b">' + BALL.format("b") + "</link></robot>"
)


@pytest.mark.parametrize("language", NAMES)
def test_a_package_that_is_not_found_is_one_message_with_the_option(urdftool, tmp_path, language):
    file = tmp_path / "robot.urdf"
    file.write_text(ARM)
    result = urdftool("export", language, file, "-o", tmp_path / "out")
    assert result.code == 2
    first, last = result.err.splitlines()
    assert "mesh 'package://gone/meshes/a.stl' of link 'a' is not found (and 1 more)" in first
    assert "--package gone=DIR" in first
    assert last == "urdftool: no file was written: 1 error"


@pytest.mark.parametrize("language", NAMES)
def test_a_path_that_leads_nowhere_is_told_in_full(urdftool, tmp_path, language):
    file = tmp_path / "robot.urdf"
    file.write_text(ARM.replace("package://gone/meshes", "shapes"))
    result = urdftool("export", language, file, "-o", tmp_path / "out")
    assert (
        f"does not exist (and 1 more) (folder {tmp_path / 'shapes'} does not exist)"
    ) in result.err
    (tmp_path / "shapes").mkdir()
    result = urdftool("export", language, file, "-o", tmp_path / "out")
    for name in "ab":
        assert (
            f"does not exist (file {tmp_path / 'shapes' / name}.stl does not exist)"
        ) in result.err


def test_defects_bear_the_names_that_lint_explains():
    named = set()
    for path in FORMATS.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) == "make_defect":
                rules = [n for n in ast.walk(node.args[0]) if isinstance(n, ast.Constant)]
                named.update(n.value for n in rules if "-" in str(n.value))
    own = {"too-deep", "too-many-links"}  # bounds of MuJoCo and OpenUSD
    assert len(named) >= 4
    assert {name for name in named if name not in FAMILY_OF} - own == set()


@pytest.mark.parametrize("language", [name for name in NAMES if name != "usd"])
def test_where_nothing_weighs_anything_differences_are_what_they_are(urdftool, tmp_path, language):
    file = tmp_path / "robot.urdf"
    turns = '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'
    at = '<origin xyz="0 0 1"/>'
    file.write_text(
        '<robot name="r"><link name="a"/><link name="b"/><link name="c"/>'
        f'<joint name="j" type="revolute">{at}<parent link="a"/><child link="b"/>{turns}</joint>'
        f'<joint name="k" type="revolute">{at}<parent link="b"/><child link="c"/>{turns}</joint>'
        "</robot>"
    )
    result = urdftool("export", language, file, "-o", tmp_path / "out", "--verify")
    assert result.code == 0
    rows = [
        line for line in result.out.splitlines() if line.startswith(("mass matrix ", "gravity  "))
    ]
    for row in rows:
        worst = float(row.split("  ")[-3].strip() or row.split()[-3])
        assert worst < 1e-3
    assert len(rows) == 2


def test_what_is_announced_of_many_is_one_line():
    check = Check("limits", "efforts", 1e-9)
    for name in "abcde":
        check.compare(1.0, f"effort of joint '{name}'", known=True)
    last = format_check_table([check]).splitlines()[-1]
    assert last == (
        "limits: announced: effort of joint 'a', effort of joint 'b', effort of joint 'c' "
        "and 2 more"
    )


@pytest.mark.parametrize("language", NAMES)
def test_a_branch_on_a_link_that_does_not_exist_is_no_loop(urdftool, tmp_path, language):
    file = tmp_path / "robot.urdf"
    joint = '<joint name="{}" type="fixed"><parent link="{}"/><child link="{}"/></joint>'
    links = "".join(f'<link name="{name}"/>' for name in "abc")
    hangs = joint.format("j", "no", "b") + joint.format("k", "b", "c")
    file.write_text(f'<robot name="r">{links}{hangs}</robot>')
    result = urdftool("export", language, file, "-o", tmp_path / "out")
    assert "[unknown-parent-link]" in result.err
    assert "[detached-cycle]" not in result.err
    file.write_text(f'<robot name="r">{links}{hangs.replace("no", "c")}</robot>')
    result = urdftool("export", language, file, "-o", tmp_path / "out")
    assert "[detached-cycle]" in result.err


MASKS = (
    '<mujoco><worldbody><body name="a"><freejoint/>'
    '<geom type="box" size=".1 .1 .1" contype="2" conaffinity="4" solref=".01 1"/></body>'
    "</worldbody></mujoco>"
)


@pytest.mark.parametrize("language", ["urdf", "sdf", "usd"])
def test_a_mask_of_contacts_is_a_loss_and_the_softness_of_a_contact_a_note(
    urdftool, tmp_path, language
):
    pytest.importorskip("mujoco")
    file = tmp_path / "robot.xml"
    file.write_text(MASKS)
    out = tmp_path / f"out.{'usda' if language == 'usd' else language}"
    usual = urdftool("export", language, file, "-o", out)
    assert usual.code == 0
    assert "warning: contype and conaffinity of link 'a'" in usual.err
    assert "solref" not in usual.err
    strict = urdftool("export", language, file, "-o", out, "--strict", "--force")
    assert strict.code == 2
    assert "error: contype and conaffinity of link 'a'" in strict.err


@pytest.mark.parametrize("language", ["urdf", "sdf", "mjcf", "usd"])
def test_a_spring_that_is_not_linear_is_not_read_and_no_export_is_strict(
    urdftool, tmp_path, language
):
    mujoco = pytest.importorskip("mujoco")
    text = (
        '<mujoco><worldbody><body name="a"><joint name="j" stiffness="1 2 3"/>'
        '<geom type="box" size=".1 .1 .1"/></body></worldbody></mujoco>'
    )
    if not hasattr(mujoco.MjModel.from_xml_string("<mujoco/>"), "jnt_stiffnesspoly"):
        pytest.skip("this MuJoCo has no polynomial springs")
    file = tmp_path / "robot.xml"
    file.write_text(text)
    result = urdftool("export", language, file, "-o", tmp_path / "out", "--strict")
    assert result.code == 2
    assert "a spring whose force is not proportional to its deflection is not read" in result.err
    linear = tmp_path / "linear.xml"
    linear.write_text(text.replace("1 2 3", "1 0 0"))
    compared = urdftool("verify", file, linear)
    assert "parts that are compared were not read" in compared.err


def test_losses_that_differ_in_a_name_share_a_line(urdftool, tmp_path):
    pytest.importorskip("mujoco")
    bodies = "".join(
        f'<body><joint name="j{i}" armature=".1"/><geom size=".1"/></body>' for i in range(5)
    )
    file = tmp_path / "robot.xml"
    file.write_text(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
    result = urdftool("export", "sdf", file, "-o", tmp_path / "out")
    line = "armature of joint 'j0' is dropped (and 4 more: 'j1', 'j2', 'j3', …)"
    assert line in result.err
