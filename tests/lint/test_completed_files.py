"""MJCF files that the code of a project completes before it loads them."""

import json

import pytest

from urdftool.api.lint import check

pytestmark = pytest.mark.library("mujoco")

MODEL = """<mujoco><asset><mesh name="m" file="{mesh}"/></asset><worldbody><body>
<geom type="mesh" mesh="m"/></body></worldbody></mujoco>
"""
PART = """<mujoco><worldbody><body><geom class="cube" type="box" size="1 1 1"/></body></worldbody>
</mujoco>
"""


def _lint(urdftool, tmp_path, code, texts):
    module = tmp_path / "gym"
    module.mkdir()
    (tmp_path / "pyproject.toml").write_text('[project]\nname = "gym"\n')
    (module / "env.py").write_text(code)
    for number, text in enumerate(texts):
        (module / f"scene{number}.xml").write_text(text)
    result = urdftool("lint", tmp_path, "--format", "json")
    return json.loads(result.out), result


@pytest.mark.parametrize(
    ("code", "mesh", "cause"),
    [
        ("URL = 'https://x/simhive.git'", "../simhive/a.stl", "folder 'simhive' is missing"),
        ("m = MjModel.from_xml_string(text, assets=files)", "a.stl", "hands files over as assets"),
        ("URL = 'simhives'", "../simhive/a.stl", ""),
        (
            "SPEC = ('gym/assets', 'a.stl')\n" + "\n" * 500 + "hf_hub_download(SPEC)",
            "assets/a.stl",
            "folder 'assets' is missing",
        ),
        ("SPEC = 'gym/assets'", "assets/a.stl", ""),
        ("hf_hub_download('other/assets')", "assets/a.stl", ""),
        (
            "TEXT = 'Do not load this.'\nMjModel.from_xml_path('a')",
            "Do not load this./a.stl",
            "code of the project replaces 'Do not load this.'",
        ),
        ("MjModel.from_xml_path('a')", "Do not load this./a.stl", ""),
        (
            "URL = 'https://x'" + "\n" * 500 + "for side in 'left', 'right': pass",
            "../left/a.stl",
            "",
        ),
        ("m = MjModel.from_xml_path('a')", "../assets/a.stl", ""),
        ("# assets\nm = MjModel.from_xml_path('a')", "../assets/a.stl", ""),
        ("from_xml_string(text, assets=files); from_xml_path('a')", "a.stl", ""),
    ],
)
def test_files_that_code_completes_are_not_checked_and_no_errors(
    urdftool, tmp_path, code, mesh, cause
):
    report, result = _lint(urdftool, tmp_path, code, [MODEL.format(mesh=mesh)] * 3)
    rules = {finding["rule"] for finding in report["findings"]}
    assert result.code == 2
    assert len(report["summary"]["not_checked"]) == 3
    assert rules == (set() if cause else {"unreadable-model"})
    assert (f"{cause}" in result.err and "3 files" in result.err) or not cause
    if cause:
        assert result.err.count("lint what the program loads") == 1


@pytest.mark.parametrize(
    ("code", "reported"), [("part = mjcf.from_path('a')", False), ("import mujoco", True)]
)
def test_a_part_that_a_program_merges_is_no_error(urdftool, tmp_path, code, reported):
    report, result = _lint(urdftool, tmp_path, code, [PART])
    assert ("unreadable-model" in {one["rule"] for one in report["findings"]}) is reported
    assert result.code == 2


def test_a_defect_of_the_file_itself_is_an_error(urdftool, tmp_path):
    text = PART.replace("<worldbody>", '<option apirate="1"/><worldbody>', 1)
    code = "m = MjModel.from_xml_string(text, assets=files)\npart = mjcf.from_path('a')"
    report, _ = _lint(urdftool, tmp_path, code, [text])
    assert {finding["rule"] for finding in report["findings"]} == {"unreadable-model"}


ROBOT = """<robot name="r"><link name="a"><visual><geometry><mesh filename="a.stl"/></geometry>
</visual></link></robot>"""
READS = "root = ElementTree.fromstring(Path('r.urdf').read_text())\nmesh = path.read_bytes()\n"


@pytest.mark.parametrize(
    ("code", "elsewhere", "severity"),
    [
        (READS, True, "info"),
        (READS, False, "error"),
        (READS.replace("r.urdf", "other.urdf"), True, "error"),
        ("load('r.urdf')\n", True, "error"),
        ("", True, "error"),
    ],
)
def test_a_mesh_that_code_hands_over_is_no_error(tmp_path, code, elsewhere, severity):
    (tmp_path / "pyproject.toml").write_text("[project]\n")
    (tmp_path / "env.py").write_text(code)
    for name in ("robots", "meshes"):
        (tmp_path / name).mkdir()
    if elsewhere:
        (tmp_path / "meshes" / "a.stl").write_bytes(b"")
    path = tmp_path / "robots" / "r.urdf"
    path.write_text(ROBOT)
    found = check(path, select=["mesh-not-found"])
    assert [one.severity.label for one in found] == [severity]
