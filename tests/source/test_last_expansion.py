"""An expansion that begins with what the last one requested is equal to one that does not."""

import sys

import pytest

from urdftool.errors import SourceError
from urdftool.source import expansion_requests
from urdftool.source.document import read_file
from urdftool.source.expand import expand_xacro
from urdftool.source.packages import Packages
from urdftool.workspace import Workspace

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
MAIN = f"""<robot {XACRO} name="r">
<xacro:include filename="a.xacro"/>
<xacro:include filename="b.xacro"/>
<xacro:include filename="a.xacro"/>
<xacro:wheel name="left" radius="${{size * 2}}"/><link name="end"/>
</robot>
"""
A = f"""<robot {XACRO}><xacro:property name="size" value="0.5"/></robot>"""
B = f"""<robot {XACRO}><!-- parts --><xacro:macro name="wheel" params="name radius">
<link name="${{name}}_wheel" size="${{radius + 1}}"/></xacro:macro></robot>"""
FORKS = pytest.mark.skipif(sys.platform != "linux", reason="the process is a fork on Linux")


@pytest.fixture
def folder(tmp_path):
    for name, text in (("main.xacro", MAIN), ("a.xacro", A), ("b.xacro", B)):
        (tmp_path / name).write_text(text)
    return tmp_path


def expand_with(base, folder, changes, arguments=None):
    """Expand the robot with other contents of some files, in a view of a workspace."""
    overlay = {str(folder / name): text.encode() for name, text in changes.items()}
    workspace = base.get_with_overlay(overlay)
    path = str(folder / "main.xacro")
    return expand_xacro(
        read_file(path, workspace), arguments or {}, Packages(path, workspace=workspace)
    )


def list_facts(expansion):
    """Return all that is known of an expansion, with the place and the calls of each element."""
    root = expansion.make_document().root
    return (
        expansion.text,
        [
            (str(e.place), [(str(c.file.path), c.line, c.what) for c in e.calls])
            for e in root.walk()
        ],
        list(expansion.files),
        expansion.dependencies,
    )


CHANGES = {
    "nothing": {},
    "a number": {"main.xacro": MAIN.replace("* 2", "* 3")},
    "no include": {
        "main.xacro": MAIN.replace('<xacro:include filename="b.xacro"/>', "").replace(
            '<xacro:wheel name="left" radius="${size * 2}"/>', ""
        )
    },
    "the order": {
        "main.xacro": MAIN.replace('"a.xacro"', '"x"', 1)
        .replace('"b.xacro"', '"a.xacro"')
        .replace('"x"', '"b.xacro"')
    },
    "an included file": {"b.xacro": B.replace("radius + 1", "radius + 2")},
    "a file that is included once more": {"a.xacro": A.replace("0.5", "${1 / 4}")},
}


@pytest.mark.parametrize("name", CHANGES)
def test_an_expansion_after_another_is_as_the_first(folder, name):
    base = Workspace()
    for before in ({}, {"main.xacro": MAIN.replace("end", "last")}):
        expand_with(base, folder, before)
    again = expand_with(base, folder, CHANGES[name])
    assert list_facts(again) == list_facts(expand_with(Workspace(), folder, CHANGES[name]))


@FORKS
def test_what_is_known_is_not_requested_again(folder, monkeypatch):
    base = Workspace()
    expand_with(base, folder, {})

    def refuse(self, *words):
        raise AssertionError(words)

    monkeypatch.setattr(expansion_requests.RequestedFiles, "_request", refuse)
    changes = {"main.xacro": MAIN.replace('name="end"', 'name="last"')}
    assert 'name="last"' in expand_with(base, folder, changes).text


def test_a_file_that_vanished_is_reported(folder):
    base = Workspace()
    expand_with(base, folder, {})
    (folder / "b.xacro").unlink()
    with pytest.raises(SourceError, match=r"b\.xacro") as known:
        expand_with(base, folder, {})
    with pytest.raises(SourceError) as first:
        expand_with(Workspace(), folder, {})
    assert str(known.value) == str(first.value)


def test_an_included_file_is_read_again_after_it_changed_on_the_disk(folder):
    base = Workspace()
    expand_with(base, folder, {})
    (folder / "a.xacro").write_text(A.replace("0.5", "0.25"))
    assert 'size="1.5"' in expand_with(base, folder, {}).text


@pytest.mark.parametrize("text", ["<robot>", B.replace("+ 1", "+")])
def test_a_defect_of_an_included_file_is_reported_as_by_the_first(folder, text):
    check_defect(Workspace(), folder, text)


def check_defect(base, folder, text):
    """Check that a defect of an included file is reported as by a first expansion."""
    errors = []
    expand_with(base, folder, {})
    for workspace in (base, Workspace()):
        with pytest.raises(SourceError) as error:
            expand_with(workspace, folder, {"b.xacro": text})
        errors.append((str(error.value), error.value.path, error.value.line, error.value.column))
    assert errors[0] == errors[1]
    assert errors[0][1].endswith("b.xacro")


def test_arguments_have_their_own_expansion(folder):
    base = Workspace()
    main = MAIN.replace("<link", '<xacro:arg name="n" default="1"/><link n="$(arg n)"')
    for value in ("1", "2", "1"):
        text = expand_with(base, folder, {"main.xacro": main}, {"n": value}).text
        assert f'n="{value}"' in text
