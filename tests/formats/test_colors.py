"""Colors of visuals in every format: of the material, of its first definition, of Gazebo."""

from __future__ import annotations

from pathlib import Path

import pytest

import urdftool
from tests.cases import list_cases
from urdftool.model.materials import find_shown_material

pytestmark = pytest.mark.usefixtures("stages_are_read_here")

RED, BLUE = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0)

ROBOT = """<robot name="r">
  {top}
  <link name="base">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><box size="1 1 1"/></geometry>{material}</visual>
  </link>
  {block}
</robot>"""

PAINT = '<material name="paint"><color rgba="{} 0 {} 1"/></material>'
RED_PAINT, BLUE_PAINT = PAINT.format(1, 0), PAINT.format(0, 1)


def load(tmp_path: Path, *, top: str = "", material: str = "", said: str = "") -> urdftool.Robot:
    """Read a robot of one link; ``said`` is its material in a block of Gazebo."""
    block = f'<gazebo reference="base"><material>{said}</material></gazebo>' if said else ""
    path = tmp_path / "r.urdf"
    path.write_text(ROBOT.format(top=top, material=material, block=block), "utf-8")
    return urdftool.load(path)


CASES = [
    ({"material": RED_PAINT}, RED),
    ({"top": RED_PAINT, "material": '<material name="paint"/>'}, RED),
    ({"top": RED_PAINT, "material": BLUE_PAINT}, RED),
    ({"said": "Gazebo/Blue"}, BLUE),
    ({"material": RED_PAINT, "said": "Gazebo/Blue"}, RED),
    ({"material": '<material name="missing"/>', "said": "Gazebo/Blue"}, BLUE),
    ({"said": "Shop/Blue"}, None),
]


@pytest.mark.parametrize(("robot", "color"), list_cases(CASES, 2))
def test_one_color_in_the_model_and_the_exports(
    tmp_path: Path, robot: dict[str, str], color: tuple[float, ...] | None
) -> None:
    """Show in MJCF and USD the color that the model has."""
    read = load(tmp_path, **robot)
    link = read.link["base"]
    shown = find_shown_material(read, link, link.visuals[0])
    assert (None if shown is None else shown.color) == color
    for name in ("mjcf", "usd"):
        pytest.importorskip({"mjcf": "mujoco", "usd": "pxr"}[name])
        target = tmp_path / name
        getattr(urdftool, f"export_{name}")(read, target)
        back = urdftool.load(next(target.glob("r.*")))
        there = back.link["base"]
        found = find_shown_material(back, there, there.visuals[0])
        plain = (0.5, 0.5, 0.5, 1.0) if name == "mjcf" else None
        rgba = plain if found is None else found.color
        assert rgba == (plain if color is None else pytest.approx(color, abs=4e-3))


LOST = [
    ({"said": "Shop/Blue"}, "is a script of Gazebo; the visual has no color", "warning"),
    ({"said": "Shop/Blue", "material": RED_PAINT}, "own material is kept", "info"),
    ({"material": '<material name="missing"/>'}, "'missing' is not defined", "warning"),
]


@pytest.mark.parametrize("name", ["mjcf", "usd"])
@pytest.mark.parametrize(("robot", "message", "severity"), LOST)
def test_unknown_colors_are_reported(
    tmp_path: Path, name: str, robot: dict[str, str], message: str, severity: str
) -> None:
    """Report once what is not written, and what is written instead."""
    pytest.importorskip({"mjcf": "mujoco", "usd": "pxr"}[name])
    exported = getattr(urdftool, f"export_{name}")(load(tmp_path, **robot), tmp_path / name)
    codes = ("lossy-material", "undefined-material")
    [loss] = [one for one in exported.losses if one.code in codes]
    assert message in loss.message
    assert loss.severity.name.lower() == severity


@pytest.mark.parametrize("robot", [{"material": RED_PAINT}, {"said": "Gazebo/Blue"}])
def test_a_color_that_is_gone_is_a_difference(tmp_path: Path, robot: dict[str, str]) -> None:
    """Compare a robot with one whose visual has no color."""
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    one, two = load(tmp_path / "a", **robot), load(tmp_path / "b")
    pytest.importorskip("pxr")
    urdftool.export_usd(two, tmp_path / "usd")
    back = urdftool.load(next((tmp_path / "usd").glob("r.*")))
    agreement = urdftool.verify(one, back, only=["colors"])
    assert not agreement.is_equal


@pytest.mark.parametrize(("name", "needs"), [("mjcf", "mujoco"), ("usd", "pxr"), ("sdf", "lxml")])
def test_the_first_definition_of_a_name_is_proved(tmp_path: Path, name: str, needs: str) -> None:
    pytest.importorskip(needs)
    robot = load(tmp_path, top=RED_PAINT, material=BLUE_PAINT)
    result = getattr(urdftool, f"export_{name}")(robot, tmp_path / name, verify=True)
    assert [one.verdict for one in result.checks if one.name == "colors"] == ["equal"]


SEEN_THROUGH = """<sdf version="1.9"><model name="r"><link name="base">
<visual name="v"><geometry><box><size>1 1 1</size></box></geometry>{}</visual>
</link></model></sdf>"""
RED_OF_SDF = "<material><diffuse>1 0 0 {}</diffuse></material>"


@pytest.mark.parametrize("kind", ["mjcf", "usd", "urdf"])
@pytest.mark.parametrize(
    ("alpha", "transparency", "shown"), [(1, "<transparency>0.3</transparency>", 0.7), (0.5, "", 1)]
)
def test_transparency_of_sdf_is_the_alpha_of_other_formats(
    tmp_path: Path, kind: str, alpha: float, transparency: str, shown: float
) -> None:
    """Write what Gazebo shows, which ignores the alpha of ``<diffuse>``."""
    pytest.importorskip({"mjcf": "mujoco", "usd": "pxr", "urdf": "lxml"}[kind])
    source = tmp_path / "r.sdf"
    source.write_text(SEEN_THROUGH.format(RED_OF_SDF.format(alpha) + transparency), "utf-8")
    export = getattr(urdftool, f"export_{kind}")
    written = export(urdftool.load(source), tmp_path / kind, verify=True)
    assert {c.name: c.differing for c in written.checks if c.differing} == {}
    target = next((tmp_path / kind).glob("r.*"))
    (visual,) = urdftool.load(target).link["base"].visuals
    assert visual.material is not None
    assert visual.material.color == pytest.approx((1, 0, 0, shown), abs=4e-3)
    differences = urdftool.verify(source, target).list_disagreements()
    assert [one for one in differences if one.row == "colors"] == []


def test_a_transparency_without_a_color_is_reported(tmp_path: Path) -> None:
    source = tmp_path / "r.sdf"
    source.write_text(SEEN_THROUGH.format("<transparency>0.3</transparency>"), "utf-8")
    losses = urdftool.export_mjcf(urdftool.load(source)).losses
    assert any("transparency of a visual is dropped" in loss.message for loss in losses)
