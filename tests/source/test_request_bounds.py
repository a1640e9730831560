"""What a description asks of the process that reads files: bounds of each request."""

import pytest

from urdftool import expand
from urdftool.errors import XacroError
from urdftool.report.expansion import list_not_in_rule, make_rule
from urdftool.source.packages import Packages
from urdftool.suggestions import find_nearest

XACRO = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r"><link name="a"/>{}</robot>'


@pytest.fixture
def write(tmp_path):
    def write(body):
        (tmp_path / "a.xacro").write_text(XACRO.format(body))
        return tmp_path / "a.xacro"

    return write


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ('<xacro:include filename="*/../../secret/*"/>', "after a wildcard"),
        ('<xacro:include filename="*/*/*/*/*/*/*/*/*.xacro"/>', "after a wildcard"),
        ("<xacro:include filename=\"${'x' * 9000}*\"/>", "longer than 4096"),
        ("<b c=\"${xacro.load_yaml('a/' * 100000)}\"/>", "longer than 4096"),
        (
            "<b c=\"${len([xacro.message('x' * 100) for i in python.range(99000)])}\"/>",
            "messages of the description exceed",
        ),
    ],
)
def test_a_request_has_bounds(write, body, message):
    with pytest.raises(XacroError, match=message) as caught:
        expand(write(body))
    assert caught.value.line == 1


def test_many_encodings_do_not_start_the_expansion_again_for_ever(write, tmp_path):
    body = ""
    for number in range(2, 10):
        text = f'<?xml version="1.0" encoding="iso8859-{number}"?><robot name="r"/>'
        (tmp_path / f"e{number}.xacro").write_text(text)
        body += f'<xacro:include filename="e{number}.xacro"/>'
    with pytest.raises(XacroError, match="different encodings"):
        expand(write(body))


def test_a_file_that_is_not_there_is_not_a_dependency(write, tmp_path, urdftool, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = write('<xacro:include filename="no.xacro" optional="true"/>')
    done = urdftool("expand", str(path), "-o", "o.urdf", "--depfile", "o.d")
    assert done.code == 0, done.err
    with open("o.d") as stream:
        assert "no.xacro" not in stream.read()


@pytest.mark.parametrize("name", ["a\nX!=id", "a;id", "a|b", "a\\", "~a", "a\\#b"])
def test_a_rule_names_no_file_that_make_would_interpret(name):
    assert make_rule("o.urdf", ["r.xacro", name]) == "o.urdf: r.xacro\n"
    assert list_not_in_rule(["r.xacro", name]) == [name]


def test_values_of_cmake_do_not_grow_without_end(tmp_path):
    lines = [
        "set(A aaaaaaaaaaaaaaaa)",
        *['set(A "${A}${A}")'] * 40,
        "install(FILES ${A} DESTINATION x)",
    ]
    (tmp_path / "CMakeLists.txt").write_text("\n".join(lines))
    (tmp_path / "package.xml").write_text("<package><name>p</name>" + "<!--" * 60_000)
    packages = Packages(tmp_path / "r.urdf")
    assert packages.find("p") == tmp_path
    assert packages.find_installed(tmp_path / "no.xacro") == tmp_path / "no.xacro"


def test_numbers_of_names_may_be_long():
    assert find_nearest("j" + "1" * 5000, ["j1"]) == ""
