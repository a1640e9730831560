"""Mass properties as URDF, SDF, MJCF, JSON and a table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import compute_principal_axes, get_components
from ..model.link import COMPONENTS
from ..model.numbers import format_numbers_text, number_text, remove_noise
from .json_text import format_json


def format_urdf(properties: SpatialInertia) -> str:
    """Format the ``<inertial>`` of a URDF link, along the link's axes."""
    six = get_components(properties.tensor)
    return (
        "<inertial>\n"
        f'  <origin xyz="{format_numbers_text(properties.com)}" rpy="0 0 0"/>\n'
        f'  <mass value="{number_text(properties.mass)}"/>\n'
        f"  <inertia {_format_attributes(six)}/>\n"
        "</inertial>\n"
    )


def format_sdf(properties: SpatialInertia) -> str:
    """Format the ``<inertial>`` of an SDF link."""
    six = get_components(properties.tensor)
    rows = "".join(f"    <{name}>{number_text(six[name])}</{name}>\n" for name in COMPONENTS)
    return (
        "<inertial>\n"
        f"  <pose>{format_numbers_text(properties.com)} 0 0 0</pose>\n"
        f"  <mass>{number_text(properties.mass)}</mass>\n"
        f"  <inertia>\n{rows}  </inertia>\n"
        "</inertial>\n"
    )


def format_mjcf(properties: SpatialInertia) -> str:
    """Format the ``<inertial>`` of an MJCF body; ``fullinertia`` has the diagonal first."""
    six = get_components(properties.tensor)
    diagonal = [six[name] for name in ("ixx", "iyy", "izz")]
    products = [six[name] for name in ("ixy", "ixz", "iyz")]
    if any(products):
        tensor = f'fullinertia="{format_numbers_text((*diagonal, *products))}"'
    else:
        tensor = f'diaginertia="{format_numbers_text(diagonal)}"'
    return (
        f'<inertial pos="{format_numbers_text(properties.com)}" '
        f'mass="{number_text(properties.mass)}" '
        f"{tensor}/>\n"
    )


def as_json(properties: SpatialInertia, facts: Mapping[str, Any]) -> str:
    """Format mass properties, derived values and additional facts as one object."""
    return format_json({"version": 1, **build_numbers(properties), **facts}, 2) + "\n"


def build_numbers(properties: SpatialInertia) -> dict[str, Any]:
    """Return the JSON form of mass properties, with derived values."""
    moments, axes = compute_principal_axes(properties.tensor)
    return {
        **properties.as_dict(),
        "inertia_about_origin": get_components(properties.about_origin),
        "principal_moments": list(map(float, moments)),
        "principal_axes": [remove_noise(map(float, axis)) for axis in axes.T],
    }


def format_table(title: str, properties: SpatialInertia, facts: Mapping[str, str]) -> str:
    """Format all values, one line each, with six digits."""
    numbers = build_numbers(properties)
    rows = {
        "mass": f"{numbers['mass']:.6g} kg",
        **facts,
        "center of mass": f"{_format_shown(numbers['com'])} m",
    }
    for label, six in (
        ("about the center of mass", numbers["inertia"]),
        ("about the origin", numbers["inertia_about_origin"]),
    ):
        rows[label] = "ixx, iyy, izz  " + _format_shown(six[name] for name in ("ixx", "iyy", "izz"))
        rows[label] += "  kg m²"
        if any(six[name] for name in ("ixy", "ixz", "iyz")):
            products = _format_shown(six[name] for name in ("ixy", "ixz", "iyz"))
            rows[f"{label}, products"] = f"ixy, ixz, iyz  {products}  kg m²"
    rows["principal moments"] = f"{_format_shown(numbers['principal_moments'])}  kg m²"
    width = max(map(len, rows))
    return "".join([f"{title}\n", *(f"  {key:<{width}}  {value}\n" for key, value in rows.items())])


def format_summary(what: str, properties: SpatialInertia) -> str:
    """Format mass and moments in one line, with six digits."""
    six = get_components(properties.tensor)
    moments = ", ".join(f"{name} {six[name]:.6g}" for name in ("ixx", "iyy", "izz"))
    return f"{what}: {properties.mass:.6g} kg; {moments} kg m² about the center of mass"


def _format_attributes(six: Mapping[str, float]) -> str:
    return " ".join(f'{name}="{number_text(six[name])}"' for name in COMPONENTS)


def _format_shown(values: Any) -> str:
    return " ".join(f"{value:.6g}" for value in values)
