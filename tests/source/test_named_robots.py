"""Robots by name, from stand-ins of the packages that download them."""

import json
import sys

import pytest

from tests.conftest import FIXTURES
from urdftool.errors import MissingDependency, SourceError
from urdftool.source.named_robots import find_named_robot

ARM = FIXTURES / "formats" / "mjcf" / "arm.urdf"
OTHER = ARM.with_name("rover.urdf")

MENAGERIE = """
class Robot:
    default_model = "m"
    def xml(self, entry=None):
        assert entry == "m"
        print("downloading")
        return {path!r}

def names():
    return ["vendor_arm"]

def get(name):
    return Robot()
"""


@pytest.fixture
def packages(tmp_path, monkeypatch):
    """Install stand-ins, and remove them from the loaded modules afterwards."""
    folder = tmp_path / "site"
    descriptions = folder / "robot_descriptions"
    descriptions.mkdir(parents=True)
    (descriptions / "__init__.py").write_text("")
    (descriptions / "arm_description.py").write_text(
        f"print('cloning')\nURDF_PATH = {str(ARM)!r}\n"
    )
    (descriptions / "lost_description.py").write_text("raise OSError('no network')\n")
    menagerie = folder / "mujoco_menagerie"
    menagerie.mkdir()
    path = str(ARM.with_suffix(".xml"))
    (menagerie / "__init__.py").write_text(MENAGERIE.format(path=path))
    monkeypatch.syspath_prepend(str(folder))
    loaded = set(sys.modules)
    yield
    for name in set(sys.modules) - loaded:
        if name.startswith(("robot_descriptions", "mujoco_menagerie")):
            del sys.modules[name]


def test_a_name_becomes_a_path(packages, capsys):
    assert find_named_robot("arm") == find_named_robot("arm_description") == str(ARM)
    assert find_named_robot("vendor_arm") == str(ARM.with_suffix(".xml"))
    said = capsys.readouterr()
    assert said.out == ""
    assert "cloning" in said.err
    assert "downloading" in said.err


def test_what_cannot_be_found_or_fetched_is_one_message(packages):
    with pytest.raises(SourceError, match="have no robot 'vendor_arn'; did you mean 'vendor_arm'"):
        find_named_robot("vendor_arn")
    with pytest.raises(SourceError, match=r"robot 'lost' of robot_descriptions.*no network"):
        find_named_robot("lost")


def test_without_the_packages_the_extra_is_named(monkeypatch):
    monkeypatch.setattr("urdftool.source.named_robots.is_installed", lambda name: False)
    with pytest.raises(MissingDependency, match=r"pip install 'urdftool\[robots\]'"):
        find_named_robot("arm")


def test_commands_take_a_name_instead_of_a_file(packages, urdftool, tmp_path):
    assert '"name"' in urdftool("info", "-r", "arm", "--format", "json").out
    assert "shoulder" in urdftool("graph", "-r", "arm", "-o", "-").out
    assert urdftool("export", "sdf", "-r", "arm", "-o", tmp_path / "a.sdf").code == 0
    both = urdftool("info", "-r", "arm", ARM)
    assert (both.code, "2 files are given" in both.err) == (2, True)
    assert urdftool("info").code == 2


def test_names_keep_their_place_among_files(packages, urdftool):
    """The order of two robots counts, and xacro arguments belong to the robot before them."""
    changes = [
        urdftool("diff", *words, "--format", "json").out
        for words in (("-r", "arm", OTHER), ("-rarm", OTHER), (ARM, OTHER))
    ]
    assert changes[0] == changes[1] == changes[2] != ""
    reverse = json.loads(urdftool("diff", OTHER, "-r", "arm", "--format", "json").out)
    assert (reverse["before"], reverse["after"]) == (str(OTHER), str(ARM))


COMMANDS = [
    ("lint", "--format", "concise"),
    ("collision", "--check"),
    ("export", "urdf"),
    ("export", "mjcf"),
    ("graph", "-o", "-"),
    ("inertia", "robot"),
    ("info",),
    ("expand",),
]


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: " ".join(words[:2]))
def test_every_command_does_the_same_by_name(packages, urdftool, words):
    by_name, by_path = urdftool(*words, "-r", "arm"), urdftool(*words, ARM)
    assert (by_name.code, by_name.out) == (by_path.code, by_path.out)
    assert by_name.out or by_name.err.removeprefix("cloning\n") == by_path.err


def test_verify_takes_names(packages, urdftool):
    assert urdftool("verify", "-r", "arm", "-r", "arm").code == 0
    one = urdftool("verify", "-r", "arm")
    assert (one.code, "1 file is given" in one.err) == (2, True)


def test_a_name_is_required(urdftool):
    assert "requires an argument" in urdftool("lint", "-r").err
    assert urdftool("lint", "--help", "-r", "nothing").code == 0
