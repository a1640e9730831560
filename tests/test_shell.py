"""What the wheel brings for ``man`` and for the shells."""

import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from generator.completions import list_completions
from generator.man import list_man_pages

from tests.conftest import ROOT
from urdftool import cli
from urdftool.source.description_formats import NAMES

MAN = sorted((ROOT / "docs" / "man").glob("*.1"))


def completed(*words, shell="bash"):
    """What the shell is offered for the last of some words."""
    line = ["urdftool", *words]
    index = str(len(line) - 1)
    asked = {"COMP_WORDS": " ".join(line), "COMP_CWORD": words[-1] if shell == "fish" else index}
    done = subprocess.run(
        [sys.executable, "-m", "urdftool"],
        env={**os.environ, **asked, "_URDFTOOL_COMPLETE": f"{shell}_complete"},
        capture_output=True,
        text=True,
    )
    assert done.stderr == ""
    return done.stdout.split()


def test_commands_are_completed():
    assert completed("li") == ["plain,lint"]
    assert completed("") == [f"plain,{name}" for name in cli.COMMANDS]
    assert completed("export", "") == [f"plain,{name}" for name in NAMES]


def test_options_are_completed():
    assert "plain,--unsafe-fixes" in completed("lint", "--un")
    assert completed("graph", "a.urdf", "--style", "d") == ["plain,detailed"]


@pytest.mark.parametrize(
    ("words", "kind"),
    [
        (("lint", "ar"), "file,ar"),
        (("diff", "ar"), "file,ar"),
        (("view", "ar"), "file,ar"),
        (("expand", "a.xacro", "--check", "ar"), "file,ar"),
        (("collision", "a.urdf", "--picture", "ar"), "file,ar"),
        (("inertia", "mesh", "li"), "file,li"),
        (("--config", "ur"), "file,ur"),
        (("lint", "a.urdf", "--package-path", "sr"), "dir,sr"),
    ],
)
def test_paths_are_left_to_the_shell(words, kind):
    assert completed(*words) == [kind]


def test_rules_and_targets_are_completed():
    assert "plain,zero-axis" in completed("lint", "--explain", "zero")
    assert "plain,tree" in completed("lint", "--select", "tr")
    assert "plain,joint,zero-axis" in completed("lint", "--select", "joint,zero")
    assert "plain,tree" not in completed("lint", "--explain", "tr")
    assert completed("lint", "--target", "gaz") == ["plain,gazebo-classic"]
    assert completed("view", "--host", "loc") == []


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
def test_bash_completes_a_line(tmp_path):
    (tmp_path / "urdftool").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m urdftool "$@"\n')
    (tmp_path / "urdftool").chmod(0o755)
    script = f"""
        source {ROOT}/docs/completions/urdftool.bash
        complete -p urdftool
        COMP_WORDS=(urdftool lint --fail-on w) COMP_CWORD=3
        _urdftool_completion urdftool w --fail-on
        echo "${{COMPREPLY[@]}}"
    """
    path = f"{tmp_path}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "--norc", "-c", script],
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
    )
    assert done.stdout.splitlines()[-1] == "warning", done.stderr


@pytest.mark.parametrize(
    ("name", "shell"),
    [
        pytest.param("_urdftool", "zsh", marks=pytest.mark.program("zsh")),
        pytest.param("urdftool.fish", "fish", marks=pytest.mark.program("fish")),
    ],
)
def test_scripts_are_as_their_shell_reads_them(name, shell):
    script = ROOT / "docs" / "completions" / name
    subprocess.run([shell, "-n", str(script)], check=True)


def test_a_script_for_each_shell():
    assert [path.name for path, _ in list_completions()] == [
        *("urdftool.bash", "_urdftool", "urdftool.fish")
    ]


def test_a_page_for_each_command():
    pages = dict(list_man_pages())
    assert [path.name for path in pages] == [
        "urdftool.1",
        *(f"urdftool-{name}.1" for name in cli.COMMANDS),
    ]
    assert sorted(pages) == MAN
    for text in pages.values():
        for section in (
            "NAME",
            "SYNOPSIS",
            "DESCRIPTION",
            "OPTIONS",
            "EXIT STATUS",
            "SEE ALSO",
        ):
            assert f".SH {section}\n" in text, section


@pytest.mark.program("groff")
@pytest.mark.parametrize("page", MAN, ids=lambda page: page.name)
def test_man_pages_are_sound(page):
    words = ["groff", "-man", "-Tutf8", "-ww", "-z", "-rCHECKSTYLE=3", str(page)]
    done = subprocess.run(words, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.program("man")
def test_man_shows_a_command(tmp_path):
    words = ["man", "-P", "cat", "-l", str(ROOT / "docs" / "man" / "urdftool-lint.1")]
    done = subprocess.run(
        words, capture_output=True, text=True, env={**os.environ, "MANWIDTH": "80"}
    )
    shown = re.sub(".\b", "", done.stdout)
    assert "urdftool-lint - " in " ".join(shown.split()), done.stderr
    assert "--unsafe-fixes" in shown
    assert "urdftool lint src/ --target gz --format concise" in shown


@pytest.mark.slow
def test_the_wheel_brings_them(tmp_path):
    words = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        "-q",
        "--no-deps",
        "-w",
        str(tmp_path),
        str(ROOT),
    ]
    subprocess.run(words, check=True)
    (wheel,) = tmp_path.glob("*.whl")
    names = [Path(name) for name in zipfile.ZipFile(wheel).namelist() if "/share/" in name]
    shared = {"/".join(name.parts[2:]) for name in names}
    assert shared == {
        *(f"share/man/man1/{page.name}" for page in MAN),
        "share/bash-completion/completions/urdftool",
        "share/zsh/site-functions/_urdftool",
        "share/fish/vendor_completions.d/urdftool.fish",
        *(f"share/urdftool/cmake/{file.name}" for file in (ROOT / "urdftool/cmake").iterdir()),
        *(f"share/urdftool/{path.relative_to(ROOT)}" for path in (ROOT / "skills").rglob("*.md")),
    }
