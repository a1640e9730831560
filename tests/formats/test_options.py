"""Options of exports: declared once, for the command line and for Python."""

import inspect
import math
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

import urdftool as api
from tests.build import robot
from urdftool.errors import ConfigError
from urdftool.formats.common.option import get_default, list_options
from urdftool.source.description_formats import NAMES as FORMATS

OF_COMMANDS = {
    *("robot", "named", "output", "package", "package_path", "gltf_up"),
    *("overwrite", "strict", "verified", "style"),
    *("debug", "quiet", "verbose", "trust"),  # of every command
    *("jobs", "scheduler"),  # of several robots
    *("isaaclab", "isaaclab_version"),  # a configuration of Isaac Lab, beside the stage
}
OF_FUNCTIONS = {
    *("robot", "output", "verify", "overwrite"),
    "state",  # --pose NAME
}
CHANGED = {("urdf", "frames"): "keep"}
"""Words on the command line, True or False in Python: the default."""


def options_of(name):
    return import_module(f"urdftool.formats.{name}.options").Options


def declared(name):
    return {one.name: (one, option) for one, option in list_options(options_of(name))}


def parameters_of(name):
    return inspect.signature(getattr(api, f"export_{name}")).parameters


def command_of(name):
    return import_module(f"urdftool.commands.export_{name}").command


@pytest.mark.parametrize("name", FORMATS)
def test_python_has_the_options_of_the_command_line(name):
    in_python = set(parameters_of(name)) - OF_FUNCTIONS
    if name == "urdf":
        in_python.remove("srdf")  # the command writes one with each file
    in_command = {one.name for one in command_of(name).params} - OF_COMMANDS
    assert in_python == in_command == set(declared(name))
    assert "force" in in_python


@pytest.mark.parametrize("name", FORMATS)
def test_defaults_and_words_are_the_same(name):
    in_python = parameters_of(name)
    in_command = {one.name: one for one in command_of(name).params}
    for key, (one, option) in declared(name).items():
        default = get_default(one, option)
        assert in_python[key].default == default, key
        shown = in_command[key].to_info_dict()
        wanted = CHANGED.get((name, key), default)
        assert (shown["default"] or None) == (wanted or None), key
        if option.words:
            assert tuple(shown["type"]["choices"]) == option.words, key
            assert key == "version" or in_python[key].annotation == one.type, key


WRONG = [
    (name, key, "flying", option.words)
    for name in FORMATS
    for key, (_, option) in declared(name).items()
    if option.words
]


@pytest.mark.parametrize(("name", "key", "value", "words"), WRONG)
def test_python_refuses_other_words(name, key, value, words):
    with pytest.raises(ConfigError) as caught:
        getattr(api, f"export_{name}")(robot(), **{key: value})
    assert f"{key} is 'flying', which is not one of {', '.join(words)}" == str(caught.value)


@pytest.mark.parametrize(
    ("name", "choices", "message"),
    [
        ("sdf", {"target": "gazebo"}, "which is not one of gz, gazebo-classic"),
        ("sdf", {"fixed_joints": "lumped"}, "keep, lump; did you mean 'lump'?"),
        ("mjcf", {"base": "Free"}, "auto, fixed, free; did you mean 'free'?"),
        ("mjcf", {"base": ["free"]}, "base is ['free'], which is not one of"),
        ("mjcf", {"armature": -1}, "armature is -1, which is not a finite number of at least 0"),
        ("mjcf", {"armature": math.nan}, "armature is nan, which is not a finite number"),
        ("mjcf", {"armature": "0.1"}, "armature is '0.1', which is not a finite number"),
        ("mjcf", {"fuse": "no"}, "fuse is 'no', which is not True or False"),
        ("mjcf", {"mesh_dir": "../meshes"}, "which is not a folder relative to the model"),
        ("urdf", {"mesh_dir": "/tmp"}, "which is not a folder relative to the model"),
        ("sdf", {"version": "1.7"}, "'gz' does not read SDF 1.7; it reads 1.9"),
    ],
)
def test_python_refuses_other_values(name, choices, message):
    with pytest.raises(ConfigError) as caught:
        getattr(api, f"export_{name}")(robot(), **choices)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("sdf", "--sdf-version", "1.7"), "'gz' does not read SDF 1.7; it reads 1.9"),
        (("sdf", "--mesh-dir", "../x"), "not a folder relative to the model, such as meshes"),
        (("mjcf", "--armature", "nan"), "'nan' is not a finite number"),
        (("mjcf", "--base", "flying"), "'flying' is not one of 'auto', 'fixed', 'free'"),
    ],
)
def test_the_command_refuses_the_same(urdftool, write, words, message):
    write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    done = urdftool("export", words[0], "r.urdf", *words[1:])
    assert (done.code, done.out) == (2, "")
    assert message in " ".join(done.err.split())


@pytest.mark.skipif(not find_spec("pxr"), reason="writes a stage")
def test_paths_may_be_text(tmp_path):
    config = tmp_path / "a.toml"
    config.write_text("")
    for path in (config, str(config)):
        assert api.export_usd(robot(), actuator_config=path).files
        assert Path(config).exists()
