"""Names that are escapes, markup, lines or commands are said as text, and nothing else of them."""

import json
from html import escape
from xml.etree import ElementTree

import pytest

pytest.importorskip("pybullet")

NAMES = {
    "ansi": "\u009b31mred\u202egnp",
    "html": '<script>alert("1")</script>',
    "lines": "a\nerror: all is well\rb",
    "shell": "$(touch owned); `touch owned` | touch owned",
    "format": "{0} %s %n [bold]x[/bold]",
}


def robot(name):
    """One that stands and one of whose links weighs nothing, both called so."""
    said = escape(name).replace("\n", "&#10;").replace("\r", "&#13;")
    tensor = '<inertia ixx="0.00167" iyy="0.00167" izz="0.00167" ixy="0" ixz="0" iyz="0"/>'
    box = '<geometry><box size=".1 .1 .1"/></geometry>'
    return (
        f'<robot name="{said}"><link name="{said}"><inertial><mass value="1"/>{tensor}</inertial>'
        f'<visual>{box}</visual><collision>{box}</collision></link><link name="b {said}">'
        f'<visual>{box}</visual><collision>{box}</collision></link><joint name="{said}" '
        f'type="continuous"><parent link="{said}"/><child link="b {said}"/>'
        '<origin xyz="0 0 .3"/><axis xyz="0 0 1"/></joint></robot>'
    )


def is_clean(text):
    """Whether a terminal shows a text as it is: each line one of ours, no control characters."""
    controls = {*map(chr, range(32)), *map(chr, range(127, 160)), "\u202e"} - {"\n"}
    return not controls & set(text) and not any(
        line.startswith(("error: all is well", "b", "31m")) for line in text.splitlines()
    )


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, id=kind, marks=[] if kind == "ansi" else pytest.mark.slow)
        for kind, name in NAMES.items()
    ],
)
def test_names_are_only_names(urdftool, write, tmp_path, monkeypatch, name):
    path = write("r.urdf", robot(name))
    monkeypatch.chdir(tmp_path)
    quick = ("--duration", "0.05")
    plain = urdftool(
        *("simulate", path, *quick, "--plot", "p.png", "--picture", "q.png", "--junit", "j.xml")
    )
    assert plain.code == 1, plain.err
    assert is_clean(plain.out), plain.out
    assert is_clean(plain.err), plain.err
    for drawn in ("p.png", "q.png"):
        assert (tmp_path / drawn).read_bytes().startswith(b"\x89PNG")
    case = ElementTree.parse(tmp_path / "j.xml").getroot().find(".//testcase")
    assert case is not None
    assert not list(case.iter("script"))
    said = json.loads(urdftool("simulate", path, *quick, "--format", "json").out)
    assert said["name"] == name.strip() or said["name"] == name
    many = urdftool("simulate", "--fleet", "-j", "1", path, *quick)
    assert is_clean(many.out), many.out
    assert not (tmp_path / "owned").exists()
