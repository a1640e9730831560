"""Files read through one object: unsaved contents, what a result depends on, what is known."""

import os
import pickle
from pathlib import Path

import pytest

from urdftool.dependencies import ABSENT, Dependencies, compute_answer, is_settled, read_stamp
from urdftool.memo import Memo
from urdftool.workspace import STDIN, Workspace, memoize_by_workspace


def asked_by(action, workspace=None):
    """The questions that an action asks, with relative paths."""
    view = (workspace or Workspace()).with_record()
    action(view)
    return {
        (kind, os.path.relpath(path) if os.path.isabs(path) else path)
        for kind, path in view.dependencies.stamps
    }


@pytest.fixture(autouse=True)
def folder(write):
    write("a", "text")
    write("d/b", "text")
    os.symlink("a", "l")


@pytest.mark.parametrize(
    ("action", "question", "result"),
    [
        (lambda w: w.read_bytes("a"), ("file", "a"), b"text"),
        (lambda w: w.read_text(Path("a")), ("file", "a"), "text"),
        (lambda w: w.open("a").read(2), ("file", "a"), b"te"),
        (lambda w: w.materialize("a"), ("file", "a"), Path("a")),
        (lambda w: w.get_size("a"), ("file", "a"), 4),
        (lambda w: w.get_size("d"), ("file", "d"), None),
        (lambda w: w.get_size("none"), ("file", "none"), None),
        (lambda w: w.exists("none"), ("is", "none"), False),
        (lambda w: w.exists("d"), ("is", "d"), True),
        (lambda w: w.is_file("a"), ("is", "a"), True),
        (lambda w: w.is_file("a\0"), ("is", "a\0"), False),
        (lambda w: w.is_folder("d"), ("is", "d"), True),
        (lambda w: w.exists_or_is_link("l"), ("there", "l"), True),
        (lambda w: os.path.relpath(w.resolve_links("l")), ("real", "l"), "a"),
        (lambda w: [e.name for e in w.list_folder("d")], ("list", "d"), ["b"]),
        (lambda w: list(w.walk("d")), ("list", "d"), [("d", [], ["b"])]),
        (lambda w: w.list_matches("d", "*"), ("list", "d"), [Path("d/b")]),
        (lambda w: w.match("./?/b"), ("list", "."), ["./d/b"]),
        (lambda w: w.match("?/b"), ("list", "."), ["d/b"]),
        (lambda w: w.match("[a]"), ("list", "."), ["a"]),
        (lambda w: w.read_variable("NONE_SUCH"), ("env", "NONE_SUCH"), None),
    ],
)
def test_what_is_asked_is_answered_and_recorded(action, question, result):
    assert action(Workspace()) == result
    assert question in asked_by(action)


@pytest.mark.parametrize("pattern", ["*", "**/*", "**/b", "*/b", "?", "[ad]", "*.x", "none/*"])
def test_glob_finds_what_pathlib_finds(write, pattern):
    write(".hidden/b", "")
    write("d/e/b", "")
    assert Workspace().list_matches(".", pattern) == sorted(Path(".").glob(pattern))


def test_a_file_that_cannot_be_read_is_recorded():
    def attempt(workspace):
        with pytest.raises(FileNotFoundError) as error:
            workspace.read_bytes("none")
        assert error.value.filename == "none"

    assert asked_by(attempt) == {("file", "none")}


# Unsaved contents ------------------------------------------------------------------------------


def test_an_overlay_is_read_instead_of_the_disk(write):
    workspace = Workspace({"l": b"other", "d/new": b"new", STDIN: b"in"})
    assert workspace.read_bytes("a") == b"other"  # which the link leads to
    assert workspace.get_size("a") == 5
    assert workspace.is_file("d/new")
    assert [entry.name for entry in workspace.list_folder("d")] == ["b", "new"]
    assert workspace.get_overlay(STDIN) == b"in"
    assert Path("a").read_bytes() == b"text"
    copy = workspace.materialize("d/new")
    assert (copy.name, copy.read_bytes()) == ("new", b"new")
    assert workspace.get_with_overlay({"a": b"third"}).read_bytes("a") == b"third"
    assert workspace.read_bytes("a") == b"other"


def test_copies_are_removed_with_the_workspace():
    workspace = Workspace({"a": b"other"})
    copy = workspace.materialize("a")
    assert copy.exists()
    del workspace
    assert not copy.exists()


def test_another_process_gets_the_overlay():
    again = pickle.loads(pickle.dumps(Workspace({"a": b"other"})))
    assert again.read_bytes("a") == b"other"


# What is known ---------------------------------------------------------------------------------


@pytest.fixture
def size():
    times = []

    @memoize_by_workspace
    def size(workspace, path):
        times.append(path)
        return len(workspace.read_bytes(path))

    size.times = times
    return size


def test_a_known_value_is_a_dependency_of_all_who_ask(size):
    workspace = Workspace()
    for _ in range(2):
        assert asked_by(lambda w: size(w, "a"), workspace) == {("file", "a")}
    assert size.times == ["a"]

    @memoize_by_workspace
    def double(workspace, path):
        return 2 * size(workspace, path)

    assert asked_by(lambda w: double(w, "a"), workspace) == {("file", "a")}
    assert size(Workspace(), "a") == 4
    assert size.times == ["a", "a"]


