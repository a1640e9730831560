"""Apply a controller file to the settings of ``urdftool simulate``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import click

from ..console import Console
from ..report.counted import format_count

if TYPE_CHECKING:
    from ..model.elements import Robot
    from ..simulation.settings import Settings

_MOST = 4  # controllers that a message names; chosen


def apply_controllers(
    console: Console, settings: Settings, robot: Robot, path: str | None, *, strict: bool = False
) -> Settings:
    """Add the controllers of a file to the settings.

    Raises:
        ConfigError: The file does not match the robot.
        SourceError: The file cannot be read.
        UsageError: The options set another way to hold the joints, too.
    """
    if path is None:
        return settings
    if settings.hold != "all":
        raise click.UsageError(
            "--controllers excludes --limp and --hold-actuated, because the controllers hold the "
            "joints"
        )
    from ..simulation.controllers import read_controllers

    controls = read_controllers(path, robot, strict=strict)
    for note in controls.notes:
        console.print_note(note)
    return replace(settings, controls=controls.joints)


def report_open_loops(console: Console, robot: Robot) -> None:
    """Print the connections that close loops, which the engines are not given."""
    for closure in robot.closures:
        which = f"closed loop '{closure.name}'" if closure.name else "the closed loop"
        console.print_note(
            f"{closure.place}: warning: {which} between links "
            f"'{closure.parent}' and '{closure.child}' stays open: the simulation uses the tree"
        )


def take_robot_of_scene(console: Console, robot: Robot) -> Robot:
    """Return the robot of a scene, and print what is not simulated; a URDF is no scene."""
    from ..simulation.scene import take_robot

    report_replaced(console, robot)
    part, left_out = take_robot(robot)
    report_open_loops(console, part)
    if left_out:
        shown = ", ".join(left_out[:_MOST])
        more = f" and {len(left_out) - _MOST} more" if len(left_out) > _MOST else ""
        console.print_note(
            f"{robot.place}: warning: parts of the scene are not simulated: {shown}{more}; the "
            "simulation has one robot and its own ground"
        )
    return part


def report_replaced(console: Console, robot: Robot) -> None:
    """Print what is set but simulated differently: world, drives, constraints."""
    from ..model.world_settings import list_changed

    names: list[str] = []
    if robot.format != "mjcf":  # whose options are named below
        names = [f"{setting.name} of the world" for setting, _ in list_changed(robot)]
    for section in _REPLACED:
        elements = [element for element in robot.native if element.section == section]
        if section == "option":
            names += [f"{n} of <option>" for e in elements for n in e.attributes]
            names += [f"flag {n}" for e in elements for c in e.children for n in c.attributes]
        elif elements:
            names.append(format_count(len(elements), f"<{section}> element"))
    names += _list_contact_filters(robot)
    names += [
        f"no contact of '{one}' and '{other}'"
        for one, other in ((pair.link, pair.other) for pair in robot.exclusions)
        if not {one, other} <= robot.link.keys()
    ]
    if names:
        console.print_note(
            f"{robot.place}: note: the simulation has its own gravity, solver, motors and ground; "
            f"not simulated: {', '.join(names)}"
        )


def _list_contact_filters(robot: Robot) -> Iterator[str]:
    """Yield the settings by which collisions of a file touch only some others, or nothing."""
    from ..model.read_settings import list_bullet_attributes
    from ..model.settings import SURFACE, SURFACE_OF_MUJOCO

    found: dict[str, list[str]] = {}
    for row in (*SURFACE, *SURFACE_OF_MUJOCO):
        if row.name not in _CONTACT_FILTERS:
            continue
        for link in robot.links:
            for shape in link.collisions:
                if row.name in shape.surface and shape.surface[row.name].content != row.default:
                    found.setdefault(row.name, []).append(link.name)
    for name, link_name in list_bullet_attributes(robot):
        found.setdefault(name, []).append(link_name)
    for name, links in found.items():
        more = f" and {len(links) - 1} more" if len(links) > 1 else ""
        yield f"{name} of a collision of link '{links[0]}'{more}"


_CONTACT_FILTERS = (
    *("collide_bitmask", "category_bitmask", "without_contact", "bitmask_without_contact"),
    *("contype", "conaffinity"),
)
_REPLACED = ("option", "actuator", "tendon", "equality", "contact")
"""Sections of MJCF that affect motion and that the simulation replaces or leaves out."""


def report_start(console: Console, robot: Robot, settings: Settings) -> Settings:
    """Return the settings with the home of the robot, and print a note on bent legs."""
    from ..api.start import choose_start

    settings, notes = choose_start(robot, settings)
    for note in notes:
        console.print_note(f"{robot.place}: {note.message}" if robot.place else note.message)
    return settings
