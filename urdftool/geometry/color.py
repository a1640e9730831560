"""Colors of sRGB, as URDF, COLLADA and MTL write them, and of linear light, as glTF and USD do."""

from __future__ import annotations

Rgba = tuple[float, float, float, float]


def convert_to_linear(value: float) -> float:
    """Convert a component of an sRGB color to linear light (IEC 61966-2-1)."""
    value = min(max(value, 0.0), 1.0)
    return value / 12.92 if value <= 0.04045 else float(((value + 0.055) / 1.055) ** 2.4)


def convert_to_srgb(value: float) -> float:
    """Convert a component of a color in linear light to sRGB (IEC 61966-2-1), to 6 decimals."""
    value = min(max(value, 0.0), 1.0)
    encoded = value * 12.92 if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
    return round(float(encoded), 6)
