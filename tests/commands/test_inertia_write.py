"""Inertia written into the source: only what is added or changed differs."""

import difflib
import json
import shutil
from pathlib import Path

import jsonschema
import pytest

import urdftool as library
from tests.conftest import FIXTURES, ROOT

ROBOTS = FIXTURES / "robots"
SCHEMA = json.loads((ROOT / "docs" / "schemas" / "inertia-write.json").read_text())

MIRA = {
    "base_link": 0.18,
    "roll_M1_link": 0.001,
    "pitch_M2_link": 0.001,
    "yaw_M3_link": 0.001,
    "head_link": 0.02,
    "left_eye_link": 0.001,
    "right_eye_link": 0.001,
    "camera_link": 0.001,
}


def changes(before, after):
    """The lines that were taken out and those that were added."""
    diff = list(difflib.ndiff(before.splitlines(True), after.splitlines(True)))
    return [d[2:] for d in diff if d[0] == "-"], [d[2:] for d in diff if d[0] == "+"]


def moments(link):
    return link.inertial.inertia.moments


def fill(urdftool, path, *words, code=0):
    done = urdftool("inertia", "robot", path, "--write", *words)
    assert done.code == code, done.err
    return done


def test_the_head_without_inertia_gets_its_figures(urdftool, write):
    before = (ROBOTS / "mira_description" / "urdf" / "mira_geometric.urdf").read_text()
    path = write("mira.urdf", before)
    fill(urdftool, path, *(word for n, m in MIRA.items() for word in ("--mass", f"{n}={m}")))
    after = Path(path).read_text()
    removed, added = changes(before, after)
    assert removed == []
    assert len(added) == 5 * len(MIRA)
    robot = library.load(path)
    assert {link.name: link.mass for link in robot.links} == MIRA
    assert moments(robot.link["base_link"]) == (0.0002835, 0.0002835, 0.000324)
    assert moments(robot.link["head_link"]) == (2.88e-05, 2.88e-05, 2.88e-05)
    assert not [f for f in library.check(path) if f.code.startswith("inertia")]
    fill(urdftool, path, "--all")
    assert Path(path).read_text() == after


BARE = (
    '<robot name="r">\n'
    '  <link name="a"> <!-- the base -->\n'
    '    <visual><geometry><box size="1 1 0.5"/></geometry></visual>\n'
    "  </link>\n"
    '  <link name="b"><visual><geometry><sphere radius="1"/></geometry></visual></link>\n'
    "</robot>\n"
)


def test_line_ends_and_a_byte_order_mark_are_kept(urdftool, write):
    before = b"\xef\xbb\xbf" + BARE.replace("\n", "\r\n").encode()
    path = write("r.urdf", before)
    fill(urdftool, path, "--density", "10")
    after = Path(path).read_bytes()
    assert after.startswith(b"\xef\xbb\xbf<robot")
    assert after.count(b"\n") == after.count(b"\r\n")
    assert b"the base -->\r\n    <inertial>\r\n      <origin" in after
    assert b'<link name="b"><inertial><origin' in after
    assert after.replace(b"\r\n", b"\n").count(b"<visual>") == 2


def test_tabs_are_kept(urdftool, write):
    path = write("r.urdf", BARE.replace("  ", "\t"))
    fill(urdftool, path, "--density", "10")
    assert '\n\t\t<inertial>\n\t\t\t<origin xyz="0 0 0" rpy="0 0 0"/>' in Path(path).read_text()


def test_text_in_another_encoding(urdftool, write):
    text = '<?xml version="1.0" encoding="iso-8859-1"?>\n<!-- Gr\xf6\xdfe -->\n' + BARE
    path = write("r.urdf", text.encode("latin-1"))
    fill(urdftool, path, "--density", "10", "-o", "out.urdf")
    assert b"Gr\xf6\xdfe" in Path("out.urdf").read_bytes()
    utf16 = write("u.urdf", BARE.encode("utf-16"))
    done = fill(urdftool, utf16, "--density", "10", code=2)
    assert "UTF-8" in done.err
    assert Path(utf16).read_bytes() == BARE.encode("utf-16")


