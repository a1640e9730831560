"""Files are written whole or not at all, and a cache gives back what it was given."""

import os
import stat

import pytest

from urdftool import storage
from urdftool.errors import OutputError
from urdftool.storage import DiskCache, cache_key, write_files, write_folder


def contents(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def fail_at(monkeypatch, name):
    """Let the move of one file to its place fail."""
    move = os.replace

    def replace(source, target):
        if os.path.basename(target) == name and str(source).endswith(".tmp"):
            raise OSError(28, "No space left on device")
        move(source, target)

    monkeypatch.setattr(storage.os, "replace", replace)


def test_files_of_bytes_and_of_files(tmp_path):
    (tmp_path / "a").write_bytes(b"1")
    write_files({tmp_path / "new" / "b": tmp_path / "a", tmp_path / "c": b"2"})
    assert contents(tmp_path) == {"a": b"1", "c": b"2", "new/b": b"1"}


def test_all_are_as_they_were_if_one_cannot_be_written(tmp_path, monkeypatch):
    (tmp_path / "a").write_bytes(b"old")
    fail_at(monkeypatch, "c")
    files = {tmp_path / "a": b"new", tmp_path / "sub" / "b": b"new", tmp_path / "c": b"new"}
    with pytest.raises(OutputError, match=r"c: cannot be written: No space left on device"):
        write_files(files)
    assert contents(tmp_path) == {"a": b"old"}
    assert not (tmp_path / "sub").exists()


def test_the_mode_of_a_file_stays(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"old")
    path.chmod(0o640)
    write_files({path: b"new"})
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


@pytest.mark.parametrize("follow", [True, False])
def test_a_link_is_followed_or_replaced(tmp_path, follow):
    (tmp_path / "target").write_bytes(b"old")
    link = tmp_path / "link"
    link.symlink_to("target")
    write_files({link: b"new", tmp_path / "other": b""}, follow_links=follow)
    assert link.read_bytes() == b"new"
    assert link.is_symlink() == follow
    assert (tmp_path / "target").read_bytes() == (b"new" if follow else b"old")


def test_a_folder_keeps_what_else_is_in_it(tmp_path):
    write_folder(tmp_path / "out", {"model.sdf": b"1", "meshes/a.obj": b"2"})
    (tmp_path / "out" / "notes.txt").write_bytes(b"mine")
    write_folder(tmp_path / "out", {"model.sdf": b"3"})
    assert contents(tmp_path / "out") == {
        "meshes/a.obj": b"2",
        "model.sdf": b"3",
        "notes.txt": b"mine",
    }
    assert os.listdir(tmp_path) == ["out"]


def test_a_folder_that_cannot_be_written_is_as_it_was(tmp_path, monkeypatch):
    write_folder(tmp_path / "out", {"a": b"1"})
    with pytest.raises(OutputError):
        write_folder(tmp_path / "out", {"a": b"2", "b": tmp_path / "missing"})
    assert contents(tmp_path) == {"out/a": b"1"}


def test_a_cache_gives_back_what_it_was_given_and_nothing_damaged(tmp_path):
    cache = DiskCache(tmp_path)
    cache.put("abc", b"result")
    assert DiskCache(tmp_path).get("abc") == b"result"
    assert cache.get("abd") is None
    (entry,) = (path for path in tmp_path.rglob("*") if path.is_file())
    entry.write_bytes(entry.read_bytes()[:-1])
    assert cache.get("abc") is None
    DiskCache(None).put("abc", b"result")
    assert DiskCache(None).get("abc") is None


def test_the_oldest_entries_go_first(tmp_path):
    cache = DiskCache(tmp_path)
    (tmp_path / "notes.txt").write_bytes(bytes(9000))
    os.utime(tmp_path / "notes.txt", times=(0, 0))
    new, older, oldest = (digit * 64 for digit in "abc")
    for age, key in enumerate((new, older, oldest)):
        cache.put(key, bytes(1000))
        (path,) = tmp_path.rglob(key)
        os.utime(path, times=(path.stat().st_mtime - 100 * age,) * 2)
    assert cache.trim(most=2500) == 1
    assert cache.get(oldest) is None
    assert cache.get(older) is not None
    assert cache.trim(most=0) == 0  # once a day
    assert (tmp_path / "notes.txt").exists()  # only entries go


def make_pipe(path, _):
    os.mkfifo(path)


def make_folder(path, _):
    path.mkdir()


def make_large(path, _):
    with path.open("wb") as stream:
        os.truncate(stream.fileno(), 1 << 40)


@pytest.mark.parametrize(
    "put",
    [
        make_pipe,
        make_folder,
        lambda path, _: path.symlink_to("/dev/zero"),
        lambda path, _: path.symlink_to(path),
        lambda path, other: path.symlink_to(other),
        make_large,
    ],
    ids=["pipe", "folder", "device", "loop", "link", "large"],
)
@pytest.mark.skipif(os.name != "posix", reason="needs links and pipes")
def test_what_is_not_an_entry_is_neither_read_nor_written_through(tmp_path, put):
    """A cache folder may be writable by others."""
    other = tmp_path / "other"
    other.write_bytes(b"precious")
    cache = DiskCache(tmp_path / "cache")
    key = "a" * 64
    cache.put(key, b"result")
    for place in (tmp_path / "cache" / "aa" / key, tmp_path / "cache" / "trimmed"):
        place.unlink(missing_ok=True)
        put(place, other)
    assert cache.get(key) is None
    os.utime(tmp_path / "cache" / "trimmed", times=(0, 0), follow_symlinks=False)
    cache.trim()
    cache.put(key, b"result")
    assert other.read_bytes() == b"precious"
    assert cache.get(key) == (None if put is make_folder else b"result")


def test_a_key_has_the_version_the_facts_and_the_bounds_of_the_inputs(monkeypatch):
    keys = {
        cache_key(1, ["a"], [b"xy", b"z"]),
        cache_key(2, ["a"], [b"xy", b"z"]),
        cache_key(1, ["b"], [b"xy", b"z"]),
        cache_key(1, ["a"], [b"x", b"yz"]),
    }
    monkeypatch.setattr(storage, "__version__", "99")
    assert len(keys | {cache_key(1, ["a"], [b"xy", b"z"])}) == 5
