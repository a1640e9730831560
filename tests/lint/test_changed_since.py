"""Robots that changed files concern, whatever the way in which they are named."""

import os
import subprocess

import pytest

ROBOT = '<robot name="r"><link name="a">%s</link></robot>'
MESH = '<visual><geometry><mesh filename="%s"/></geometry></visual>'
MODEL = '<sdf version="1.9"><model name="%s">%s</model></sdf>'
YAML = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="id" default="x"/>'
    '<xacro:property name="c" value="${xacro.load_yaml(\'$(find calib)/%s\')}"/>'
    '<link name="${c}"/></robot>'
)


def git(folder, *words):
    command = ["git", "-c", "user.name=a", "-c", "user.email=a@b.c", *words]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


def commit(root, files):
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    for words in (["init", "-q"], ["add", "."], ["commit", "-qm", "all"]):
        git(root, *words)


def select(urdftool, root):
    """Return the names of the concerned robots as ``--list`` prints them."""
    result = urdftool("lint", root, "--list", "--changed-since", "HEAD")
    assert result.code == 0
    lines = result.out.splitlines()
    robots = (line.partition("  ")[0] for line in lines if line and not line.startswith(" "))
    return {os.path.relpath(path, root) for path in robots if "no robot" not in path}


CASES = {
    "mjcf through two files": (
        {
            "a.xml": '<mujoco><include file="b.xml"/><worldbody/></mujoco>',
            "b.xml": '<mujocoinclude><include file="c.xml"/></mujocoinclude>',
            "sub/c.xml": "<mujocoinclude/>",
        },
        "sub/c.xml",
        {"a.xml"},
    ),
    "sdf by its folder": (
        {
            "a/model.sdf": MODEL % ("a", "<include><uri>model://b</uri></include>"),
            "b/model.sdf": MODEL % ("b", '<link name="l"/>'),
            "c/model.sdf": MODEL % ("c", '<link name="l"/>'),
        },
        "b/model.sdf",
        {"a/model.sdf", "b/model.sdf"},
    ),
    "texture of a mesh": (
        {
            "r.urdf": ROBOT % (MESH % "m/a.dae"),
            "m/a.dae": "<init_from>t%20one.png</init_from>",
            "t/t one.png": "",
            "s.urdf": ROBOT % (MESH % "m/b.dae"),
        },
        "t/t one.png",
        {"r.urdf"},
    ),
    "part of a name": (
        {"a/r.urdf": ROBOT % (MESH % "../m/left_arm.stl"), "m/arm.stl": ""},
        "m/arm.stl",
        set(),
    ),
    "computed by xacro": (
        {"a/r.urdf.xacro": YAML % "$(arg id)_of.yaml", "calib/x_of.yaml": "b"},
        "calib/x_of.yaml",
        {"a/r.urdf.xacro"},
    ),
    "computed in Python": (
        {"a/r.urdf.xacro": YAML % "' + 'x' + '_of.yaml", "calib/x_of.yaml": "b"},
        "calib/x_of.yaml",
        {"a/r.urdf.xacro"},
    ),
    "other file of a computed kind": (
        {"a/r.urdf.xacro": YAML % "$(arg id)_of.yaml", "calib/x.yaml": "b"},
        "calib/x.yaml",
        set(),
    ),
}


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(case, marks=[pytest.mark.library("mujoco")] * case.startswith("mjcf"))
        for case in CASES
    ],
)
def test_a_changed_file_concerns_what_names_it(tmp_path, urdftool, case):
    files, changed, expected = CASES[case]
    commit(tmp_path, files)
    assert select(urdftool, tmp_path) == set()
    (tmp_path / changed).write_text(files[changed] + "\n")
    found = select(urdftool, tmp_path)
    assert {name for name in found if name in files} == expected


@pytest.mark.parametrize("change", ["target", "link", "folder"])
def test_a_changed_link_concerns_what_names_it(tmp_path, urdftool, change):
    commit(tmp_path, {"a/r.urdf": ROBOT % (MESH % "../m/mesh.stl"), "v/1.stl": "1", "v/2.stl": "2"})
    (tmp_path / "m").mkdir()
    (tmp_path / "m/mesh.stl").symlink_to("../v/1.stl")
    (tmp_path / "all").symlink_to("v")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "-qm", "links")
    assert select(urdftool, tmp_path) == set()
    if change == "target":
        (tmp_path / "v/1.stl").write_text("3")
    else:
        link, target = ("m/mesh.stl", "../v/2.stl") if change == "link" else ("all", "m")
        (tmp_path / link).unlink()
        (tmp_path / link).symlink_to(target)
    assert select(urdftool, tmp_path) == {"a/r.urdf"}


@pytest.mark.parametrize("change", ["edited", "moved", "unknown"])
def test_a_submodule_is_searched(tmp_path, urdftool, change):
    commit(tmp_path / "sub", {"s.urdf": ROBOT % "", "t/t.urdf": ROBOT % ""})
    commit(tmp_path, {"r.urdf": ROBOT % ""})
    assert select(urdftool, tmp_path) == set()
    (tmp_path / "sub/t/t.urdf").write_text(ROBOT % "<visual/>")
    expected = {"sub/t/t.urdf"}
    if change != "edited":
        git(tmp_path / "sub", "commit", "-qam", "moved")
    if change == "unknown":  # the commit that the outer repository names
        git(tmp_path / "sub", "checkout", "-q", "--orphan", "new")
        git(tmp_path / "sub", "commit", "-qm", "new")
        git(tmp_path / "sub", "branch", "-qD", "-f", *branches(tmp_path / "sub"))
        git(tmp_path / "sub", "reflog", "expire", "--expire=now", "--all")
        git(tmp_path / "sub", "gc", "-q", "--prune=now")
        expected = {"r.urdf", "sub/s.urdf", "sub/t/t.urdf"}
    assert select(urdftool, tmp_path) == expected


def branches(folder):
    words = ["git", "for-each-ref", "--format=%(refname:short)", "refs/heads"]
    listed = subprocess.run(words, cwd=folder, check=True, capture_output=True, text=True).stdout
    return [name for name in listed.split() if name != "new"]


def test_no_filter_of_the_repository_runs(tmp_path, urdftool):
    commit(tmp_path / "sub", {"s.urdf": ROBOT % ""})
    commit(tmp_path, {"r.urdf": ROBOT % "", "crlf.urdf": ROBOT % ""})
    ran = tmp_path / "ran"
    for folder in (tmp_path, tmp_path / "sub"):
        git(folder, "config", "filter.x.clean", f"sh -c 'touch {ran}; cat'")
        (folder / ".git/info/attributes").write_text("* filter=x")
    for name in ("r.urdf", "sub/s.urdf"):
        os.utime(tmp_path / name, (1, 1))
    (tmp_path / "crlf.urdf").write_text(ROBOT % "\r\n", newline="")
    assert select(urdftool, tmp_path) == {"crlf.urdf"}
    assert not ran.exists()


def test_a_repository_whose_files_git_cannot_list_is_an_error(tmp_path, urdftool):
    commit(tmp_path, {"r.urdf": ROBOT % ""})
    (tmp_path / ".git/index").write_bytes(b"damaged")
    result = urdftool("lint", tmp_path, "--changed-since", "HEAD")
    assert result.code == 2
    assert "git cannot list its files" in result.err
