"""Exports with ``--srdf``: the pairs, and what is known of them."""

import pytest

pytest.importorskip("fcl")

import urdftool as api
from tests.srdf.test_prove import sphere_arm

SRDF = """<robot name="r">
  <disable_collisions link1="post" link2="tip" reason="{}"/>
</robot>
"""
SOLID = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'


def write_robot(write, gap, reason):
    text = sphere_arm(gap)
    for name in ("post", "tip"):
        text = text.replace(f'<link name="{name}">', f'<link name="{name}">{SOLID}</inertial>')
    text = text.replace('<link name="bare"/>', f'<link name="bare">{SOLID}</inertial></link>')
    write("r.urdf", text)
    write("r.srdf", SRDF.format(reason))


CASES = [
    (0.01, "Never", "Never, proved never to touch", []),
    (-0.001, "Never", "Never, can touch", ["disabled-pair-can-touch"]),
    (-0.001, "User", "User, can touch", []),
    (-0.001, "x -- y", "another reason, can touch", ["disabled-pair-can-touch"]),
    (0.00002, "Never", "Never, not proved", ["srdf-pair-open"]),
]


@pytest.mark.parametrize(("gap", "reason", "text", "codes"), CASES)
def test_mjcf_excludes_a_pair_with_its_proof(write, tmp_path, gap, reason, text, codes):
    write_robot(write, gap, reason)
    written = api.export_mjcf(api.load("r.urdf"), "out", srdf="r.srdf")
    model = (tmp_path / "out" / written.main).read_text("utf-8")
    assert f'<!-- {text} -->\n    <exclude body1="post" body2="tip"/>' in model
    known = ("disabled-pair-can-touch", "srdf-pair-open")
    assert [loss.code for loss in written.losses if loss.code in known] == codes


@pytest.mark.parametrize(("gap", "reason", "text", "codes"), CASES[:3])
def test_usd_filters_a_pair_with_its_proof(write, tmp_path, gap, reason, text, codes):
    pxr = pytest.importorskip("pxr.Usd")
    write_robot(write, gap, reason)
    written = api.export_usd(api.load("r.urdf"), "out.usda", srdf="r.srdf")
    stage = pxr.Stage.Open(str(tmp_path / "out.usda"))
    texts = [
        data["urdf"]["filteredPairs"]
        for prim in stage.Traverse()
        if "filteredPairs" in (data := prim.GetCustomData()).get("urdf", {})
    ]
    assert texts == [f"post, tip: {text}"]
    assert [loss.code for loss in written.losses if loss.code in CASES[1][3]] == codes


@pytest.mark.parametrize("form", ["mjcf", "usd"])
def test_strict_refuses_a_pair_that_can_touch(urdftool, write, tmp_path, form):
    write_robot(write, -0.001, "Never")
    result = urdftool("export", form, "r.urdf", "--srdf", "r.srdf", "-o", "out", "--strict")
    assert result.code == 2
    assert "r.srdf:2:3: error: links 'post' and 'tip' have no contact" in result.err
    assert not (tmp_path / "out").exists()


def test_without_the_library_the_pairs_are_taken_over(write, monkeypatch):
    write_robot(write, -0.001, "Never")
    monkeypatch.setattr("urdftool.extras.is_installed", lambda library: library != "fcl")
    written = api.export_mjcf(api.load("r.urdf"), None, srdf="r.srdf")
    (note,) = [loss for loss in written.losses if loss.code == "srdf-pair-open"]
    assert "without proof" in note.message
    assert 'body1="post" body2="tip"' in str(written.files[written.main])