PARTS = [
    ("<inertial/>", ["origin", "mass", "inertia"]),
    ("<inertial></inertial>", ["origin", "mass", "inertia"]),
    ('<inertial><mass value="3"/></inertial>', ["inertia"]),
    ('<inertial>\n      <mass value="3"/>\n    </inertial>', ["inertia"]),
    ('<inertial><origin xyz="0 0 0.5"/></inertial>', ["mass", "inertia"]),
    ('<inertial><mass/><inertia ixx="1" iyy="1" izz="1"/></inertial>', ["value", "ixy"]),
    ('<inertial><mass value="3"/><inertia ixx="1" iyy="1" izz="1"/></inertial>', ["ixy"]),
]


@pytest.mark.parametrize(("part", "wanted"), PARTS)
def test_what_is_missing_of_an_inertial_is_added(urdftool, write, part, wanted):
    shape = '<visual><origin xyz="0 0 0.5"/><geometry><box size="1 1 1"/></geometry></visual>'
    before = f'<robot name="r">\n  <link name="a">\n    {part}\n    {shape}\n  </link>\n</robot>\n'
    path = write("r.urdf", before)
    fill(urdftool, path, "--density", "6")
    after = Path(path).read_text()
    for name in wanted:
        assert f"<{name}" in after or f"{name}=" in after
    link = library.load(path).link["a"]
    assert link.mass in (3, 6)
    if "inertia" in wanted:
        assert moments(link) == pytest.approx([link.mass / 6] * 3)
        assert link.inertial.origin.xyz == (0, 0, 0.5)
    assert not [f for f in library.check(path) if f.code == "incomplete-inertial"]
    fill(urdftool, path, "--density", "6")
    assert Path(path).read_text() == after


def test_an_inertial_keeps_its_own_axes(urdftool, write):
    before = (
        '<robot name="r">\n  <link name="a">\n    <inertial>\n'
        '      <origin xyz="9 9 9" rpy="0 0 1.5707963267948966"/>\n      <mass value="12"/>\n'
        '      <inertia ixx="7" ixy="0" ixz="0" iyy="7" iyz="0" izz="7"/>\n    </inertial>\n'
        '    <collision><geometry><box size="1 2 3"/></geometry></collision>\n'
        "  </link>\n</robot>\n"
    )
    path = write("r.urdf", before)
    fill(urdftool, path, "--all")
    text = Path(path).read_text()
    assert 'xyz="0 0 0" rpy="0 0 1.5707963267948966"' in text
    assert 'ixx="10" ixy="0" ixz="0" iyy="13" iyz="0" izz="5"' in text
    removed, added = changes(before, text)
    assert len(removed) == len([a for a in added if a.strip()]) == 2


def test_what_is_wrong_is_left_without_all(urdftool, write):
    path = write(
        "r.urdf",
        BARE.replace(
            "the base -->",
            'x --><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" '
            'izz="9"/></inertial>',
        ),
    )
    done = fill(urdftool, path, "--density", "10", code=1)
    assert "--all recomputes it" in done.err
    assert 'izz="9"' in Path(path).read_text()
    fill(urdftool, path, "--density", "10", "--all")
    assert 'izz="9"' not in Path(path).read_text()


def test_a_written_mass_is_not_replaced_in_passing(urdftool, write):
    done = fill(urdftool, write("r.urdf", BARE), "--density", "10")
    done = fill(urdftool, "r.urdf", "--mass", "a=77")
    assert "--all replaces it" in done.err
    assert 'mass value="5"' in Path("r.urdf").read_text()


