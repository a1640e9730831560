"""Values that rules on meshes and shapes give to fixes and other programs."""

import pytest

from urdftool.api.lint import check

SHOWN = '<link name="l{0}"><visual><geometry><mesh filename="{1}"/></geometry></visual></link>'


def _data(folder, rule, *links):
    file = folder / "robot.urdf"
    file.write_text("\n".join(('<robot name="r">', *links, "</robot>")))
    return [dict(finding.data) for finding in check(file, select=[rule])]


def test_folder_of_another_machine_is_named(tmp_path):
    uris = [f"/nowhere/meshes/{letter}.stl" for letter in "abcd"]
    links = [SHOWN.format(number, uri) for number, uri in enumerate(uris)]
    assert _data(tmp_path, "absolute-path", *links) == [
        {"uri": uris[0], "folder": "/nowhere/meshes"}
    ]
    assert _data(tmp_path, "absolute-path", *links[:2]) == [{"uri": uri} for uri in uris[:2]]


@pytest.mark.parametrize(
    ("uri", "defect"),
    [
        ("", "empty"),
        ("package:/arm/a.stl", "lacks slash"),
        ("package://arm", "no file"),
        (r"meshes\\a.stl", "backslash"),
        ("meshes/a.stl ", "outer blank"),
        ("package://arm//a.stl", "double slash"),
        ("package://arm/an arm.stl", "blank"),
    ],
)
def test_defect_of_a_uri_is_named(tmp_path, uri, defect):
    (data,) = _data(tmp_path, "malformed-uri", SHOWN.format(0, uri))
    assert data == {"uri": uri, "defect": defect}


@pytest.mark.parametrize(
    ("rgba", "right"),
    [
        ("255 100 51 255", "1 0.3922 0.2 1"),
        ("255 0 51 1", "1 0 0.2 1"),
        ("1.5 0 -1 0.5", "1 0 0 0.5"),
    ],
)
def test_color_to_write(tmp_path, rgba, right):
    material = f'<material name="m"><color rgba="{rgba}"/></material>'
    assert _data(tmp_path, "invalid-color", material) == [{"write": right}]


def test_shape_that_is_meant(tmp_path):
    link = '<link name="l"><visual><geometry><{} size="1 1 1"/></geometry></visual></link>'
    for tag, near in (("boxx", "box"), ("cone", "")):
        found = _data(tmp_path, "unsupported-shape", link.format(tag))
        assert found == [{"tag": tag, "suggestion": near}]
