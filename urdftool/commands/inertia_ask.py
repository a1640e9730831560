"""The questions that are asked at a terminal: which shape, how heavy, how large."""

from __future__ import annotations

import math
import sys

import click

from ..inertia.shapes import SHAPES, Shape, Size


def at_terminal() -> bool:
    """Whether somebody is there to answer."""
    return sys.stdin is not None and sys.stdin.isatty()


def choose_shape() -> Shape:
    """The menu."""
    width = max(len(shape.name) for shape in SHAPES)
    for number, shape in enumerate(SHAPES, start=1):
        click.echo(f"  {number}  {shape.name:<{width}}  {shape.what}", err=True)
    while True:
        answer = str(click.prompt("Which shape", err=True)).strip().lower()
        for number, shape in enumerate(SHAPES, start=1):
            if answer in (str(number), shape.name):
                return shape
        click.echo(f"Error: type a number from 1 to {len(SHAPES)}, or a name.", err=True)


def ask_mass() -> float:
    """The mass [kg]."""
    return _number("Mass [kg]")


def ask_size(size: Size) -> float | tuple[float, ...]:
    """One size of a shape [m]."""
    if size.numbers == 1:
        return _number(f"{size.name.capitalize()} {size.what}")
    click.echo(f"{size.name.capitalize()}, {size.what}", err=True)
    return tuple(_number(f"  {axis} [m]") for axis in size.metavar.split())


def _number(question: str) -> float:
    while True:
        value = float(click.prompt(question, type=float, err=True))
        if math.isfinite(value) and value > 0:
            return value
        click.echo("Error: a number above zero is wanted.", err=True)