def test_one_link_only(urdftool, write):
    path = write("r.urdf", BARE)
    fill(urdftool, path, "--density", "10", "--link", "b")
    robot = library.load(path)
    assert (robot.link["a"].inertial, robot.link["b"].mass) == (None, pytest.approx(41.8879020479))


def test_the_source_is_not_touched_with_an_output(urdftool, write):
    path = write("r.urdf", BARE)
    done = fill(urdftool, path, "--density", "10", "-o", "out.urdf")
    assert Path(path).read_text() == BARE
    assert "<inertial>" in Path("out.urdf").read_text()
    done = fill(urdftool, path, "--density", "10", "-o", "-")
    assert done.out == Path("out.urdf").read_text()
    assert "2 links written" in done.err
    assert urdftool("inertia", "robot", path, "--write", "--density", "1", "-o", path).code == 2
    assert Path(path).read_text() == BARE


def test_the_json_of_what_was_written(urdftool, write):
    gone = (
        '  <link name="c"><visual><geometry><mesh filename="c.stl"/></geometry></visual></link>\n'
    )
    path = write("r.urdf", BARE.replace("</robot>", gone + "</robot>"))
    done = fill(urdftool, path, "--density", "10", "--format", "json")
    found = json.loads(done.out)
    jsonschema.validate(found, SCHEMA)
    assert [link["name"] for link in found["written"]] == ["a", "b"]
    assert "no such mesh" in found["left"][0]["reason"]


def test_nothing_says_what_it_weighs(urdftool, write):
    done = fill(urdftool, write("r.urdf", BARE))
    assert Path("r.urdf").read_text() == BARE
    assert "--mass a=KG" in done.err


# xacro

BOX = '<visual><geometry><box size="${size}"/></geometry></visual>'
MACRO = f'<xacro:macro name="part" params="name size">\n<link name="${{name}}">\n{BOX}\n</link>\n'
MACRO += "</xacro:macro>\n"


def test_links_of_a_macro_that_agree_are_filled_in_the_macro(urdftool, xacro_file):
    calls = '<xacro:part name="a" size="1 1 1"/>\n<xacro:part name="b" size="1 1 1"/>'
    path = xacro_file("r.xacro", MACRO + calls)
    fill(urdftool, path, "--density", "6")
    assert Path(path).read_text().count("<inertial>") == 1
    assert [moments(link) for link in library.load(path).links] == [(1, 1, 1)] * 2


def test_links_of_a_macro_that_differ_are_said(urdftool, xacro_file):
    calls = '<xacro:part name="a" size="1 1 1"/>\n<xacro:part name="b" size="1 2 1"/>'
    path = xacro_file("r.xacro", MACRO + calls)
    before = Path(path).read_text()
    done = fill(urdftool, path, "--density", "6", code=1)
    assert Path(path).read_text() == before
    assert "r.xacro:3:1: link 'a' is not edited" in done.err
    assert "other expansions" in done.err
    assert 'add <inertial> <origin xyz="0 0 0" rpy="0 0 0"/> <mass value="12"/>' in done.err
    assert "r.xacro:8:1 (macro 'part' name=b size=1 2 1)" in done.err


