"""Damaged descriptions: whatever is done to a file, a command says something and never breaks."""

import random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.conftest import FIXTURES
from urdftool import cli

ROBOTS = sorted(
    path
    for path in FIXTURES.glob("robots/**/*")
    if path.suffix in (".urdf", ".xacro") and path.stat().st_size < 20_000
)

PIECES = [
    *(b"<", b">", b"/>", b'"', b"'", b"=", b"&", b"&amp;", b"-->", b"<!--", b"]]>", b"\0", b"\xff"),
    *(b"${", b"}", b"$(", b")", b"$$", b"${1/0}", b"${x}", b"$(find x)", b"$(arg y)", b"${[].x}"),
    *(b"nan", b"1e999", b"-1", b"", b"1 2", b"\t", b"0x10", b"1,5", b"\n", b"\xc3\xa9"),
    *(
        b"<link/>",
        b"<joint/>",
        b"<xacro:if value='2'/>",
        b"<xacro:macro/>",
        b"<robot>",
        b"</robot>",
    ),
    *(b"<!-- urdftool-ignore[ -->", b"<gazebo/>", b"<mimic joint='x'/>", b"name", b"xmlns:xacro"),
]


@st.composite
def damaged(draw):
    """A fixture robot with some of its bytes cut out, moved, doubled or replaced."""
    path = draw(st.sampled_from(ROBOTS))
    data = path.read_bytes()
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(data)))
        length = draw(st.sampled_from([0, 1, 2, 5, 20, 200]))
        piece = data[start : start + length]
        what = draw(st.sampled_from(["cut", "double", "insert", "replace", "move", "end"]))
        if what == "cut":
            data = data[:start] + data[start + length :]
        elif what == "double":
            data = data[:start] + piece + data[start:]
        elif what == "end":
            data = data[: max(start, 1)]
        elif what == "move":
            to = draw(st.integers(0, len(data)))
            data = data[:to] + piece + data[to:]
        else:
            new = draw(st.sampled_from(PIECES))
            data = data[:start] + new + data[start + (length if what == "replace" else 0) :]
    return path, data


def assert_is_said(capfdbinary, path, data):
    """Run both commands on the bytes, in the folder the file is from."""
    name = f"{path.stem.split('.')[0]}_damaged{''.join(path.suffixes)}"
    target = path.parent / name
    target.write_bytes(data)
    try:
        for words in (["lint", "--format", "full", str(target)], ["expand", str(target)]):
            capfdbinary.readouterr()
            code = cli.call(words)
            out, err = capfdbinary.readouterr()
            assert code in (0, 1, 2), err.decode()
            assert b"Traceback" not in out + err
            assert code != 2 or err.startswith(str(path.parent).encode()[:1]) or err
    finally:
        target.unlink()


@pytest.fixture
def robots(tmp_path, monkeypatch):
    """A copy of the fixture robots, so that nothing is written into the project."""
    import shutil

    shutil.copytree(FIXTURES / "robots", tmp_path / "robots")
    return tmp_path / "robots"


@settings(
    max_examples=25,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(case=damaged())
def test_a_damaged_description_is_said_and_breaks_nothing(case, robots, capfdbinary):
    path, data = case
    assert_is_said(capfdbinary, robots / path.relative_to(FIXTURES / "robots"), data)


@pytest.mark.slow
def test_thousands_of_damaged_descriptions(robots, capfdbinary):
    generator = random.Random(0)
    for _ in range(3000):
        path = generator.choice(ROBOTS)
        data = bytearray(path.read_bytes())
        for _ in range(generator.randint(1, 6)):
            at = generator.randrange(len(data) + 1)
            data[at : at + generator.choice([0, 1, 3, 30])] = generator.choice(PIECES)
        assert_is_said(capfdbinary, robots / path.relative_to(FIXTURES / "robots"), bytes(data))
