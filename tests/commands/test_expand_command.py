import json
import os
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest

from tests.conftest import ROOT, XACRO
from urdftool.report.expansion import make_rule

ARM = """<xacro:arg name="prefix" default=""/>
<xacro:include filename="macros.xacro"/>
<xacro:arm_link name="$(arg prefix)base"/>"""
MACROS = '<xacro:macro name="arm_link" params="name">\n  <link name="${name}"/>\n</xacro:macro>'


@pytest.fixture
def arm(xacro_file):
    xacro_file("macros.xacro", MACROS)
    return xacro_file("arm.urdf.xacro", ARM)


def test_to_stdout(urdftool, arm):
    result = urdftool("expand", arm, "prefix:=left_")
    assert result.code == 0
    assert '<link name="left_base"/>' in result.out
    assert result.err == ""


def test_to_a_file(urdftool, arm, tmp_path):
    assert urdftool("expand", arm, "-o", "arm.urdf").code == 0
    assert '<link name="base"/>' in (tmp_path / "arm.urdf").read_text()
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "arm.urdf",
        "arm.urdf.xacro",
        "macros.xacro",
    ]


def test_from_standard_input(arm):
    done = subprocess.run(
        [sys.executable, "-m", "urdftool", "expand", "-"],
        input=Path(arm).read_text(),
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0
    assert '<link name="base"/>' in done.stdout


def test_deps(urdftool, arm):
    assert urdftool("expand", arm, "--deps").out == "arm.urdf.xacro\nmacros.xacro\n"


def test_depfile_is_a_rule_that_make_understands(urdftool, arm, write, tmp_path):
    write("Makefile", "arm.urdf: ; @echo made\n-include arm.d\n")
    assert urdftool("expand", arm, "-o", "arm.urdf", "--depfile", "arm.d").code == 0
    make = ["make", "-s"]
    assert subprocess.run(make, capture_output=True, text=True).stdout == ""
    future = (tmp_path / "arm.urdf").stat().st_mtime + 10

    os.utime("macros.xacro", (future, future))
    assert subprocess.run(make, capture_output=True, text=True).stdout == "made\n"


def test_depfile_escapes_what_make_would_read(urdftool, xacro_file, tmp_path):
    path = xacro_file("my robot $1 #2.xacro", "<link name='a'/>")
    urdftool("expand", path, "-o", "out.urdf", "--depfile", "out.d")
    assert (tmp_path / "out.d").read_text() == r"out.urdf: my\ robot\ $$1\ \#2.xacro" + "\n"


NAMES = [
    "a=b",
    "a%b",
    "a&",
    "a:b",
    "a:",
    "a?b",
    "a*",
    "a[x]b",
    "a'b",
    "a~",
    "a$(b)",
    "`a`",
    "#",
    "<a>",
]


def test_make_sees_a_change_of_each_file_that_a_rule_can_name(write, tmp_path):
    for name in ["r", *NAMES, "axb"]:  # make may take the last for a?b and a[x]b too
        write(name, "")
        os.utime(name, (1000, 1000))
    write("o.urdf", "")
    write("o.d", make_rule("o.urdf", ["a=b", "r", *NAMES[1:]]))
    write("Makefile", "o.urdf: ; @echo made\n-include o.d\n")
    made, future = [], (tmp_path / "o.urdf").stat().st_mtime + 10
    for name in ["r", *NAMES]:
        os.utime(name, (future, future))
        done = subprocess.run(["make", "-s"], capture_output=True, text=True)
        os.utime(name, (1000, 1000))
        if done.stdout == "made\n":
            made.append(name)
    assert made == ["r", *NAMES]


def test_what_a_make_rule_cannot_name_is_a_warning(urdftool, xacro_file):
    xacro_file("a;b.xacro", "<link name='a'/>")
    path = xacro_file("r.xacro", '<xacro:include filename="a;b.xacro"/>')
    done = urdftool("expand", path, "-o", "o.urdf", "--depfile", "o.d")
    assert done.code == 0
    assert "o.d: warning: a make rule cannot name 'a;b.xacro'" in done.err
    refused = urdftool("expand", path, "-o", "o;id.urdf", "--depfile", "o.d")
    assert refused.code == 2
    assert "cannot begin with the name 'o;id.urdf'" in refused.err


def test_list_args(urdftool, arm):
    assert urdftool("expand", arm, "--list-args").out == "prefix:=\n"


def test_check_tells_stale_from_fresh(urdftool, arm, tmp_path, write):
    urdftool("expand", arm, "-o", "arm.urdf")
    assert urdftool("expand", arm, "--check", "arm.urdf").code == 0
    text = (tmp_path / "arm.urdf").read_text()
    write("arm.urdf", text.replace("<!--", "<!-- other comment -->\n<!--", 1).replace("  ", "\t"))
    assert urdftool("expand", arm, "--check", "arm.urdf").code == 0
    stale = urdftool("expand", arm, "prefix:=left_", "--check", "arm.urdf")
    assert stale.code == 1
    assert '-  <link name="base"/>' in stale.out
    assert '+  <link name="left_base"/>' in stale.out
    assert urdftool("expand", arm, "--check", "absent.urdf").code == 2


def test_check_compares_blanks_within_a_text(urdftool, write, tmp_path):
    robot = '<robot name="r"><link name="a"/><gazebo><t> a  b </t></gazebo></robot>'
    path = write("r.urdf.xacro", robot)
    write("same.urdf", robot.replace(" a  b ", "\n a  b\n"))
    write("other.urdf", robot.replace("a  b", "a b"))
    assert urdftool("expand", path, "--check", "same.urdf").code == 0
    assert urdftool("expand", path, "--check", "other.urdf").code == 1


def test_source_map(urdftool, arm):
    table = json.loads(urdftool("expand", arm, "--source-map", "-").out)
    schema = json.loads((ROOT / "docs" / "schemas" / "source-map.json").read_text())
    jsonschema.validate(table, schema)
    link = table["elements"][1]
    assert link["xpath"] == "/robot/link[1]"
    assert (link["path"], link["line"], link["column"]) == ("macros.xacro", 3, 3)
    assert link["expansion"] == [
        {
            "path": "arm.urdf.xacro",
            "line": 4,
            "column": 1,
            "macro": "arm_link",
            "arguments": {"name": "base"},
        }
    ]


def test_an_unknown_argument_is_warned_of(urdftool, arm):
    result = urdftool("expand", arm, "prefx:=left_")
    assert result.code == 0
    assert "did you mean 'prefix'?" in result.err
    assert urdftool("-q", "expand", arm, "prefx:=left_").err == ""


def test_an_input_is_never_overwritten(urdftool, arm, tmp_path):
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    for option in ("-o", "--source-map"):
        for target in ("arm.urdf.xacro", "macros.xacro", "./macros.xacro"):
            result = urdftool("expand", arm, option, target)
            assert result.code == 2
            assert "is an input" in result.err
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_nothing_is_half_written(urdftool, xacro_file, write, tmp_path):
    write("out.urdf", "old")
    bad = xacro_file("bad.xacro", '<link name="${nope}"/>')
    result = urdftool("expand", bad, "-o", "out.urdf")
    assert result.code == 2
    assert result.err.startswith("bad.xacro:2:7: 'nope' is not defined")
    assert (tmp_path / "out.urdf").read_text() == "old"
    assert urdftool("expand", bad, "-o", "no/such/folder.urdf").code == 2


def test_mode_and_links_of_an_output_are_kept(urdftool, arm, tmp_path):
    (tmp_path / "real.urdf").write_text("old")
    (tmp_path / "real.urdf").chmod(0o640)
    (tmp_path / "link.urdf").symlink_to("real.urdf")
    assert urdftool("expand", arm, "-o", "link.urdf").code == 0
    assert (tmp_path / "link.urdf").is_symlink()
    assert "<link" in (tmp_path / "real.urdf").read_text()
    assert (tmp_path / "real.urdf").stat().st_mode & 0o777 == 0o640


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "IN"),
        (["a.xacro", "b.xacro"], "a.xacro b.xacro"),
        (["a.xacro", ":=1"], "has no name"),
        (["a.xacro", "--depfile", "x.d"], "-o OUT"),
        (["a.xacro", "--deps", "--list-args"], "exclude each other"),
        (["a.xacro", "-p", "name"], "NAME=DIR"),
        (["a.xacro", "-p", "name=/no/such"], "/no/such"),
        (["absent.xacro"], "absent.xacro: no such file"),
    ],
)
def test_a_wrong_call_says_what_is_right(urdftool, words, message):
    result = urdftool("expand", *words)
    assert result.code == 2
    assert message in result.err
    assert "Traceback" not in result.err


def test_packages_are_found_as_told(urdftool, write, xacro_file, tmp_path):
    write("elsewhere/macros.xacro", XACRO.format(MACROS))
    inside = '<xacro:include filename="$(find my_macros)/macros.xacro"/><xacro:arm_link name="a"/>'
    path = xacro_file("ws/arm.xacro", inside)
    assert urdftool("expand", path).code == 2
    assert urdftool("expand", path, "-p", "my_macros=elsewhere").code == 0
    toml = write("ws/urdftool.toml", '[packages]\nmy_macros = "../elsewhere"\n')
    assert "ws/urdftool.toml:2" in urdftool("expand", path).err  # it may have come with the file
    assert urdftool("--config", toml, "expand", path).code == 0
    write("urdftool.toml", '[packages]\nmy_macros = "elsewhere"\n')
    (tmp_path / "ws" / "urdftool.toml").unlink()
    assert urdftool("expand", path).code == 0  # below the configuration
    write("other.toml", "[packages]\n")
    assert urdftool("--config", "other.toml", "expand", path).code == 2
