"""Stages that are damaged, incomplete or hostile: one message with its place, exit code 2."""

import random
from contextlib import suppress

import pytest

from tests.cases import list_cases
from tests.formats.usd.stages import body, stage, turning
from urdftool.errors import ModelError

pytestmark = pytest.mark.library("pxr")

TWO = body("a"), body("b")
MASS = "        float physics:mass = 1"
CENTER = "point3f physics:centerOfMass = (0, 0, 0)"
REFERENCE = '#usda 1.0\n(\n    defaultPrim = "r"\n)\ndef Xform "r" (\n    prepend {}\n)\n{{\n}}\n'

BAD = {
    "truncated": ('#usda 1.0\ndef Xform "r"\n{\n', None),
    "not-text": (b"#usda 1.0\n\xff\xfe\x00", None),
    "binary": (b"PXR-USDC" + bytes(range(256)), None),
    "package": (b"PK\x03\x04" + bytes(100), None),
    "nothing": ("#usda 1.0\n", None),
    "reference": (REFERENCE.format("references = @./none.usda@"), 'def Xform "r"'),
    "payload": (REFERENCE.format("payload = @./none.usda@"), 'def Xform "r"'),
    "prim": (REFERENCE.format("references = </none>"), 'def Xform "r"'),
    "cycle": (REFERENCE.format("references = @./r.usda@"), 'def Xform "r"'),
    "layer": ("#usda 1.0\n(\n    subLayers = [@./none.usda@]\n)\n", None),
    "unit": (stage(*TWO, unit=0), None),
    "mass": (stage(body("a", mass="nan")), "float physics:mass = nan"),
    "huge": (stage(body("a", mass=1e38)), "float physics:mass = 1e+38"),
    "center": (stage(body("a").replace(CENTER, CENTER.replace("(0", "(nan"))), "point3f"),
    "kind": (stage(body("a").replace(MASS, '        string physics:mass = "1"')), "string"),
    "place": (stage(body("a", at="(inf, 0, 0)")), "uniform token[] xformOpOrder"),
    "scale": (
        stage(body("a").replace("xformOp:translate", "xformOp:scale")),
        "uniform token[] xformOpOrder",
    ),
    "limit": (
        stage(*TWO, turning("j", "a", "b", "        float physics:lowerLimit = nan")),
        "float physics:lowerLimit",
    ),
    "frame": (
        stage(*TWO, turning("j", "a", "b", "        point3f physics:localPos1 = (0, nan, 0)")),
        "point3f physics:localPos1",
    ),
    "axis": (stage(*TWO, turning("j", "a", "b").replace('"Z"', '"W"')), "uniform token physics:ax"),
    "size": (
        stage(
            body("a", more='        def Cube "c"\n        {\n            double size = nan\n}\n')
        ),
        "double size",
    ),
}


@pytest.mark.parametrize("name", list_cases(BAD, 3))
def test_a_bad_stage_is_an_error_at_its_place(name, write, tmp_path):
    from urdftool.formats.usd.read import read

    data, part = BAD[name]
    text = data.decode("latin-1") if isinstance(data, bytes) else data
    path = tmp_path / "r.usda"
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    if name in ("binary", "package"):
        path = path.rename(tmp_path / f"r.usd{'c' if name == 'binary' else 'z'}")
    with pytest.raises(ModelError) as error:
        read(path, mesh_folder=tmp_path / "meshes")
    assert error.value.at.file.path == str(path)
    if part:
        assert error.value.line == text[: text.index(part)].count("\n") + 1
    assert "0x" not in error.value.message
    assert not (tmp_path / "meshes").exists()


def test_export_of_a_bad_stage_writes_nothing(write, urdftool, tmp_path):
    path = write("r.usda", BAD["mass"][0])
    out = tmp_path / "out.urdf"
    result = urdftool("export", "urdf", path, "-o", str(out))
    assert result.code == 2
    assert len(result.err.strip().splitlines()) == 1
    assert result.err.startswith(f"{path}:")
    assert not out.exists()


@pytest.mark.parametrize("count", [4, pytest.param(100, marks=pytest.mark.slow)])
def test_changed_bytes_of_a_binary_stage_are_an_error_or_another_robot(count, write, tmp_path):
    from pxr import Sdf

    from urdftool.errors import UrdftoolError
    from urdftool.formats.usd.read import read

    start = tmp_path / "start.usdc"
    Sdf.Layer.FindOrOpen(str(write("r.usda", stage(*TWO, turning("j", "a", "b"))))).Export(
        str(start)
    )
    data, chance = start.read_bytes(), random.Random(1)
    for number in range(count):
        changed = bytearray(data)
        for _ in range(chance.choice((1, 2, 5, 20))):
            changed[chance.randrange(8, len(data))] = chance.randrange(256)
        path = tmp_path / f"{number}.usdc"
        path.write_bytes(bytes(changed))
        with suppress(UrdftoolError):  # any other exception fails the test
            read(path, mesh_folder=tmp_path / "meshes")


HEAD = 'defaultPrim = "r"'


@pytest.mark.parametrize(
    ("root", "code", "message"),
    [
        ('upAxis = "Z"', "", ""),
        ('upAxis = "Y"', "unread-units", "upAxis Z, not Y"),
        ('upAxis = "Q"', "unread-up-axis", "upAxis 'Q'"),
        ('upAxis = "Z"\n    metersPerUnit = 0.01', "unread-units", "metersPerUnit 1.0, not 0.01"),
        ('upAxis = "Z"\n    kilogramsPerUnit = 0.001', "unread-units", "1.0, not 0.001"),
    ],
)
def test_layers_of_other_units_are_reported(root, code, message, write, tmp_path):
    """OpenUSD takes units from the root layer only, so a referenced robot has another size."""
    from urdftool.formats.usd.read import read

    units = 'upAxis = "Z"\n    metersPerUnit = 1.0\n    kilogramsPerUnit = 1.0'
    part = f"#usda 1.0\n(\n    {HEAD}\n    {units}\n)\n"
    write("part.usda", part + stage(*TWO).partition("\n)\n")[2])
    names = [line.split()[0] for line in root.splitlines()]
    others = [line for line in units.splitlines() if line.split()[0] not in names]
    text = REFERENCE.format("references = @./part.usda@").replace(
        HEAD, "\n    ".join((HEAD, root, *(line.strip() for line in others)))
    )
    losses = read(write("r.usda", text), mesh_folder=tmp_path / "meshes").losses
    found = [loss for loss in losses if loss.code in ("unread-units", "unread-up-axis")]
    assert [loss.code for loss in found][:1] == [code][: bool(code)]
    assert any(message in loss.message for loss in found) or not code
