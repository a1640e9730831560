"""Colors of the named materials of Gazebo Classic, whose scripts gz does not support."""

from __future__ import annotations

from typing import NamedTuple

Rgb = tuple[float, float, float]


class Color(NamedTuple):
    """A material: red, green and blue of each kind of light, and alpha."""

    ambient: Rgb
    diffuse: Rgb
    specular: Rgb = (0.1, 0.1, 0.1)
    emissive: Rgb = (0.0, 0.0, 0.0)
    alpha: float = 1.0


def _make_plain_color(rgb: Rgb, specular: Rgb = (0.1, 0.1, 0.1)) -> Color:
    return Color(rgb, rgb, specular)


def _make_glowing_color(rgb: Rgb) -> Color:
    return Color(rgb, rgb, (0.1, 0.1, 0.1), rgb)


def _make_transparent_color(rgb: Rgb, alpha: float = 0.5) -> Color:
    return Color(rgb, rgb, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), alpha)


_BLACK, _WHITE, _HALF = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (0.5, 0.5, 0.5)
"""Colors that several materials of Gazebo share."""

_RED, _GREEN, _BLUE = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
_YELLOW, _PURPLE, _TURQUOISE = (1.0, 1.0, 0.0), (1.0, 0.0, 1.0), (0.0, 1.0, 1.0)
_WOODEN = Color(_WHITE, _WHITE, (0.2, 0.2, 0.2))
_PAVED = Color((0.1, 0.1, 0.1), (0.8, 0.8, 0.8), (0.01, 0.01, 0.01))

COLORS: dict[str, Color] = {
    "Gazebo/Grey": Color((0.3, 0.3, 0.3), (0.7, 0.7, 0.7), (0.01, 0.01, 0.01)),
    "Gazebo/Gray": Color((0.3, 0.3, 0.3), (0.7, 0.7, 0.7), (0.01, 0.01, 0.01)),
    "Gazebo/DarkGrey": _make_plain_color((0.175, 0.175, 0.175), (0.175, 0.175, 0.175)),
    "Gazebo/DarkGray": _make_plain_color((0.175, 0.175, 0.175), (0.175, 0.175, 0.175)),
    "Gazebo/White": _make_plain_color(_WHITE),
    "Gazebo/FlatBlack": _make_plain_color((0.1, 0.1, 0.1), (0.01, 0.01, 0.01)),
    "Gazebo/Black": _make_plain_color(_BLACK),
    "Gazebo/Red": _make_plain_color(_RED),
    "Gazebo/RedBright": _make_plain_color((0.87, 0.26, 0.07), (0.87, 0.26, 0.07)),
    "Gazebo/Green": _make_plain_color(_GREEN),
    "Gazebo/Blue": _make_plain_color(_BLUE),
    "Gazebo/SkyBlue": Color((0.13, 0.44, 0.7), _BLUE),
    "Gazebo/Yellow": _make_plain_color(_YELLOW, _BLACK),
    "Gazebo/ZincYellow": _make_plain_color((0.9725, 0.9529, 0.2078), (0.9725, 0.9529, 0.2078)),
    "Gazebo/Purple": _make_plain_color(_PURPLE),
    "Gazebo/Turquoise": _make_plain_color(_TURQUOISE),
    "Gazebo/Orange": _make_plain_color((1.0, 0.5088, 0.0468), _HALF),
    "Gazebo/Indigo": _make_plain_color((0.33, 0.0, 0.5)),
    "Gazebo/Gold": Color((0.4, 0.24869, 0.020759), (0.8, 0.64869, 0.120759), (0.4, 0.4, 0.4)),
    "Gazebo/Pioneer2Body": Color(
        (0.481193, 0.000123, 0.000123), (0.681193, 0.000923, 0.000923), _HALF
    ),
    "Gazebo/WhiteGlow": _make_glowing_color(_WHITE),
    "Gazebo/RedGlow": _make_glowing_color(_RED),
    "Gazebo/GreenGlow": _make_glowing_color(_GREEN),
    "Gazebo/BlueGlow": _make_glowing_color(_BLUE),
    "Gazebo/YellowGlow": _make_glowing_color(_YELLOW),
    "Gazebo/PurpleGlow": _make_glowing_color(_PURPLE),
    "Gazebo/TurquoiseGlow": _make_glowing_color(_TURQUOISE),
    "Gazebo/TurquoiseGlowOutline": _make_glowing_color(_TURQUOISE),
    "Gazebo/LightOn": _make_glowing_color(_GREEN),
    "Gazebo/LightOff": _make_glowing_color(_RED),
    "Gazebo/JointAnchor": _make_glowing_color(_WHITE),
    "Gazebo/RedTransparent": _make_transparent_color(_RED),
    "Gazebo/GreenTransparent": _make_transparent_color(_GREEN),
    "Gazebo/BlueTransparent": _make_transparent_color(_BLUE),
    "Gazebo/GreyTransparent": _make_transparent_color(_HALF),
    "Gazebo/YellowTransparent": _make_transparent_color(_YELLOW),
    "Gazebo/RedTransparentOverlay": _make_transparent_color(_RED),
    "Gazebo/GreenTransparentOverlay": _make_transparent_color(_GREEN),
    "Gazebo/BlueTransparentOverlay": _make_transparent_color(_BLUE),
    "Gazebo/BlueLaser": _make_transparent_color(_BLUE, 0.4),
    "Gazebo/OrangeTransparent": _make_transparent_color((1.0, 0.44, 0.0), 0.4),
    "Gazebo/DarkYellow": _make_plain_color((0.7, 0.7, 0.0)),
    "Gazebo/DarkMagentaTransparent": _make_transparent_color((0.5, 0.0, 0.5)),
    "Gazebo/DarkOrangeTransparent": _make_transparent_color((1.0, 0.55, 0.0)),
    "Gazebo/LightBlueLaser": _make_transparent_color((0.5, 0.5, 1.0), 0.4),
    "Gazebo/PioneerBody": Color((0.5, 0.0, 0.0), _RED, (0.5, 0.0, 0.0)),
    "Gazebo/WoodFloor": Color(_HALF, _WHITE, _BLACK),
    "Gazebo/CeilingTiled": Color(_HALF, _WHITE, _BLACK),
    "Gazebo/PaintedWall": Color(_WHITE, _WHITE, _BLACK),
    "Gazebo/WoodPallet": Color(_HALF, _WHITE, _BLACK),
    "Gazebo/Wood": _WOODEN,
    "Gazebo/Bricks": _WOODEN,
    "Gazebo/WindowFrame": _WOODEN,
    "Gazebo/Road": _PAVED,
    "Gazebo/Residential": _PAVED,
    "Gazebo/Tertiary": _PAVED,
    "Gazebo/Secondary": _PAVED,
    "Gazebo/Primary": _PAVED,
    "Gazebo/Trunk": _PAVED,
    "Gazebo/Motorway": _PAVED,
    "Gazebo/Pedestrian": _PAVED,
    "Gazebo/Footway": _PAVED,
    "Gazebo/Steps": _PAVED,
    "Gazebo/Lane_1": _PAVED,
    "Gazebo/Lanes_2": _PAVED,
    "Gazebo/Lanes_4": _PAVED,
    "Gazebo/Lanes_6": _PAVED,
}
"""By name; those from ``PioneerBody`` on also have an image, which is lost."""

PICTURED = frozenset(list(COLORS)[list(COLORS).index("Gazebo/PioneerBody") :])
"""Names of the materials with an image."""
