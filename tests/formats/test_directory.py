"""Folders and files of an export: whole or not at all, and nothing that is not ours."""

import os

import pytest

from urdftool.errors import OutputError
from urdftool.formats.common.directory import is_ours, mark, write_beside, write_directory

MODEL = mark(b"<a/>\n", "r.urdf")


def test_a_mark_knows_its_text():
    assert is_ours(MODEL)
    assert is_ours(mark(b'<?xml version="1.0"?>\n<a/>\n', "r.urdf"))
    assert not is_ours(MODEL.replace(b"<a/>", b"<b/>"))
    assert not is_ours(b"<a/>")


@pytest.mark.parametrize("source", ["a--b.urdf", "--><x>", "a;b", "ü"])
def test_a_mark_is_a_comment_whatever_the_name(source):
    etree = pytest.importorskip("lxml.etree")
    marked = mark(b"<a/>", source)
    assert etree.fromstring(marked).tag == "a"
    assert is_ours(marked)


def test_a_folder_appears_whole(tmp_path):
    mesh = tmp_path / "mesh.stl"
    mesh.write_bytes(b"m")
    write_directory(tmp_path / "out", {"a.xml": MODEL, "assets/m.stl": mesh}, main="a.xml")
    assert (tmp_path / "out/assets/m.stl").read_bytes() == b"m"
    assert sorted(os.listdir(tmp_path)) == ["mesh.stl", "out"]


def test_nothing_is_left_of_a_failure(tmp_path):
    with pytest.raises(OutputError):
        write_directory(tmp_path / "out", {"a.xml": tmp_path / "absent"}, main="a.xml")
    assert os.listdir(tmp_path) == []


def test_others_stay(tmp_path):
    out = tmp_path / "out"
    write_directory(out, {"a.xml": MODEL}, main="a.xml")
    (out / "notes").mkdir()
    (out / "notes" / "mine.txt").write_text("mine")
    (out / "link").symlink_to("nowhere")
    write_directory(out, {"a.xml": MODEL, "b": b"b"}, main="a.xml")
    assert (out / "notes" / "mine.txt").read_text() == "mine"
    assert os.readlink(out / "link") == "nowhere"
    assert (out / "b").read_bytes() == b"b"


@pytest.mark.parametrize("content", [b"<a/>", MODEL.replace(b"<a/>", b"<b/>")])
def test_what_is_not_ours_or_was_edited_is_kept(tmp_path, content):
    out = tmp_path / "out"
    out.mkdir()
    (out / "a.xml").write_bytes(content)
    with pytest.raises(OutputError, match="--overwrite"):
        write_directory(out, {"a.xml": MODEL}, main="a.xml")
    assert (out / "a.xml").read_bytes() == content
    write_directory(out, {"a.xml": MODEL}, main="a.xml", overwrite=True)
    assert (out / "a.xml").read_bytes() == MODEL


def test_an_input_is_never_replaced(tmp_path):
    out = tmp_path / "out"
    (out / "assets").mkdir(parents=True)
    mesh = out / "assets" / "m.stl"
    mesh.write_bytes(b"m")
    with pytest.raises(OutputError, match="input"):
        write_directory(out, {"a.xml": MODEL, "assets/m.stl": mesh}, main="a.xml", overwrite=True)
    assert mesh.read_bytes() == b"m"


def test_one_file_with_its_companions(tmp_path):
    files = {"a.xml": MODEL, "assets/m.obj": b"m"}
    for _ in range(2):
        write_beside(tmp_path / "x.xml", files, main="a.xml")
    assert (tmp_path / "x.xml").read_bytes() == MODEL
    assert (tmp_path / "assets" / "m.obj").read_bytes() == b"m"
    (tmp_path / "x.xml").write_text("<mine/>")
    with pytest.raises(OutputError, match="not written by urdftool"):
        write_beside(tmp_path / "x.xml", files, main="a.xml")


def test_missing_parents_are_made(tmp_path):
    write_directory(tmp_path / "no" / "such" / "out", {"a.xml": MODEL}, main="a.xml")
    write_beside(tmp_path / "none" / "either" / "b.xml", {"a.xml": MODEL}, main="a.xml")
    assert (tmp_path / "no" / "such" / "out" / "a.xml").read_bytes() == MODEL
    assert (tmp_path / "none" / "either" / "b.xml").read_bytes() == MODEL


def test_a_parent_that_is_a_file(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match="cannot be created"):
        write_directory(tmp_path / "file" / "out", {"a.xml": MODEL}, main="a.xml")


def test_folders_made_for_a_failed_export_are_removed(tmp_path):
    with pytest.raises(OutputError, match="cannot be written"):
        write_directory(tmp_path / "no" / "out", {"a.xml": tmp_path / "gone"}, main="a.xml")
    assert not (tmp_path / "no").exists()
