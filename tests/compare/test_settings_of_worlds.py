"""What the settings of one world change is not called equal, in any two formats."""

import ast
from pathlib import Path

import pytest

import urdftool
from urdftool.compare.rows import ROWS
from urdftool.compare.unread import _ROWS, NO_ROW
from urdftool.model import world_settings

INERTIA = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
BODY = f'<inertial><mass value="1"/>{INERTIA}</inertial>'
SPHERE = '<geometry><sphere radius="0.1"/></geometry>'
URDF = f"""<robot name="r"><link name="a">{BODY}<collision>{SPHERE}</collision></link>
<link name="b">{BODY}<collision>{SPHERE}</collision></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="1" effort="5" velocity="1"/><dynamics damping="1" friction="1"/></joint>
</robot>"""
MASS = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><geom size="0.1" group="3"/>'
MJCF = f"""<mujoco model="r"><compiler angle="radian"/><option {{}}>{{}}</option><worldbody>
<body name="a">{MASS}<body name="b">{MASS}<joint name="j" axis="1 0 0" range="-1 1" damping="1"
frictionloss="1" actuatorfrcrange="-5 5"/></body></body></worldbody>{{}}</mujoco>"""
TENDON = (
    '<tendon><fixed name="t" stiffness="9"><joint joint="j" coef="1"/></fixed></tendon>',
    "other elements",
)
DECIDED = {
    'gravity="0 0 0"': "gravity",
    'wind="1 0 0" density="1"': "link flags",
    'viscosity="0.1"': "link flags",
    'magnetic="0 0 0"': "sensors",
    'actuatorgroupdisable="2 4"': "actuators",
    'o_margin="0.1"': "collisions",
    'o_friction="0.1 0.1 0 0 0"': "surface",
    **{f'<flag {flag}="disable"/>': rows[0] for flag, rows in (
        ("gravity", ("gravity",)), ("limit", ("limits",)), ("contact", ("collisions",)),
        ("equality", ("tree",)), ("frictionloss", ("joint physics",)), ("sensor", ("sensors",)),
        ("damper", ("joint physics",)), ("spring", ("joint physics",)),
        ("constraint", ("limits",)), ("actuation", ("actuators",)), ("clampctrl", ("actuators",)),
    )},
    TENDON[0]: TENDON[1],
}  # fmt: skip


def load(folder: Path, name: str, text: str) -> urdftool.Robot:
    path = folder / name
    path.write_text(text)
    return urdftool.load(path)


def write_mjcf(setting: str) -> str:
    places = ["", "", ""]
    places[1 if setting.startswith("<flag") else 2 if setting.startswith("<") else 0] = setting
    return MJCF.format(*places)


def get_checks(one: urdftool.Robot, two: urdftool.Robot):
    agreement = urdftool.verify(one, two)
    (comparison,) = agreement.pairs.values()
    return agreement.is_equal, {row.name: row for row in comparison.make_checks()}, comparison


@pytest.mark.library("mujoco")
def test_a_setting_without_an_effect_leaves_robots_equal(tmp_path):
    urdf = load(tmp_path, "r.urdf", URDF)
    for number, setting in enumerate(("", 'timestep="0.001" solver="PGS" cone="elliptic"')):
        mjcf = load(tmp_path, f"{number}.xml", write_mjcf(setting))
        is_equal, checks, _ = get_checks(urdf, mjcf)
        assert is_equal
        for row in ("limits", "joint physics", "collisions", "gravity"):
            assert checks[row].verdict == "equal"


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("setting", DECIDED)
def test_a_row_that_a_setting_decides_is_not_equal(tmp_path, setting):
    mjcf = load(tmp_path, "r.xml", write_mjcf(setting))
    row = DECIDED[setting]
    for other in (load(tmp_path, "r.urdf", URDF), load(tmp_path, "o.xml", write_mjcf(""))):
        is_equal, checks, comparison = get_checks(mjcf, other)
        assert not is_equal
        verdict = checks[row].verdict if row in checks else "not compared"
        assert verdict in ("not compared", "differs"), verdict
        assert row in checks or row in comparison.list_skipped()


@pytest.mark.library("mujoco")
def test_two_worlds_with_one_setting_are_equal(tmp_path):
    flags = '<flag gravity="disable" limit="disable"/>'
    robots = [load(tmp_path, f"{name}.xml", write_mjcf(flags)) for name in "ab"]
    is_equal, checks, _ = get_checks(*robots)
    assert is_equal
    assert checks["limits"].verdict == checks["gravity"].verdict == "equal"


@pytest.mark.library("mujoco")
def test_an_export_to_urdf_reports_settings_of_the_world(tmp_path):
    mjcf = load(tmp_path, "r.xml", write_mjcf('gravity="0 0 -1.62" timestep="0.001"'))
    losses = [x for x in urdftool.export_urdf(mjcf).losses if x.code == "lossy-world-setting"]
    assert [(x.severity.name, x.name) for x in losses] == [
        ("WARNING", "gravity 0 0 -1.62"),
        ("INFO", "timestep 0.001"),
    ]


def test_rows_of_settings_and_of_unread_parts_exist():
    known = {row.name for row in ROWS}
    decided = [*world_settings._DECIDED.values(), *world_settings._DECIDED_BY_FLAG.values()]
    named = {name for names in decided for name in names}
    named |= {name for row in _ROWS.values() for name in row.names}
    assert named <= known
    assert not NO_ROW & _ROWS.keys()


def list_codes(path: Path) -> set[str]:
    """Return the codes of losses that a module of a reader names in a call."""
    codes = set()
    for node in ast.walk(ast.parse(path.read_text())):
        is_call = isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)
        if is_call and node.args and isinstance(node.args[0], ast.Constant):
            owner = node.func.value
            of_losses = node.func.attr == "add" and "losses" in ast.unparse(owner)
            if of_losses or node.func.attr in ("record_loss", "report_loss"):
                codes.add(str(node.args[0].value))
    return codes


def test_each_code_of_a_reader_has_a_row_or_is_known_to_have_none():
    formats = Path(urdftool.__file__).parent / "formats"
    paths = [path for name in ("mjcf", "sdf", "usd") for path in (formats / name).glob("read*.py")]
    codes = {code for path in paths for code in list_codes(path)}
    assert len(codes) > 40
    assert codes - _ROWS.keys() - NO_ROW == set()
