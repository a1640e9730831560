"""Damaged robots: an export is refused, or it is the robot that is left; it never breaks."""

import random
import re

import pytest

from tests.conftest import CORPUS, FIXTURES
from urdftool.formats.sdf.verify import compare

VALUES = [
    *("nan", "1e999", "-1", "", "1 2", "0", "1e-300", "1e300", "world", "x::y", "__a__", "0 0 0"),
    *(
        "1 2 3",
        "true",
        "1e200 1e200 1e200",
        "é",
        "-inf",
        "fixed",
        "floating",
        "planar",
        "ball",
        " ",
    ),
    *("revolute", "mimic", "base_link", "package://x/y.stl", "9" * 400, "-0"),
]
ELEMENTS = [
    '<mass value="0"/>',
    '<origin xyz="0 0 1" rpy="1 2 3"/>',
    "<limit/>",
    '<axis xyz="0 0 0"/>',
    "<inertial/>",
    "<visual/>",
    '<collision><geometry><capsule radius="1" length="2"/></geometry></collision>',
    '<material name="m"><texture filename="x.png"/></material>',
    '<gazebo reference="base_link"><mu1>2</mu1><sensor name="s" type="ray"/></gazebo>',
    "<gazebo><plugin/></gazebo>",
    '<gazebo><joint name="q" type="revolute"><parent>base_link</parent><child>x</child></joint>'
    '<link name="z"/><frame/><model/></gazebo>',
    "<ros2_control/>",
    "<transmission/>",
]
CHOICES = [
    [],
    ["--target", "gazebo-classic"],
    ["--target", "gazebo-classic", "--sdf-version", "1.6"],
    ["--fixed-joints", "lump"],
    ["--sdf-version", "1.9"],
    ["--world", "--sdf-version", "1.12"],
]
VALUE = r'="([^"<]*)"'
TEXT = r">([^<>\s][^<>]*)<"
EMPTY = r"(<\w+[^<>]*/>)"
WHOLE = r"(?s)(<(\w+)[^<>]*[^/]>.*?</\2>)"


def robots():
    """Small robots, the same ones in the same order every time."""
    files = [p for p in sorted(FIXTURES.rglob("*.urdf")) if p.stat().st_size < 20_000]
    if CORPUS.exists():
        found = [p for p in sorted(CORPUS.rglob("*.urdf")) if p.stat().st_size < 40_000]
        files += random.Random(5).sample(found, min(len(found), 100))
    return files


def damaged(text, chance):
    """A robot with values, texts and elements changed, left out, doubled or moved."""
    for _ in range(chance.randint(1, 4)):
        kind = chance.choice([VALUE, VALUE, VALUE, TEXT, EMPTY, WHOLE, None])
        if kind is None:
            places = [match.end() for match in re.finditer(">", text)] or [0]
            place = chance.choice(places)
            text = text[:place] + chance.choice(ELEMENTS) + text[place:]
            continue
        found = list(re.finditer(kind, text))
        if not found:
            continue
        match = chance.choice(found)
        if kind in (VALUE, TEXT):
            others = VALUES if chance.random() < 0.6 else [other[1] for other in found]
            new = chance.choice(others)
        else:
            new = chance.choice(["", "", match[1] * 2])
        text = text[: match.start(1)] + new + text[match.end(1) :]
    return text


@pytest.mark.parametrize(
    "count", [40, pytest.param(1000, marks=[pytest.mark.slow, pytest.mark.corpus])]
)
def test_damaged_robots(urdftool, write, tmp_path, monkeypatch, count):
    monkeypatch.setattr(compare, "run_loads", lambda *_: None)
    files = robots()
    for seed in range(count):
        chance = random.Random(seed)
        path = chance.choice(files)
        text = damaged(path.read_text("utf-8", "replace"), chance)
        source = write("damaged.urdf", text)
        words = ["-o", tmp_path / "out", "--force", "--verify", "--overwrite"]
        result = urdftool("export", "sdf", source, *words, *chance.choice(CHOICES))
        immense = "above 1e+30" in result.out  # SDF is read back with bounded numbers
        assert result.code in (0, 2) or immense, f"seed {seed}, {path}: {result.out}{result.err}"
