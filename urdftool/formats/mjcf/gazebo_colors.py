"""Colors of Gazebo Classic's material scripts, by the name in ``<gazebo><material>``."""

from __future__ import annotations

from ...model.elements import Robot

# diffuse colors of media/materials/scripts/gazebo.material
COLORS: dict[str, tuple[float, float, float, float]] = {
    "Black": (0, 0, 0, 1),
    "Blue": (0, 0, 1, 1),
    "BlueGlow": (0, 0, 1, 1),
    "BlueTransparent": (0, 0, 1, 0.5),
    "CeilingTiled": (1, 1, 1, 1),
    "DarkGray": (0.175, 0.175, 0.175, 1),
    "DarkGrey": (0.175, 0.175, 0.175, 1),
    "DarkMagentaTransparent": (0.5, 0, 0.5, 0.5),
    "DarkOrangeTransparent": (1, 0.55, 0, 0.5),
    "DarkYellow": (0.7, 0.7, 0, 1),
    "FlatBlack": (0.1, 0.1, 0.1, 1),
    "Gold": (0.8, 0.64869, 0.120759, 1),
    "Gray": (0.7, 0.7, 0.7, 1),
    "Green": (0, 1, 0, 1),
    "GreenGlow": (0, 1, 0, 1),
    "GreenTransparent": (0, 1, 0, 0.5),
    "Grey": (0.7, 0.7, 0.7, 1),
    "GreyTransparent": (0.5, 0.5, 0.5, 0.5),
    "Indigo": (0.33, 0, 0.5, 1),
    "LightBlueLaser": (0.5, 0.5, 1, 0.4),
    "Orange": (1, 0.5088, 0.0468, 1),
    "OrangeTransparent": (1, 0.44, 0, 0.4),
    "Purple": (1, 0, 1, 1),
    "PurpleGlow": (1, 0, 1, 1),
    "Red": (1, 0, 0, 1),
    "RedBright": (0.87, 0.26, 0.07, 1),
    "RedGlow": (1, 0, 0, 1),
    "RedTransparent": (1, 0, 0, 0.5),
    "SkyBlue": (0, 0, 1, 1),
    "Turquoise": (0, 1, 1, 1),
    "TurquoiseGlow": (0, 1, 1, 1),
    "White": (1, 1, 1, 1),
    "WhiteGlow": (1, 1, 1, 1),
    "Yellow": (1, 1, 0, 1),
    "YellowGlow": (1, 1, 0, 1),
    "YellowTransparent": (1, 1, 0, 0.5),
    "ZincYellow": (0.9725, 0.9529, 0.2078, 1),
}


def get_gazebo_color(robot: Robot, link: str) -> tuple[float, float, float, float] | None:
    """Return the color that ``<gazebo>`` sets for a link; None without a known color."""
    color = None
    for block in robot.extensions.get(link, ()):
        text = block.get_value("material") or ""
        color = COLORS.get(text.rpartition("/")[2], color)
    return color