NUMBERS = " ".join(f'{n}="${{{n}}}"' for n in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
PASSED = (
    '<xacro:macro name="part" params="name mass ixx ixy ixz iyy iyz izz">\n<link name="${name}">\n'
    f'<inertial><mass value="${{mass}}"/><inertia {NUMBERS}/></inertial>\n'
    '<visual><geometry><box size="1 1 1"/></geometry></visual>\n</link>\n</xacro:macro>\n'
)


def test_numbers_that_a_call_passes_on_are_edited_in_the_call(urdftool, xacro_file):
    six = 'ixx="9" ixy="0" ixz="0" iyy="9" iyz="0" izz="9"'
    calls = f'<xacro:part name="a" mass="6" {six}/>\n<xacro:part name="b" mass="12" {six}/>'
    path = xacro_file("r.xacro", PASSED + calls)
    before = Path(path).read_text()
    fill(urdftool, path, "--all")
    _, added = changes(before, Path(path).read_text())
    assert [line[:26] for line in added if line.startswith("<")] == [
        '<xacro:part name="a" mass=',
        '<xacro:part name="b" mass=',
    ]
    assert [moments(link) for link in library.load(path).links] == [(1, 1, 1), (2, 2, 2)]


def test_numbers_that_are_computed_are_said(urdftool, xacro_file):
    inertia = '<inertia ixx="${2*k}" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    path = xacro_file(
        "r.xacro",
        '<xacro:property name="k" value="0.3"/>\n<link name="a">\n'
        f'<inertial><mass value="6"/>{inertia}</inertial>\n'
        '<visual><geometry><box size="1 1 1"/></geometry></visual>\n</link>',
    )
    before = Path(path).read_text()
    done = fill(urdftool, path, "--all", code=1)
    assert 'ixx="${2*k}" is computed' in done.err
    assert 'r.xacro:4:37: set ixx="1"' in done.err
    assert Path(path).read_text() == before


def test_a_block_that_serves_the_visual_too_is_not_moved(urdftool, xacro_file):
    macro = (
        '<xacro:macro name="part" params="*o">\n<link name="a">\n<inertial>'
        '<xacro:insert_block name="o"/><mass value="6"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" '
        'iyz="0" izz="1"/></inertial>\n<visual><xacro:insert_block name="o"/><geometry>'
        '<mesh filename="cube.stl"/></geometry></visual>\n</link>\n</xacro:macro>\n'
    )
    call = '<xacro:part><origin xyz="1 0 0"/></xacro:part>'
    path = xacro_file("r.xacro", macro + call)
    data = (FIXTURES / "meshes" / "cube.obj").read_bytes()
    Path("cube.stl").write_bytes((FIXTURES / "meshes" / "cube.stl").read_bytes())
    Path("cube.obj").write_bytes(data)
    text = Path(path).read_text().replace("cube.stl", "cube.obj")
    Path(path).write_text(text)
    done = fill(urdftool, path, "--all", code=1)
    assert "also used elsewhere" in done.err
    assert Path(path).read_text() == text


def test_an_included_file_is_edited_in_place_and_not_for_an_output(urdftool, xacro_file, write):
    write("package.xml", "<package><name>p</name></package>")
    write(
        "part.xacro",
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">\n  <link name="a">\n'
        '    <visual><geometry><box size="1 1 1"/></geometry></visual>\n  </link>\n</robot>\n',
    )
    path = xacro_file("r.xacro", '<xacro:include filename="part.xacro"/>')
    done = fill(urdftool, path, "--density", "6", "-o", "out.xacro", code=1)
    assert "part.xacro" in done.err
    fill(urdftool, path, "--density", "6")
    assert "    <inertial>\n      <origin" in Path("part.xacro").read_text()
    assert moments(library.load(path).link["a"]) == (1, 1, 1)


def test_a_file_of_another_package_is_not_edited(urdftool, xacro_file, write):
    write("other/package.xml", "<package><name>other</name></package>")
    write(
        "other/part.xacro",
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a">'
        '<visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>',
    )
    write("own/package.xml", "<package><name>own</name></package>")
    path = xacro_file("own/r.xacro", '<xacro:include filename="$(find other)/part.xacro"/>')
    done = fill(urdftool, path, "--density", "6", code=1)
    assert "outside of own" in done.err
    assert "<inertial>" not in Path("other/part.xacro").read_text()


