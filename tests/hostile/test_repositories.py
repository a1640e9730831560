"""Repositories that run programs, write files or lead to the packages of others."""

import os
import subprocess

import pytest

SECRET = "qX7private"
ROBOT = '<robot name="r"><link name="a"/></robot>\n'


def git(folder, *words):
    identity = ["-c", "user.name=n", "-c", "user.email=e@example.org"]
    return subprocess.run(
        ["git", "-C", str(folder), *identity, *words], check=True, capture_output=True
    ).stdout


@pytest.fixture
def repository(tmp_path):
    folder = tmp_path / "project"
    folder.mkdir()
    git(folder, "init", "-q")
    (folder / "r.urdf").write_text(ROBOT)
    git(folder, "add", ".")
    git(folder, "commit", "-qm", "robot")
    return folder


@pytest.mark.parametrize(
    "words", [("diff", "HEAD:r.urdf", "r.urdf"), ("bundle", "r.urdf", "-o", "o")]
)
def test_a_missing_object_is_not_fetched(repository, urdftool, monkeypatch, words):
    mark = repository.parent / "mark"
    tree = git(repository, "rev-parse", "HEAD^{tree}").decode().strip()
    for name, value in {
        "core.repositoryformatversion": "1",
        "extensions.partialClone": "origin",
        "remote.origin.url": f"ext::sh -c touch% {mark}",
        "remote.origin.promisor": "true",
        "protocol.ext.allow": "always",
    }.items():
        git(repository, "config", name, value)
    (repository / ".git" / "objects" / tree[:2] / tree[2:]).unlink()
    monkeypatch.chdir(repository)
    urdftool(*words)
    assert not mark.exists()


def test_links_of_a_revision_do_not_lead_out(repository, urdftool, monkeypatch):
    victim = repository.parent / "victim"
    victim.mkdir()
    (repository / "d").symlink_to("x/y/../../..")
    (repository / "out").symlink_to(str(victim))
    (repository / "chain").symlink_to("d/../victim")
    git(repository, "add", ".")
    git(repository, "commit", "-qm", "links")
    monkeypatch.chdir(repository)
    done = urdftool("diff", "HEAD:r.urdf", "r.urdf")
    assert done.code == 0, done.err
    assert os.listdir(victim) == []


def test_a_link_of_the_project_does_not_open_the_packages_of_others(
    repository, urdftool, monkeypatch
):
    other = repository.parent / "other" / "private"
    other.mkdir(parents=True)
    (other / "package.xml").write_text("<package><name>private</name></package>")
    (other / "keys.yaml").write_text(f"key: {SECRET}\n")
    (repository / "pkg").mkdir()
    (repository / "pkg" / "package.xml").write_text("<package><name>pkg</name></package>")
    (repository / "dep").symlink_to(other.parent)
    text = "<link name=\"${xacro.load_yaml('$(find private)/keys.yaml')['key']}\"/>"
    path = repository / "pkg" / "r.xacro"
    path.write_text(f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">{text}</robot>')
    monkeypatch.chdir(repository)
    done = urdftool("expand", str(path))
    assert done.code == 2
    assert SECRET not in done.out + done.err
