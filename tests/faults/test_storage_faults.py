"""Whatever happens while files are replaced, the old or the new ones are there, whole."""

import os
import re
import shutil
import sys
from functools import partial

import pytest

from tests.faults.injection import KINDS, Events, run_forked
from urdftool import storage
from urdftool.leftovers import restore_folder
from urdftool.storage import DiskCache, write_files, write_folder

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="forks, and reads /proc")

HIDDEN = re.compile(r"\.(.+)\.\d+\.(tmp|old)")


def read_tree(root):
    """Return the content of each file, and an empty text for each folder."""
    return {
        str(path.relative_to(root)): path.read_bytes() if path.is_file() else ""
        for path in sorted(root.rglob("*"))
    }


def list_hidden(tree):
    return {name for name in tree if any(HIDDEN.fullmatch(part) for part in name.split("/"))}


def without_hidden(tree):
    return {name: tree[name] for name in set(tree) - list_hidden(tree)}


def write_old(root):
    (root / "out" / "sub").mkdir(parents=True)
    (root / "out" / "a").write_bytes(b"old a")
    (root / "out" / "gone").write_bytes(b"old gone")
    (root / "out" / "sub" / "mine").write_bytes(b"mine")
    (root / "b").write_bytes(b"old b")
    (root / "to b").symlink_to("b")
    (root / "source").write_bytes(b"new from a file")


def write_one(root):
    write_files({root / "b": b"new b"})


def write_one_by_link(root):
    write_files({root / "to b": b"new b"})


def write_first(root):
    write_files({root / "fresh" / "er" / "c": b"new c"})


def write_several(root):
    files = {root / "out" / "a": b"new a", root / "fresh" / "c": root / "source"}
    write_files({**files, root / "b": b"new b"})


def write_new_folder(root):
    write_folder(root / "fresh" / "bundle", {"a": b"new a", "sub/c": root / "source"})


def replace_folder(root):
    write_folder(root / "out", {"a": b"new a", "sub/c": root / "source"}, dropped=["gone"])


def replace_folder_without_exchange(root):
    storage.exchange_names = lambda *_: False
    replace_folder(root)


def replace_folder_without_links(root):
    def refuse(*_, **__):
        raise OSError(1, "Operation not permitted")

    os.link = refuse
    replace_folder(root)


def store_entry(root):
    DiskCache(root / "out").put("ab" * 32, b"new entry")


ACTIONS = {
    action.__name__: action
    for action in (
        *(write_one, write_one_by_link, write_first, write_several, write_new_folder),
        *(replace_folder, replace_folder_without_exchange, replace_folder_without_links),
        *(store_entry,),
    )
}


@pytest.fixture
def run(tmp_path):
    """Run an action on fresh files, with a fault."""

    def start(action, kind="", number=0):
        root = tmp_path / "root"
        shutil.rmtree(root, ignore_errors=True)
        root.mkdir()
        write_old(root)
        before = read_tree(root)
        code, count = run_forked(partial(action, root), Events(root, kind, number))
        return root, before, code, count

    return start


MAIN = [a.__name__ for a in (write_several, replace_folder, replace_folder_without_exchange)]
STEP = 4
"""Of so many events one is a fault by default, another for each kind; slow tests try all."""


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", MAIN)
def test_old_or_new_at_some_events(name, kind, run):
    check_events(name, kind, run, 1 + KINDS.index(kind), STEP)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ACTIONS)
def test_old_or_new_and_nothing_else(name, kind, run):
    check_events(name, kind, run, 1, 1)


def check_events(name, kind, run, first, step):
    """Run an action with a fault at each of some events."""
    action = ACTIONS[name]
    root, before, code, count = run(action)
    after = read_tree(root)
    assert (code, list_hidden(after)) == (0, set())
    assert after != before
    assert count >= 8
    for number in range(first, count + 1, step):
        root, before, code, _ = run(action, kind, number)
        now = read_tree(root)
        if kind == "kill":
            assert code == -9
            check_after_kill(action, now, before, after)
            restore_folder(root / "out")
            now = without_hidden(read_tree(root))
            if name != "write_several":
                assert without_folders(now) in (without_folders(before), without_folders(after))
            again, _ = run_forked(partial(action, root), Events(root))
            assert (again, number, read_tree(root)) == (0, number, after)
        else:
            assert code in ((0, 2) if kind == "full" else (130,)), number
            if name == "store_entry":  # a cache is only an aid; its folders stay
                now, before, new = map(without_folders, (now, before, after))
                assert now in (before, new), number
            else:
                assert now == before or (now == after and code != 2), number


def without_folders(tree):
    """Return the files only: a kill may leave empty folders."""
    return {name: content for name, content in tree.items() if content != ""}


def check_after_kill(action, now, before, after):
    """Check each file by itself: it is whole, and only a folder may have another name for now."""
    for name, content in without_folders(without_hidden(now)).items():
        assert content in (before.get(name), after.get(name)), name
    missing = without_folders(before).keys() - now.keys() - {"out/gone"}
    if action is replace_folder_without_exchange and missing:
        assert all(name.startswith("out/") for name in missing)
        kept = [name for name in now if re.fullmatch(r"\.out\.\d+\.old", name)]
        assert len(kept) == 1
    else:
        assert not missing


def test_links_that_have_a_temporary_name_are_not_followed(tmp_path):
    victim = tmp_path / "victim"
    victim.write_bytes(b"precious")
    for place in ("a", "b", "out", "trimmed"):
        for kind in ("tmp", "old"):
            (tmp_path / f".{place}.{os.getpid()}.{kind}").symlink_to(victim)
    (tmp_path / "out").mkdir()
    write_files({tmp_path / "a": b"new", tmp_path / "b": b"new"})
    write_folder(tmp_path / "out", {"a": b"new"})
    assert victim.read_bytes() == b"precious"
    assert DiskCache(tmp_path).trim() == 0
    assert sorted(os.listdir(tmp_path)) == ["a", "b", "out", "trimmed", "victim"]


def test_a_restored_folder_is_a_folder(tmp_path):
    (tmp_path / ".out.999999999.old").symlink_to(tmp_path)
    assert not restore_folder(tmp_path / "out")
    (tmp_path / ".out.999999998.old").mkdir()
    assert restore_folder(tmp_path / "out")
    assert not restore_folder(tmp_path / "out")


def test_temporary_files_of_running_processes_and_other_outputs_stay(tmp_path):
    names = [f".a.{os.getppid()}.tmp", ".b.999999998.tmp", ".a.tmp", ".a.1x.old", ".a.01.tmp"]
    for name in (*names, ".a.999999999.tmp", ".a.999999999.old", ".c.999999999.old"):
        (tmp_path / name).write_bytes(b"")
    write_files({tmp_path / "a": b"new"})
    assert sorted(os.listdir(tmp_path)) == sorted([*names, "a"])


def test_what_is_kept_in_a_folder_is_not_copied(tmp_path):
    write_folder(tmp_path / "out", {"a": b"1"})
    mine = tmp_path / "out" / "mine"
    mine.write_bytes(b"mine")
    mine.chmod(0o600)
    (tmp_path / "out").chmod(0o700)
    inode = mine.stat().st_ino
    write_folder(tmp_path / "out", {"a": b"2"})
    assert (mine.stat().st_ino, mine.stat().st_nlink) == (inode, 1)
    assert (tmp_path / "out").stat().st_mode & 0o777 == 0o700
