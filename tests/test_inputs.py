"""What is asked of the file system, heard."""

import os
from pathlib import Path

import pytest

from urdftool import inputs
from urdftool.inputs import ABSENT, Remembered, answer, is_settled, listen, stamp_of


def asked_by(action):
    with listen() as asked:
        action()
    return {(kind, os.path.relpath(path) if os.path.isabs(path) else path) for kind, path in asked}


def text(path):
    with open(path) as stream:
        return stream.read()


@pytest.fixture(autouse=True)
def folder(write):
    write("a", "text")
    write("d/b", "text")
    os.symlink("a", "l")


@pytest.mark.parametrize(
    ("action", "question"),
    [
        (lambda: text("a"), ("file", "a")),
        (lambda: Path("a").read_bytes(), ("file", "a")),
        (lambda: os.path.exists("none"), ("file", "none")),
        (lambda: os.path.isfile(b"a"), ("file", "a")),
        (lambda: Path("none/there").exists(), ("file", "none/there")),
        (lambda: Path("d").is_dir(), ("file", "d")),
        (lambda: Path("a").stat().st_size, ("file", "a")),
        (lambda: os.path.lexists("l"), ("link", "l")),
        (lambda: os.path.realpath("l"), ("link", "l")),
        (lambda: Path("l").is_symlink(), ("link", "l")),
        (lambda: os.readlink("l"), ("link", "l")),
        (lambda: os.listdir("d"), ("list", "d")),
        (lambda: os.listdir(), ("list", ".")),
        (lambda: list(os.walk("d")), ("list", "d")),
        (lambda: sorted(Path("d").glob("*.x")), ("list", "d")),
        (lambda: os.environ.get("NONE_SUCH"), ("env", "NONE_SUCH")),
        (lambda: os.getenv("HOME"), ("env", "HOME")),
        (lambda: dict(os.environ), ("env", "*")),
    ],
)
def test_it_is_heard(action, question):
    assert question in asked_by(action)


def test_a_file_that_cannot_be_opened_is_heard():
    def try_to_open():
        with pytest.raises(FileNotFoundError):
            text("none")

    assert asked_by(try_to_open) == {("file", "none")}


def test_code_is_not_heard():
    def bring():
        import colorsys  # noqa: F401

    assert not {path for _, path in asked_by(bring) if path.endswith((".py", ".pyc"))}


def test_nothing_is_heard_afterwards_and_the_functions_are_back():
    before = os.stat, os.lstat, os.readlink, os.environ["HOME"]
    with listen() as asked:
        assert os.stat is not before[0]
    text("a")
    assert not asked
    assert (os.stat, os.lstat, os.readlink, os.environ["HOME"]) == before
    with pytest.raises(ZeroDivisionError), listen():
        1 / 0  # noqa: B018
    assert os.stat is before[0]


@pytest.mark.parametrize("kind", ["file", "list", "link"])
def test_an_answer_tells_what_changed(kind, write):
    def said(path):
        return answer((kind, path)), stamp_of((kind, path))

    assert said("none") == (ABSENT, None)
    assert said("a/below")[0].startswith("error")
    if kind == "file":
        first = said("a")
        write("a", "TEXT")
        assert said("a")[0] != first[0]
        assert said("d")[0] == "folder"
        assert said("l")[0] == said("a")[0]
    elif kind == "list":
        first = said("d")
        write("d/b", "other")
        assert said("d")[0] == first[0]
        write("d/c", "")
        assert said("d")[0] != first[0]
    else:
        first = said("l")
        os.unlink("l")
        os.symlink("d", "l")
        assert said("l") != first
        assert said("a")[0] == "file"


def test_what_is_young_is_not_settled():
    stamp = stamp_of(("file", "a"))
    assert not is_settled(stamp)
    assert is_settled(stamp, max(stamp) + 3_000_000_000)
    assert is_settled(None)


def test_what_is_remembered_is_heard_by_all_who_ask():
    times = []

    @Remembered
    def size(path):
        times.append(path)
        return len(text(path))

    assert size("a") == 4
    assert asked_by(lambda: size("a")) == {("file", "a")}  # asked again, for nobody listened
    assert asked_by(lambda: size("a")) == {("file", "a")}
    assert times == ["a", "a"]

    @Remembered
    def double(path):
        return 2 * size(path)

    assert asked_by(lambda: double("a")) == {("file", "a")}
    inputs.forget()
    assert size("a") == 4
    assert len(times) == 3


def test_many_questions_are_one():
    @Remembered
    def there(number):
        return [os.path.exists(f"{number}/{i}") for i in range(60)]

    ((kind, number),) = asked_by(lambda: there(1))
    assert kind == "many"
    assert len(inputs.together[int(number)]) == 60
    assert asked_by(lambda: there(1)) == {(kind, number)}