def test_an_error_is_no_value_but_depends_on_what_was_read(size):
    workspace = Workspace()
    for _ in range(2):
        with pytest.raises(OSError):
            size(workspace, "none")
        view = workspace.with_record()
        with pytest.raises(OSError):
            size(view, "none")
        assert [kind for kind, _ in view.dependencies.stamps] == ["file"]


def test_trials_share_what_they_do_not_change(size, write):
    write("e", "unchanged")
    workspace = Workspace()
    trial, other = (workspace.get_with_overlay({"a": b"x" * n}) for n in (7, 8))
    assert [size(w, "a") for w in (workspace, trial, other, workspace)] == [4, 7, 8, 4]
    assert [size(w, "e") for w in (trial, other, workspace)] == [9, 9, 9]
    assert size.times == ["a", "a", "a", "e"]
    assert size(workspace.get_with_overlay({"l": b"y"}), "a") == 1
    assert size(workspace, "l") == 4
    assert size(workspace.get_with_overlay({"a": b"y"}), "l") == 1


def test_a_new_file_changes_what_lists_its_folder():
    @memoize_by_workspace
    def names(workspace, folder):
        return [entry.name for entry in workspace.list_folder(folder)]

    workspace = Workspace()
    assert names(workspace, "d") == ["b"]
    assert names(workspace.get_with_overlay({"d/c": b""}), "d") == ["b", "c"]
    assert names(workspace.get_with_overlay({"c": b""}), "d") == ["b"]


def test_other_text_in_a_file_does_not_change_what_lists_its_folder():
    asked = []

    @memoize_by_workspace
    def names(workspace, folder):
        asked.append(folder)
        return [entry.name for entry in workspace.list_folder(folder)], workspace.list_code(folder)

    workspace = Workspace()
    before = names(workspace, "d")
    assert names(workspace.get_with_overlay({"d/b": b"edited"}), "d") is before
    assert asked == ["d"]
    names(workspace.get_with_overlay({"d/b": b"edited", "d/c": b""}), "d")
    assert asked == ["d", "d"]


def test_many_dependencies_are_shared():
    @memoize_by_workspace
    def there(workspace, number):
        return [workspace.exists(f"{number}/{i}") for i in range(60)]

    workspace = Workspace()
    views = [workspace.with_record() for _ in range(2)]
    for view in views:
        there(view, 1)
    assert all(not view.dependencies.stamps for view in views)
    (shared,), (again,) = (view.dependencies.shared for view in views)
    assert shared is again
    assert len(shared.stamps) == 60


def test_a_memo_computes_once_and_is_not_copied():
    memo, times = Memo(), []
    assert memo.peek("a") is None
    for _ in range(2):
        assert memo.get("a", lambda: times.append(1) or 7) == 7
    assert times == [1]
    assert pickle.loads(pickle.dumps(memo)).peek("a") is None


# Whether an answer changed ---------------------------------------------------------------------


def state(kind, path):
    return compute_answer((kind, path)), read_stamp((kind, path))


@pytest.mark.parametrize("kind", ["file", "is", "there", "list"])
def test_what_is_not_there_has_no_stamp(kind):
    assert state(kind, "none") == (ABSENT, None)
    assert compute_answer((kind, "a/below")).startswith("error")


def test_a_file_is_its_contents(write):
    first = state("file", "a")
    assert state("file", "l")[0] == first[0]
    write("a", "TEXT")
    assert state("file", "a")[0] != first[0]
    assert compute_answer(("file", "d")) == "folder"


@pytest.mark.parametrize("kind", ["is", "there"])
def test_whether_it_is_there_does_not_depend_on_its_contents(kind, write):
    first = state(kind, "a")
    write("a", "other text")
    assert state(kind, "a") == first
    assert state(kind, "d") != first
    os.unlink("a")
    assert (state("is", "l")[0] == ABSENT, state("there", "l")[0] == ABSENT) == (True, False)


def test_a_folder_is_its_names(write):
    first = state("list", "d")
    write("d/b", "other")
    assert state("list", "d")[0] == first[0]
    write("d/c", "")
    assert state("list", "d")[0] != first[0]


def test_a_path_is_where_it_leads():
    first = compute_answer(("real", "l"))
    os.unlink("l")
    os.symlink("d", "l")
    assert compute_answer(("real", "l")) != first


def test_a_variable_is_its_value(monkeypatch):
    monkeypatch.delenv("HEIGHT", raising=False)
    assert compute_answer(("env", "HEIGHT")) == ABSENT
    monkeypatch.setenv("HEIGHT", "")
    assert compute_answer(("env", "HEIGHT")) == "="


def test_what_is_young_is_not_settled():
    stamp = read_stamp(("file", "a"))
    assert not is_settled(stamp)
    assert is_settled(stamp, max(stamp) + 3_000_000_000)
    assert is_settled(read_stamp(("is", "a")))
    assert is_settled(None)


def test_the_stamp_is_that_of_the_first_question(write):
    read = Dependencies()
    read.add("file", "a")
    before = dict(read.stamps)
    os.unlink("a")
    read.add("file", "a")
    assert read.stamps == before