def test_a_computed_moment_that_is_right_up_to_rounding_is_not_to_be_set(urdftool, xacro_file):
    inertia = '<inertia ixx="${3 - 2.2 + 0.2}" ixy="0" ixz="0" iyy="1" iyz="0" izz="${2*0.6}"/>'
    path = xacro_file(
        "r.xacro",
        f'<link name="a"><inertial><mass value="6"/>{inertia}</inertial>\n'
        '<visual><geometry><box size="1 1 1"/></geometry></visual></link>',
    )
    assert 3 - 2.2 + 0.2 != 1
    done = fill(urdftool, path, "--all", code=1)
    assert 'set izz="1"' in done.err
    assert "set ixx" not in done.err


def test_the_arm_with_a_copied_moment_is_mended(urdftool, tmp_path):
    folder = tmp_path / "ros2_arm"
    shutil.copytree(ROBOTS / "ros2_arm", folder)
    path = folder / "urdf" / "robot2_base_inertia.urdf.xacro"
    before = path.read_text()
    fill(urdftool, path, "--all", "--link", "base_link")
    removed, added = changes(before, path.read_text())
    assert len(removed) == 1
    assert 'ixx="106.667" ixy="0" ixz="0" iyy="106.667"' in added[-1]
    assert urdftool("inertia", "robot", path).code == 0


def test_a_file_that_changed_meanwhile_is_left(urdftool, write, monkeypatch):
    from urdftool.inertia import fill_check

    path = write("r.urdf", BARE)
    original = fill_check.check_filling

    def slow(*arguments):
        Path(path).write_text(BARE + "<!-- saved by an editor -->\n")
        return original(*arguments)

    monkeypatch.setattr(fill_check, "check_filling", slow)
    done = urdftool("inertia", "robot", path, "--write", "--density", "10")
    assert done.code == 2
    assert "was changed" in done.err
    assert "editor" in Path(path).read_text()


def test_a_damaged_edit_is_never_written(urdftool, write, monkeypatch):
    from urdftool.source import edit

    path = write("r.urdf", BARE)
    monkeypatch.setattr(edit, "apply", lambda file, edits: file.data.replace(b"sphere", b"box"))
    done = urdftool("inertia", "robot", path, "--write", "--density", "10")
    assert done.code == 2
    assert "is not written" in done.err
    assert Path(path).read_text() == BARE


def test_a_damaged_edit_of_an_included_file_is_never_written(
    urdftool, xacro_file, write, monkeypatch
):
    from urdftool.source import edit

    part = (
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">\n  <xacro:macro name="part">\n'
        '    <link name="a">\n      <visual><geometry><sphere radius="1"/></geometry></visual>\n'
        "    </link>\n  </xacro:macro>\n</robot>\n"
    )
    write("part.xacro", part)
    path = xacro_file("r.xacro", '<xacro:include filename="part.xacro"/><xacro:part/>')
    with monkeypatch.context() as patch:
        patch.setattr(edit, "apply", lambda file, edits: file.data.replace(b"sphere", b"ball"))
        done = urdftool("inertia", "robot", path, "--write", "--density", "10")
    assert done.code == 2
    assert "would change more than inertia" in done.err
    assert Path("part.xacro").read_text() == part
    fill(urdftool, path, "--density", "10")
    assert "      <inertial>\n        <origin" in Path("part.xacro").read_text()


def test_an_argument_that_serves_more_than_inertia_is_left(urdftool, xacro_file):
    macro = (
        '<xacro:macro name="part" params="name m">\n<link name="${name}">\n'
        '<inertial><mass value="${m}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
        '</inertial>\n<visual><geometry><box size="${m} 1 1"/></geometry></visual>\n</link>\n'
        "</xacro:macro>\n"
    )
    path = xacro_file("r.xacro", macro + '<xacro:part name="a" m="2"/>')
    before = Path(path).read_text()
    done = fill(urdftool, path, "--all", "--mass", "a=6", code=1)
    assert 'value="${m}" is computed' in done.err
    assert Path(path).read_text() == before


