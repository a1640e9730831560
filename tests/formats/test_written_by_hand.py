"""Exports of one robot, compared with values that were written by hand from the specifications."""

import re
from xml.etree import ElementTree

import pytest

from tests.conftest import FIXTURES

FOLDER = FIXTURES / "formats" / "golden"
MAIN = {"urdf": "robot.urdf", "sdf": "robot.sdf", "mjcf": "robot.xml", "usd": "robot.usda"}
SINGLE = 2e-6
"""Relative tolerance: USD stores single precision; the files have six digits at least."""

FORMATS = [
    "urdf",
    "sdf",
    pytest.param("mjcf", marks=pytest.mark.library("mujoco")),
    pytest.param("usd", marks=pytest.mark.library("pxr")),
]


def read_lines(form):
    """Return the place and the value of each line."""
    lines = (FOLDER / f"{form}.txt").read_text("utf-8").splitlines()
    pairs = [line.partition(" = ") for line in lines if not line.startswith("#")]
    return {place: value for place, _, value in pairs}


def get_from_xml(root, place):
    path, _, attribute = re.fullmatch(r"((?:\[[^]]*\]|[^@[])*)(@(\w+))?", place).groups()
    found = root.findall(path)
    assert len(found) == 1, (place, len(found))
    return found[0].get(attribute) if attribute else found[0].text


def get_from_layer(layer, place):
    prim, _, attribute = place.partition(" ")
    spec = layer.GetAttributeAtPath(f"/golden/{prim}.{attribute}")
    assert spec is not None, place
    value = spec.default
    if hasattr(value, "GetReal"):
        return (value.GetReal(), *value.GetImaginary())
    return value if isinstance(value, str | int | float) else tuple(value)


def is_equal(value, text):
    words = text.split()
    given = value.split() if isinstance(value, str) else value
    given = given if isinstance(given, tuple | list) else (given,)
    if not re.fullmatch(r"[-\d. ]+", text):
        return list(given) == words
    return [float(one) for one in given] == pytest.approx([float(one) for one in words], SINGLE)


def list_wrong(form, text):
    """Return the places of which the text of an export has another value."""
    if form == "usd":
        from pxr import Sdf

        root, get = Sdf.Layer.CreateAnonymous(".usda"), get_from_layer
        assert root.ImportFromString(text)
    else:
        root, get = ElementTree.fromstring(text), get_from_xml
        root = root.find("model") if form == "sdf" else root
    return [
        place for place, value in read_lines(form).items() if not is_equal(get(root, place), value)
    ]


@pytest.mark.parametrize("form", FORMATS)
def test_export_has_the_values_that_were_written_by_hand(form, urdftool, tmp_path):
    path = tmp_path / MAIN[form]
    assert urdftool("export", form, FOLDER / "robot.urdf", "-o", path).code == 0
    assert list_wrong(form, path.read_text("utf-8")) == []


NUMBER = re.compile(r"(?<![\w.:-])-?\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.:])")

CONVENTIONS = {
    "urdf": ("version",),
    "sdf": ("<sdf version", "base_fixed", "__model__"),
    "mjcf": (
        "<geom contype",
        "<geom group",
        "<position ",
        "<key ",
        "<numeric ",
        "priority",
        "<joint sol",
    ),
    "usd": (
        *("customLayerData", "PerUnit", "timeCodes", "usda", "extent", "xformOp:orient", "state:"),
        *("inputs:metallic", "inputs:roughness", "newton:self", "physxArticulation:"),
        *("physics:damping", "physics:stiffness", "physics:targetPosition", "principalAxes"),
        *("FrictionCoefficient", "FrictionEffort", "localPos0 = (0, 0, 0)", "localPos1 = (0"),
        *("localRot", "translate = (0, 0, 0)", "centerOfMass = (0, 0, 0)"),
    ),
}
"""Lines with numbers that the format or an option defines, not the robot; axes of any sign."""


@pytest.mark.parametrize("form", FORMATS)
def test_a_wrong_number_is_noticed(form, urdftool, tmp_path):
    path = tmp_path / MAIN[form]
    urdftool("export", form, FOLDER / "robot.urdf", "-o", path)
    text, missed, count = path.read_text("utf-8"), [], 0
    for match in NUMBER.finditer(text):
        start = text.rfind("\n", 0, match.start()) + 1
        line = text[start : text.find("\n", match.start())]
        if line.strip().startswith(("<?", "<!--", "#")) or any(
            w in line for w in CONVENTIONS[form]
        ):
            continue
        count += 1
        changed = f"{text[: match.start()]}{float(match[0]) * 1.25 + 0.5}{text[match.end() :]}"
        if not list_wrong(form, changed):
            missed.append((line.strip(), match[0]))
    assert count > 60
    assert missed == []
