"""Questions at a terminal: shape, mass and dimensions."""

from __future__ import annotations

import math
import sys

import click

from ..inertia.shapes import SHAPES, Shape, Size


def is_at_terminal() -> bool:
    """Tell whether standard input is a terminal."""
    return sys.stdin is not None and sys.stdin.isatty()


def choose_shape() -> Shape:
    """Show the shapes as a menu, and return the chosen one."""
    width = max(len(shape.name) for shape in SHAPES)
    for number, shape in enumerate(SHAPES, start=1):
        click.echo(f"  {number}  {shape.name:<{width}}  {shape.what}", err=True)
    while True:
        answer = str(click.prompt("Which shape", err=True)).strip().lower()
        for number, shape in enumerate(SHAPES, start=1):
            if answer in (str(number), shape.name):
                return shape
        click.echo(f"Error: enter a number from 1 to {len(SHAPES)}, or a name.", err=True)


def ask_mass() -> float:
    """Ask for the mass [kg]."""
    return _number("Mass [kg]")


def ask_size(size: Size) -> float | tuple[float, ...]:
    """Ask for one dimension of a shape [m]."""
    if size.numbers == 1:
        return _number(f"{size.name.capitalize()} {size.what}")
    click.echo(f"{size.name.capitalize()}, {size.what}", err=True)
    return tuple(_number(f"  {axis} [m]") for axis in size.metavar.split())


def _number(question: str) -> float:
    while True:
        value = float(click.prompt(question, type=float, err=True))
        if math.isfinite(value) and value > 0:
            return value
        click.echo("Error: enter a number greater than zero.", err=True)
