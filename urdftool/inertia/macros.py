"""Inertia as xacro macros: the formulas of ``solids`` as xacro expressions.

Each macro takes the mass [kg] and the sizes [m] of its shape and, as ``xyz`` and ``rpy``, the pose
of the shape in the link, as in the ``<origin>`` of the geometry. Its numbers are rounded to ten
digits, because xacro cannot keep more where fewer violate the triangle inequality, as of plates.
"""

from __future__ import annotations

from typing import NamedTuple

from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import get_components
from ..model.numbers import DIGITS, format_numbers_text, number_text
from .shapes import SHAPES, THICKNESS, Shape, Sizes

NAMESPACE = "http://www.ros.org/wiki/xacro"

_HEAD = f"""<?xml version="1.0"?>
<!-- Inertia of simple shapes of uniform density.

     mass in kg, lengths in m. xyz and rpy say where the shape is in the link, as the origin of its
     geometry does:

     <xacro:cylinder_inertia mass="0.18" radius="0.06" length="0.09" xyz="0 0 0.045"/>
-->
<robot xmlns:xacro="{NAMESPACE}">
"""


class Formula(NamedTuple):
    """Moments of a shape as xacro expressions.

    Attributes:
        values: Properties to compute first, in order: name and expression.
        moments: ixx, iyy, izz about the center of mass.
        rise: Position of the center of mass on the shape's z axis; empty for the origin.
    """

    values: tuple[tuple[str, str], ...]
    moments: tuple[str, str, str]
    rise: str = ""


def _collect_edges(name: str, given: str) -> tuple[tuple[str, str], ...]:
    return tuple((axis, f"float({given}.split()[{i}])") for i, axis in enumerate(name))


_BOX = ("mass * (y * y + z * z) / 12", "mass * (x * x + z * z) / 12", "mass * (x * x + y * y) / 12")

FORMULAS = {
    "box": Formula(_collect_edges("xyz", "size"), _BOX),
    "cylinder": Formula(
        (("across", "mass * (3 * radius * radius + length * length) / 12"),),
        ("across", "across", "mass * radius * radius / 2"),
    ),
    "sphere": Formula(
        (("moment", "2 * mass * radius * radius / 5"),), ("moment", "moment", "moment")
    ),
    "capsule": Formula(
        (
            ("m_cylinder", "mass * length / (length + 4 * radius / 3)"),
            ("m_ends", "mass - m_cylinder"),
            (
                "across",
                "m_cylinder * (3 * radius * radius + length * length) / 12"
                " + m_ends * (2 * radius * radius / 5 + length * length / 4"
                " + 3 * length * radius / 8)",
            ),
        ),
        (
            "across",
            "across",
            "m_cylinder * radius * radius / 2 + m_ends * 2 * radius * radius / 5",
        ),
    ),
    "ellipsoid": Formula(
        _collect_edges("abc", "radii"),
        (
            "mass * (b * b + c * c) / 5",
            "mass * (a * a + c * c) / 5",
            "mass * (a * a + b * b) / 5",
        ),
    ),
    "cone": Formula(
        (("across", "3 * mass * (4 * radius * radius + length * length) / 80"),),
        ("across", "across", "3 * mass * radius * radius / 10"),
        "-length / 4",
    ),
    "hollow_box": Formula(
        (
            *_collect_edges("xyz", "size"),
            *((f"{axis}i", f"{axis} - 2 * thickness") for axis in "xyz"),
            ("volume", "2 * thickness * (y * z + xi * z + xi * yi)"),
            *(
                (
                    f"s{a}",
                    f"2 * thickness * (({a} * {a} + {a} * {a}i + {a}i * {a}i) * {b} * {c}"
                    f" + {a}i * {a}i * {a}i * ({c} + {b}i)) / 12",
                )
                for a, b, c in ("xyz", "yzx", "zxy")
            ),
        ),
        ("mass * (sy + sz) / volume", "mass * (sx + sz) / volume", "mass * (sx + sy) / volume"),
    ),
    "hollow_cylinder": Formula(
        (
            ("inner", "radius - thickness"),
            ("plates", "2 * thickness if closed else 0"),
            ("tube", "length - plates"),
            ("v_tube", "thickness * (radius + inner) * tube"),
            ("v_plates", "radius * radius * plates"),
            ("m_tube", "mass * v_tube / (v_tube + v_plates)"),
            ("m_plates", "mass * v_plates / (v_tube + v_plates)"),
            ("arm", "(length - thickness) / 2"),
            (
                "across",
                "m_tube * (3 * (radius * radius + inner * inner) + tube * tube) / 12"
                " + m_plates * ((3 * radius * radius + thickness * thickness) / 12 + arm * arm)",
            ),
        ),
        (
            "across",
            "across",
            "m_tube * (radius * radius + inner * inner) / 2 + m_plates * radius * radius / 2",
        ),
    ),
    "hollow_sphere": Formula(
        (
            ("r", "radius"),
            ("s", "radius - thickness"),
            (
                "moment",
                "2 * mass * (r * r * r * r + r * r * r * s + r * r * s * s + r * s * s * s"
                " + s * s * s * s) / (5 * (r * r + r * s + s * s))",
            ),
        ),
        ("moment", "moment", "moment"),
    ),
}


