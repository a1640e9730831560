"""Every function of Python refuses arguments of another kind, as the command line does."""

import inspect
import re

import pytest

import urdftool as api
from tests.build import robot
from urdftool.api import edit, scene
from urdftool.arguments import _KINDS, _split, require_kind
from urdftool.collision import settings as collision
from urdftool.commands import collision as collision_command
from urdftool.errors import ConfigError
from urdftool.simulation.settings import Settings

FUNCTIONS = {
    **{name: one for name in api.__all__ if inspect.isfunction(one := getattr(api, name))},
    **{
        name: one
        for name, one in vars(edit).items()
        if inspect.isfunction(one) and one.__module__ == edit.__name__ and name[0] != "_"
    },
    "to_scene": scene.to_scene,
}
WRONG = {
    "bool": "no",
    "float": "x",
    "int": 1.5,
    "Mapping": "x",
    "Iterable": "x",
    "Sequence": "x",
    "Paths": "x",
    "Vector": 1.0,
    "tuple": 1.0,
    "str": 3,
    "Path": 3,
}


GIVEN = {
    **dict.fromkeys(("robot", "one", "other"), robot()),
    "path": "r.urdf",
    "output": "out.urdf",
    "link": "a",
    "text": "left_",
    "positions": {"j": 0.0},
    "joints": ["j"],
    "links": ["a"],
}
"""Values of arguments that a function requires."""


def kinds_of(parameter):
    words = [word.partition("[")[0].strip() for word in _split(parameter.annotation)]
    return [word for word in words if word != "None"]


CASES = [
    (name, parameter.name, WRONG[kinds[0]])
    for name, function in FUNCTIONS.items()
    for parameter in inspect.signature(function).parameters.values()
    if parameter.kind is parameter.KEYWORD_ONLY
    and (kinds := kinds_of(parameter))
    and all(kind in _KINDS for kind in kinds)
]


def call(function, **choices):
    needed = {
        one.name: robot().links[0] if one.annotation == "Link" else GIVEN[one.name]
        for one in inspect.signature(function).parameters.values()
        if one.default is one.empty and one.kind is one.POSITIONAL_OR_KEYWORD
    }
    return function(**needed, **choices)


@pytest.mark.parametrize(("name", "option", "value"), CASES)
def test_arguments_of_another_kind_are_refused(name, option, value):
    message = f"{option} is {value!r}, which is not "
    with pytest.raises(ConfigError, match=re.escape(message)):
        call(FUNCTIONS[name], **{option: value})


def test_every_option_is_checked():
    """Options that are not checked by their kind are words, settings or robots."""
    checked = {(name, option) for name, option, _ in CASES}
    left = {
        parameter.annotation
        for name, function in FUNCTIONS.items()
        for parameter in inspect.signature(function).parameters.values()
        if parameter.kind is parameter.KEYWORD_ONLY and (name, parameter.name) not in checked
    }
    words = {"Target", "Base", "Layers", "Actuators", "Approximation", "Exclude", "FixInertia"}
    words |= {"FixedJoints", "Uri", "ChosenBase", "Purpose", "GltfUp", "GltfUp | None"}
    assert left <= words | {"Settings | None"}
    assert len(CASES) > 80


@pytest.mark.parametrize(
    ("annotation", "allowed", "message"),
    [
        ("bool", [True, False], "which is not True or False"),
        ("bool | None", [None, True], "which is not True or False"),
        ("str | Path | None", ["a", None], "which is not text or a path"),
        ("Mapping[str, str | Path] | None", [{}, None], "which is not a dict of values by name"),
        ("Iterable[str] | None", [[], (), {"a"}, None], "which is not a list"),
        ("float | None", [1, 0.5, None], "which is not a finite number"),
        ("Vector", [(0, 0.5, 1), [1, 2, 3]], "which is not three finite numbers"),
    ],
)
def test_kinds(annotation, allowed, message):
    for value in allowed:
        require_kind("x", value, annotation)
    with pytest.raises(ConfigError, match=message):
        require_kind("x", object(), annotation)
    require_kind("x", object(), f"Style | {annotation}")


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), "0.5", True])
def test_numbers_are_finite(bad):
    for annotation, value in (("float", bad), ("Vector", (0, 0, bad)), ("Vector", (0, 0))):
        with pytest.raises(ConfigError, match="finite number"):
            require_kind("x", value, annotation)


@pytest.mark.parametrize("name", ["pose", "payloads", "fixed_base", "seed", "sweep", "start_rpy"])
def test_settings_of_a_simulation(name):
    with pytest.raises(ConfigError, match=f"{name} is 'flying', which is not"):
        Settings(**{name: "flying"})


@pytest.mark.parametrize("function", [api.simulate, api.simplify_collisions])
def test_settings_are_settings(function, tmp_path):
    words = () if function is api.simulate else (tmp_path / "out.urdf",)
    with pytest.raises(ConfigError, match="which is not a urdftool"):
        function(robot(), *words, settings={"duration": 2})


def choices_of(command, name):
    (option,) = [one for one in command.params if one.name == name]
    return tuple(option.to_info_dict()["type"]["choices"])


@pytest.mark.parametrize(
    ("command", "option", "words"),
    [
        (collision_command.command, "method", collision.METHODS),
        (collision_command.command, "quality", tuple(collision.QUALITIES)),
        (collision_command.command, "uri", collision.URIS),
        (collision_command.command, "mesh_format", collision.MESH_FORMATS),
        (collision_command.command, "source", collision.SOURCES),
    ],
)
def test_words_of_the_command_line_are_those_of_python(command, option, words):
    assert choices_of(command, option) == words


def test_several_robots_are_not_taken_for_options():
    two = robot(links=["a"]), robot(links=["a"])
    assert api.verify(*two).is_equal
    with pytest.raises(ConfigError, match="only is 3, which is not a list"):
        api.verify(*two, only=3)


@pytest.mark.parametrize("name", ["export_mjcf", "export_sdf", "export_usd", "simulate", "check"])
def test_what_is_no_robot_is_refused(name):
    with pytest.raises(ConfigError, match="robot is 5, which is not a robot of urdftool"):
        getattr(api, name)(5)
