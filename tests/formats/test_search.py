"""Descriptions in SDF and MJCF below folders."""

import json

import pytest

from urdftool.formats.search import find_other_descriptions

SDF = '<sdf version="1.9"><model name="m"><link name="{}"/></model></sdf>'
MJCF = '<mujoco><worldbody><body name="{}"><geom size="1"/></body></worldbody></mujoco>'
FILES = {
    "robot/model.sdf": SDF.format("a"),
    "worlds/empty.sdf": '<sdf version="1.9"><world name="w"/></sdf>',
    "worlds/full.sdf": '<sdf version="1.9"><world name="w"><include><uri>model://m</uri></include>'
    "</world></sdf>",
    "worlds/fleet.sdf": '<sdf version="1.9"><model name="m"><include><uri>model://m</uri>'
    "</include></model></sdf>",
    "arm/scene.xml": '<!-- a --><mujoco><include file="arm.xml"/></mujoco>',
    "arm/arm.xml": MJCF.format("arm") + '<!-- <include file="parts/hand.xml"/> -->',
    "arm/parts/hand.xml": MJCF.format("hand"),
    "arm/assets.xml": "<mujoco><asset/></mujoco>",
    "arm/shared.xml": "<mujocoinclude/>",
    "alone.mjcf": MJCF.format("alone"),
    "package.xml": "<package/>",
    "launch/view.launch.xml": "<launch/>",
    ".git/robot.sdf": SDF.format("hidden"),
    "notes.sdf": "not XML",
}


@pytest.fixture
def folder(tmp_path):
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path


def relative(paths, folder):
    return sorted(str(path).removeprefix(f"{folder}/") for path in paths)


@pytest.mark.library("mujoco")
def test_robots_are_found_by_content(folder):
    found = find_other_descriptions([str(folder), str(folder / "package.xml")])
    assert relative(found.files, folder) == [
        "alone.mjcf", "arm/scene.xml", "robot/model.sdf", "worlds/fleet.sdf"
    ]  # fmt: skip
    assert relative(found.skipped, folder) == [
        *("arm/arm.xml", "arm/assets.xml", "arm/parts/hand.xml", "arm/shared.xml"),
        *("worlds/empty.sdf", "worlds/full.sdf"),
    ]
    assert find_other_descriptions([str(folder / "arm/scene.xml")]).files == []


def test_without_mujoco_mjcf_is_not_checked(folder, monkeypatch, urdftool):
    monkeypatch.setattr("urdftool.formats.search.is_installed", lambda name: False)
    found = find_other_descriptions([str(folder)])
    assert relative(found.files, folder) == ["robot/model.sdf", "worlds/fleet.sdf"]
    reason = found.not_checked[str(folder / "alone.mjcf")]
    assert "pip install 'urdftool[mujoco]'" in reason
    result = urdftool("lint", folder, "--no-cache", "-j", "1")
    assert result.code == 2
    last = result.err.splitlines()[-1]
    assert "3 not checked" in last  # and fleet.sdf, which includes a model that is not there
    assert "alone.mjcf" in last
    assert "arm/scene.xml" in last


@pytest.mark.library("mujoco")
def test_lint_checks_a_folder_of_all_formats(urdftool, folder):
    (folder / "r.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    (folder / "worlds/fleet.sdf").unlink()
    result = urdftool("lint", folder, "--format", "json", "--no-cache", "--exit-zero", "-j", "1")
    report = json.loads(result.out)
    checked = {finding["path"].removeprefix(f"{folder}/") for finding in report["findings"]}
    assert {"robot/model.sdf"} <= checked
    assert "in 4 files" in result.err
    assert "worlds/empty.sdf" in result.err
    only = urdftool("lint", folder / "worlds", "--no-cache")
    assert (only.code, "SDF without a link of its own" in only.err) == (0, True)


def test_what_is_not_read_is_printed_once_for_a_folder(urdftool, tmp_path):
    for name in "abc":
        text = SDF.format(name).replace("/></model>", '><light name="l"/></link></model>')
        (tmp_path / f"{name}.sdf").write_text(text)
    words = ("lint", tmp_path, "--no-cache", "--exit-zero", "-j", "1")
    result = urdftool(*words)
    assert result.err.count("[unread-light]") == 1
    assert "[unread-light] (and in 2 more files)" in result.err
    assert urdftool("-v", *words).err.count("[unread-light]") == 3