def get_macro_file() -> str:
    """Return a xacro file with a macro for each shape, solid and hollow."""
    names = [(shape, False) for shape in SHAPES]
    names += [(shape, True) for shape in SHAPES if shape.hollow]
    body = "\n".join(
        _format_indented(get_shape_macro(shape, hollow=hollow)) for shape, hollow in names
    )
    return f"{_HEAD}\n{body}\n</robot>\n"


def get_shape_macro(shape: Shape, *, hollow: bool = False) -> str:
    """Return the macro of one shape, to paste into a xacro file."""
    name = f"hollow_{shape.name}" if hollow else shape.name
    formula = FORMULAS[name]
    params = ["mass", *(size.name for size in shape.sizes)]
    if hollow:
        params.append(THICKNESS.name)
        params += ["closed:=false"] if shape.ends else []
    lines = [f'<xacro:macro name="{name}_inertia" params="{_format_params(params)}">']
    lines += [
        f'  <xacro:property name="{key}" value="${{{value}}}"/>' for key, value in formula.values
    ]
    ixx, iyy, izz = (_format_rounded(moment) for moment in formula.moments)
    lines += [
        "  <inertial>",
        f'    <origin xyz="{_format_raised(formula.rise)}" rpy="${{rpy}}"/>',
        '    <mass value="${mass}"/>',
        f'    <inertia ixx="{ixx}" ixy="0" ixz="0"',
        f'             iyy="{iyy}" iyz="0"',
        f'             izz="{izz}"/>',
        "  </inertial>",
        "</xacro:macro>",
    ]
    return "\n".join(lines) + "\n"


def get_shape_call(
    shape: Shape,
    sizes: Sizes,
    mass: float,
    *,
    thickness: float | None = None,
    closed: bool = False,
    xyz: tuple[float, ...] = (0, 0, 0),
    rpy: tuple[float, ...] = (0, 0, 0),
) -> str:
    """Return the call of a shape's macro with numbers.

    Lengths are in m, angles in rad; a shape without thickness is solid.
    """
    name = shape.name if thickness is None else f"hollow_{shape.name}"
    written = {"mass": number_text(mass)}
    for key, value in sizes.items():
        written[key] = (
            format_numbers_text(value) if isinstance(value, tuple) else number_text(value)
        )
    if thickness is not None:
        written["thickness"] = number_text(thickness)
        if closed:
            written["closed"] = "true"
    written |= {"xyz": format_numbers_text(xyz), "rpy": format_numbers_text(rpy)}
    attributes = " ".join(f'{key}="{value}"' for key, value in written.items())
    return f"<xacro:{name}_inertia {attributes}/>\n"


def get_mass_macro(name: str, properties: SpatialInertia) -> str:
    """Return a macro for a body of any shape; its mass parameter defaults to the body's mass."""
    scale = f"mass / {number_text(properties.mass)}"
    six = [
        f'{key}="{_format_rounded(f"{scale} * {number_text(value)}")}"'
        for key, value in get_components(properties.tensor).items()
    ]
    return "\n".join(
        [
            f'<xacro:macro name="{name}_inertia" params="mass:={number_text(properties.mass)}">',
            "  <inertial>",
            f'    <origin xyz="{format_numbers_text(properties.com)}" rpy="0 0 0"/>',
            '    <mass value="${mass}"/>',
            f"    <inertia {' '.join(six)}/>",
            "  </inertial>",
            "</xacro:macro>",
            f"<xacro:{name}_inertia/>\n",
        ]
    )


def _format_params(names: list[str]) -> str:
    return " ".join([*names, "xyz:='0 0 0'", "rpy:='0 0 0'"])


def _format_rounded(expression: str) -> str:
    return f"${{'%.{DIGITS}g' % ({expression})}}"


def _format_raised(rise: str) -> str:
    """Return ``xyz``, or the point at ``rise`` along the rotated z axis from it."""
    if not rise:
        return "${xyz}"
    roll, pitch, yaw = (f"float(rpy.split()[{i}])" for i in range(3))
    axis = (
        f"cos({yaw}) * sin({pitch}) * cos({roll}) + sin({yaw}) * sin({roll})",
        f"sin({yaw}) * sin({pitch}) * cos({roll}) - cos({yaw}) * sin({roll})",
        f"cos({pitch}) * cos({roll})",
    )
    return " ".join(
        _format_rounded(f"float(xyz.split()[{i}]) + ({rise}) * ({part})")
        for i, part in enumerate(axis)
    )


def _format_indented(text: str) -> str:
    return "".join(f"  {line}\n" for line in text.splitlines())
