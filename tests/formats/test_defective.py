"""Every command on files that are not right: a message with its place, and no bug."""

import re

import pytest

from tests.formats.defective import CASES, write_case

COMMANDS = {
    "info": ["info"],
    "graph": ["graph", "-o", "-", "--style", "detailed", "--lint"],
    "lint": ["lint", "--no-cache"],
    "inertia": ["inertia", "robot"],
    "collision": ["collision", "--check"],
    "view": ["view", "--picture", "out.png", "--size", "32x24"],
    "simulate": ["simulate", "--duration", "0.1"],
    "diff": ["diff"],
    "expand": ["expand"],
    "sdf": ["export", "sdf", "-o", "out_sdf"],
    "mjcf": ["export", "mjcf", "-o", "out_mjcf"],
}
QUICK = ("info", "lint")
PLACE = re.compile(r"^(?:urdftool: )?[^\s:]+(?::\d+)*: ", re.MULTILINE)

MJCF = [name for name, files in CASES.items() if "model.xml" in files]
SDF = [name for name in CASES if name not in MJCF]


def check(urdftool, name, folder, commands):
    path = write_case(name, folder).name
    inputs = set(CASES[name])
    for command in commands:
        words = COMMANDS[command]
        front = 2 if words[0] in ("export", "inertia") else 1
        names = [path, path] if command == "diff" else [path]
        result = urdftool(*words[:front], *names, *words[front:])
        said = result.out + result.err
        assert result.code in (0, 1, 2), (command, said)
        assert "bug in urdftool" not in said, (command, said)
        assert "Traceback" not in said, (command, said)
        if result.code == 2:
            assert PLACE.search(said), (command, said)
            made = {file.name for file in folder.iterdir()} - inputs
            assert made <= {"out.png", "out_sdf", "out_mjcf"}, command


@pytest.mark.parametrize("name", SDF)
def test_sdf_and_files_of_other_tools(urdftool, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    check(urdftool, name, tmp_path, QUICK)


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("name", MJCF[::15])
def test_some_of_mjcf(urdftool, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    check(urdftool, name, tmp_path, ("lint",))


@pytest.mark.slow
@pytest.mark.library("mujoco")
@pytest.mark.library("pybullet")
@pytest.mark.parametrize("name", CASES)
def test_every_command(urdftool, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    check(urdftool, name, tmp_path, COMMANDS)


@pytest.mark.slow
@pytest.mark.library("mujoco")
@pytest.mark.parametrize("suffix", ["sdf", "xml"])
def test_a_file_of_200000_bodies_is_refused_in_bounded_time(urdftool, suffix, tmp_path):
    import time

    path = tmp_path / f"many.{suffix}"
    if suffix == "sdf":
        links = "".join(f'<link name="l{number}"/>' for number in range(200_000))
        path.write_text(f'<sdf version="1.9"><model name="m">{links}</model></sdf>')
    else:
        bodies = "".join(f'<body name="b{n}"><geom size="1"/></body>' for n in range(200_000))
        path.write_text(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
    start = time.monotonic()
    result = urdftool("info", path)
    assert time.monotonic() - start < 60
    assert result.code in (0, 2)
    assert f"{path}:" in result.err