@pytest.mark.parametrize(
    ("moments", "reason"),
    [
        ((2e-4, 2e-4, 2e-4), "its center of mass or inertia does not fit into its geometry"),
        ((2e-5, 2e-5, 2e-4), "its inertial is physically inconsistent"),
        ((1, 1, 1), "its inertia is a placeholder"),
    ],
)
def test_the_reason_for_which_a_link_is_left_is_that_of_its_fault(urdftool, write, moments, reason):
    ixx, iyy, izz = moments
    tensor = f'<inertia ixx="{ixx}" ixy="0" ixz="0" iyy="{iyy}" iyz="0" izz="{izz}"/>'
    shape = '<collision><geometry><box size="0.02 0.02 0.1"/></geometry></collision>'
    text = f'<link name="a"><inertial><mass value="0.2"/>{tensor}</inertial>{shape}</link>'
    path = write("r.urdf", f'<robot name="r">{text}</robot>')
    done = fill(urdftool, path, code=1)
    assert f"link 'a' is left as it is: {reason}; --all recomputes it" in done.err
    assert "0 links written, 1 left" in done.err


XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="{}"/>'
LINK = '<link name="{}"><visual><geometry><mesh filename="{}"/></geometry></visual></link>'


@pytest.mark.parametrize("out", ["new/deep/out.xacro", "out.xacro"])
def test_relative_names_lead_to_the_same_files_from_the_output(urdftool, write, out):
    write("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    write("m.xacro", XACRO.partition("<xacro:include")[0] + "</robot>")
    path = write("r.xacro", XACRO.format("m.xacro") + LINK.format("a", "part.obj") + "</robot>")
    fill(urdftool, path, "--density", "10", "-o", out)
    up = "../../" if "/" in out else ""
    text = Path(out).read_text()
    assert f'<xacro:include filename="{up}m.xacro"/>' in text
    assert f'<mesh filename="{up}part.obj"/>' in text
    with_trust = urdftool("--trust", "info", out)
    assert with_trust.code == 0, with_trust.err


def test_a_relative_name_that_cannot_follow_the_output_is_refused(urdftool, write):
    write("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    write(
        "m.xacro", XACRO.partition("<xacro:include")[0] + LINK.format("a", "part.obj") + "</robot>"
    )
    path = write("r.xacro", XACRO.format("m.xacro") + "</robot>")
    done = urdftool("inertia", "robot", path, "--write", "--density", "10", "-o", "new/r.xacro")
    assert done.code == 2
    assert "m.xacro:1:" in done.err
    assert "'part.obj' is relative to r.xacro, but is computed or written in an incl" in done.err
    assert not Path("new").exists()


SCALED = """<robot name="r">
  <link name="big"><collision><geometry><mesh filename="big.stl"/></geometry></collision></link>
  <link name="neg"><inertial><mass value="-1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0"
    izz="1"/></inertial><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="frame"/>
  <joint name="j" type="fixed"><parent link="big"/><child link="neg"/></joint>
  <joint name="k" type="fixed"><parent link="big"/><child link="frame"/></joint>
</robot>"""


@pytest.fixture
def scaled(write, tmp_path):
    import trimesh

    trimesh.creation.box((300, 200, 100)).export(tmp_path / "big.stl")
    return write("r.urdf", SCALED)


@pytest.mark.parametrize("option", ["--diff", "--write", "--lump"])
def test_what_is_known_of_the_geometry_is_said(urdftool, scaled, option):
    done = urdftool("inertia", "robot", scaled, option, "--density", "1000")
    assert "link 'big': The mesh is 300 m long" in done.err
    assert "counts as written" not in done.err
    assert ("'neg' counts with the mass properties of its geometry" in done.err) == (
        option == "--lump"
    )


@pytest.mark.parametrize("words", [(), ("--all",)])
def test_a_frame_that_is_given_a_mass_has_no_geometry(urdftool, scaled, words):
    done = urdftool("inertia", "robot", scaled, "--diff", "--mass", "frame=1", *words)
    assert "link 'frame' is left as it is: it has no geometry" in done.err
