"""Options of Python against those of the command line: the same words, ranges and refusals."""

import inspect
import math
import warnings
from dataclasses import fields
from importlib import import_module

import click
import numpy as np
import pytest

import urdftool as api
from urdftool.api import edit
from urdftool.api.srdf import make_srdf
from urdftool.collision.settings import Settings as CollisionSettings
from urdftool.errors import ConfigError, ModelError
from urdftool.simulation.settings import HOLDS, RANGES, Settings

ARM = (
    '<robot name="r"><link name="a"/><link name="b"/><joint name="elbow" type="continuous">'
    '<parent link="a"/><child link="b"/></joint></robot>'
)


@pytest.fixture
def arm(tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    return path


@pytest.fixture
def loaded(arm):
    return api.load(arm)


def command_options(name):
    command = import_module(f"urdftool.commands.{name}").command
    return {one.name: one for one in command.params if isinstance(one, click.Option)}


def range_of(option):
    kind = option.type
    if isinstance(kind, click.types._NumberRangeBase):
        return kind.min, math.inf if kind.max is None else kind.max
    return None


@pytest.mark.parametrize("name", sorted(RANGES))
def test_ranges_of_simulations_are_those_of_the_command(name):
    option = command_options("simulate").get(name)
    if option is None:
        assert name in ("gravity", "tilt", "nudge")  # only in Python
        return
    least, most = range_of(option)
    if name == "slope":
        least, most = math.radians(least), math.radians(most)
    assert RANGES[name] == pytest.approx((least, most), abs=1e-8)


def test_words_of_hold_are_those_of_the_command():
    command = import_module("urdftool.commands.simulate").command
    flags = {one.flag_value for one in command.params if one.name == "hold"}
    assert flags == set(HOLDS)


OF_COMMANDS = {
    *("package", "package_path", "named", "words", "robot", "robots", "gltf_up"),  # of `load`
    *("style", "output", "cache_dir", "picture", "jobs"),
    *("debug", "quiet", "trust", "verbose"),  # which the command line adds to each command
}
PYTHON = {
    "simulate": {
        "robot",
        "settings",
        *("gravity", "nudge", "tilt", "start_rpy", "upright_rpy", "fixed_in_exports"),
    },
    "verify": {"robots", "packages", "package_paths"},
    "simplify_collisions": {"robot", "settings", "jobs", "output"},
}
COMMAND = {
    "simulate": {"fleet", "junit", "no_cache", "plot", "scheduler", "strict", "video"},
    "verify": set(),
    "simplify_collisions": {"check", "in_place", "scheduler", "spheres_file"},
}
RENAMED = {
    "simulate": {"payloads": "payload", "controls": "controllers"},
    "verify": {},
    "simplify_collisions": {"links": "only", "skip_links": "skip", "cache": "no_cache"},
}
COMMANDS = {"simulate": "simulate", "verify": "verify", "simplify_collisions": "collision"}
SETTINGS = {"simulate": Settings, "simplify_collisions": CollisionSettings}


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_python_has_the_options_of_the_command(name):
    in_python = set(inspect.signature(getattr(api, name)).parameters) - PYTHON[name]
    if name in SETTINGS:
        in_python |= {one.name for one in fields(SETTINGS[name])} - PYTHON[name]
    command = import_module(f"urdftool.commands.{COMMANDS[name]}").command
    in_command = {one.name for one in command.params} - OF_COMMANDS - COMMAND[name]
    assert {RENAMED[name].get(one, one) for one in in_python} == in_command


BAD_WORDS = [
    ("load", lambda path, one: api.load(path, gltf_up="x"), "gltf_up is 'x', which is not one of"),
    ("check", lambda path, one: api.check(path, gltf_up="Y"), "y, z; did you mean 'y'?"),
    ("select", lambda path, one: api.check(path, select="axis-not-unit"), "is not a list; pass ["),
    ("fix", lambda path, one: api.fix(path, ignore="inertia"), "ignore is 'inertia', which is not"),
    ("paths", lambda path, one: api.load(path, package_paths="/a"), "which is not a list"),
    ("expand", lambda path, one: api.expand(path, package_paths="/a"), "which is not a list"),
    ("target", lambda path, one: api.check(path, targets=["mujuco"]), "did you mean 'mujoco'?"),
    ("engine", lambda path, one: api.simulate(one, engine="mujuco"), "did you mean 'mujoco'?"),
    ("only", lambda path, one: api.verify(one, one, only=["fraems"]), "did you mean 'frames'?"),
    ("one", lambda path, one: api.verify(one, one, only="frames"), "only is 'frames', which is"),
    ("less", lambda path, one: api.verify(one, one, tolerance=-1), "finite number of at least 0"),
    ("text", lambda path, one: api.verify(one, one, tolerance="1"), "tolerance is '1', which"),
    ("uri", lambda path, one: api.simplify_collisions(one, "o", uri="pkg"), "is not one of auto"),
    ("jobs", lambda path, one: api.simplify_collisions(one, "o", jobs=0), "jobs is 0, which is"),
    ("boxes", lambda path, one: make_srdf(one, boxes=0), "boxes is 0, which is not a finite"),
    ("mirror", lambda path, one: edit.mirror(one, meshes="file"), "did you mean 'files'?"),
]


@pytest.mark.parametrize(("name", "call", "message"), BAD_WORDS, ids=[row[0] for row in BAD_WORDS])
def test_other_values_are_refused(arm, loaded, name, call, message):
    with pytest.raises(ConfigError) as caught:
        call(arm, loaded)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("choices", "message"),
    [
        ({"hold": "actuate"}, "all, actuated, none; did you mean 'actuated'?"),
        ({"duration": 0}, "duration is 0, which is not a finite number from 1e-09 to 3600"),
        ({"duration": math.nan}, "duration is nan"),
        ({"timestep": "2 ms"}, "timestep is '2 ms'"),
        ({"friction": -0.1}, "friction is -0.1, which is not a finite number of at least 0"),
        ({"trials": 0}, "trials is 0, which is not a finite number from 1 to 1000"),
        ({"slope": 30}, "slope is 30"),  # degrees
        ({"height": math.inf}, "height is inf, which is not a finite number"),
        ({"payloads": {"a": -1.0}}, "payload of 'a' is -1.0"),
    ],
)
def test_settings_of_a_simulation_are_checked(choices, message):
    with pytest.raises(ConfigError) as caught:
        Settings(**choices)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("positions", "message"),
    [
        ({"elbo": 1.0}, "movable joint 'elbo' does not exist; did you mean 'elbow'?"),
        ({"elbow": math.nan}, "position of joint 'elbow' is nan, not a finite number"),
        ({"elbow": "1"}, "position of joint 'elbow' is '1', not a finite number"),
    ],
)
def test_poses_are_checked(loaded, positions, message):
    pytest.importorskip("trimesh")
    for call in (loaded.to_scene, lambda pose: api.export_mjcf(loaded, pose=pose)):
        with pytest.raises(ModelError) as caught:
            call(positions)
        assert message in str(caught.value)


def test_positions_may_be_of_numpy(loaded):
    pytest.importorskip("trimesh")
    for kind in (np.float32, np.float64, np.int64):
        assert loaded.to_scene({"elbow": kind(1)}) is not None


@pytest.mark.parametrize("call", [api.load, api.check, api.expand, api.fix])
def test_folders_that_do_not_exist_are_a_warning(arm, tmp_path, call):
    nowhere = tmp_path / "nowhere"
    with pytest.warns(UserWarning, match="the folder of package 'x', does not exist") as caught:
        call(arm, packages={"x": nowhere})
    assert caught[0].filename == __file__
    with pytest.warns(UserWarning, match="package_paths: folder '.*nowhere' does not exist"):
        call(arm, package_paths=[nowhere])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        call(arm, packages={"x": tmp_path}, package_paths=[tmp_path])


def test_the_value_of_an_argument_is_a_text(tmp_path):
    path = tmp_path / "arm.urdf.xacro"
    path.write_text(ARM)
    with pytest.raises(ConfigError, match="argument prefix is 3, which is not a text; write '3'"):
        api.load(path, args={"prefix": 3})
