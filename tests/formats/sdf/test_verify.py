"""The comparison finds what is wrong with a file, whatever wrote it."""

import re

import pytest

from urdftool.compare.check import is_faithful
from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.verify.compare import compare, read_pair, verify
from urdftool.formats.sdf.write import write
from urdftool.model.load import load

from .goldens import FOLDER

ARM = FOLDER / "gripper_arm.urdf"


def checks_of(tmp_path, change=lambda text: text, quiet=False, **choices):
    source = load(ARM)
    written = write(source, Options(**choices))
    if quiet:
        written.losses.clear()
    place = tmp_path / "model.sdf"
    text = written.files["model.sdf"].decode()
    changed = change(text)
    assert changed != text or change("") == ""
    place.write_text(changed)
    pair = read_pair(source, written, place, Options(**choices))
    return {check.name: check for check in compare(pair)}


@pytest.mark.parametrize("fixed_joints", ["keep", "lump"])
@pytest.mark.parametrize("version", ["1.9", "1.11", "1.12"])
def test_an_export_is_faithful(tmp_path, fixed_joints, version):
    checks = checks_of(tmp_path, fixed_joints=fixed_joints, version=version)
    assert is_faithful(checks.values())
    assert checks["frames"].worst < 1e-12


def replaced(old, new):
    return lambda text: text.replace(old, new, 1)


@pytest.mark.parametrize(
    ("change", "found"),
    [
        (replaced("<mass>1.5</mass>", "<mass>1.6</mass>"), {"mass"}),
        (replaced("<ixy>0.001</ixy>", "<ixy>-0.001</ixy>"), {"inertia"}),
        (replaced("<mass>4</mass>", "<mass>4.0001</mass>"), {"mass"}),
        (replaced("<upper>1.5</upper>", "<upper>1.6</upper>"), {"limits"}),
        (replaced("<friction>0.1</friction>", ""), {"joint physics"}),
        (replaced("<effort>20</effort>", "<effort>-1</effort>"), {"limits"}),
        (replaced("<multiplier>0.9<", "<multiplier>1<"), {"tree"}),
        (replaced('type="prismatic"', 'type="revolute"'), {"tree"}),
        (replaced("0 0 0.3 0 0 0.5", "0 0 0.3 0 0 0.6"), {"frames"}),
        (replaced("<size>0.1 0.05 0.04</size>", "<size>0.1 0.05 0.05</size>"), {"collisions"}),
        (replaced("<diffuse>0.2 0.4 0.9 0.7", "<diffuse>0.25 0.5 1 0.7"), {"colors"}),
        (replaced("<izz>0.004</izz>", "<izz>0.0041</izz>"), {"inertia"}),
        (replaced("<xyz>0 0 1</xyz>", "<xyz>0 1 0</xyz>"), {"axes"}),
        (lambda text: re.sub(r"<visual.*?</visual>", "", text, count=1, flags=re.S), {"visuals"}),
    ],
)  # fmt: skip
def test_a_change_is_found(tmp_path, change, found):
    checks = checks_of(tmp_path, change)
    assert found <= {name for name, check in checks.items() if check.verdict == "differs"}


@pytest.mark.parametrize(
    "change",
    [replaced('<frame name="flange"', '<frame name="flanges"'), replaced("</sdf>", "")],
)
def test_a_file_that_cannot_be_read_differs(tmp_path, change):
    source = load(ARM)
    written = write(source)
    text = change(written.files["model.sdf"].decode())
    (tmp_path / "model.sdf").write_text(text)
    (check,) = verify(source, written, Options(), tmp_path)
    assert check.verdict == "differs"


def test_what_was_announced_is_no_failure(tmp_path):
    checks = checks_of(tmp_path, version="1.9")
    assert checks["tree"].verdict == "announced"
    assert checks_of(tmp_path, quiet=True, version="1.9")["tree"].verdict == "differs"


MASSLESS_MOVED = """<robot name="m">
 <link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
 <link name="b"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
 <link name="c"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
 <link name="tip"><inertial><mass value="1e-9"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
 <joint name="j" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0 0 5"/></joint>
 <joint name="f" type="fixed"><parent link="b"/><child link="c"/><origin xyz="0 0 3"/></joint>
 <joint name="t" type="fixed"><parent link="c"/><child link="tip"/><origin xyz="0 9 0"/></joint>
</robot>"""  # noqa: E501


@pytest.mark.parametrize(
    ("fixed_joints", "change", "found"),
    [
        ("keep", "", set()),
        ("lump", "", set()),
        ("keep", "0 0 3 0 0 0", {"frames", "center of mass", "mass matrix", "gravity"}),
    ],
)
def test_a_body_whose_topmost_link_has_no_mass(write, tmp_path, fixed_joints, change, found):
    """The link frame of 'c' is written below a fixed joint, and a placeholder is lumped."""
    from urdftool.formats.sdf.write import write as write_sdf

    source, options = load(write("m.urdf", MASSLESS_MOVED)), Options(fixed_joints=fixed_joints)
    written = write_sdf(source, options)
    place = tmp_path / "model.sdf"
    text = written.files["model.sdf"].decode()
    assert change in text
    place.write_text(text.replace(change, "0 0 4 0 0 0") if change else text)
    checks = compare(read_pair(source, written, place, options))
    assert {check.name for check in checks if check.differing} == found
