"""Write pictures of a robot: one view, or a contact sheet of every joint at both limits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import click

from ..console import Console
from .load_strict import report_gltf_axes
from .options import make_decorator
from .picture_file import check_picture_name, write_picture
from .progress import Progress

if TYPE_CHECKING:
    from ..drawing.camera import Camera
    from ..drawing.png_file import Image
    from ..drawing.shapes import Shapes
    from ..model.elements import Robot
    from ..model.pose import Pose


LARGEST = 4096
"""Maximum width and height of a picture [pixels]. Chosen, no source."""


_MAX_SHEET = 120_000_000  # pixels


def _parse_size(
    ctx: click.Context, parameter: click.Parameter, value: str | None
) -> tuple[int, int] | None:
    if value is None:
        return None
    width, times, height = value.lower().replace("×", "x").partition("x")
    try:
        size = int(width), int(height)
    except ValueError:
        size = 0, 0
    if not times or not all(8 <= side <= LARGEST for side in size):
        raise click.BadParameter(
            f"'{value}' is not WIDTHxHEIGHT in pixels (8 to {LARGEST} each), such as 1280x960",
            ctx,
            parameter,
        )
    return size


def _parse_camera(
    ctx: click.Context, parameter: click.Parameter, value: str | None
) -> tuple[float, ...] | None:
    if value is None:
        return None
    try:
        numbers = tuple(float(word) for word in value.split(","))
    except ValueError:
        numbers = ()
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise click.BadParameter(
            f"'{value}' is not AZIMUTH,ELEVATION[,DISTANCE] in degrees and meters, such as 30,20",
            ctx,
            parameter,
        )
    if abs(numbers[1]) > 90:
        raise click.BadParameter(
            f"the elevation {numbers[1]:g} is not between -90 and 90 degrees", ctx, parameter
        )
    if len(numbers) == 3 and numbers[2] <= 0:
        raise click.BadParameter(
            f"the distance {numbers[2]:g} m is not greater than zero", ctx, parameter
        )
    return numbers


def _parse_pose(
    ctx: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> dict[str, float]:
    positions: dict[str, float] = {}
    for value in values:
        name, equals, number = value.rpartition("=")
        try:
            position = float(number)
        except ValueError:
            position = math.nan
        if not equals or not name or not math.isfinite(position):
            raise click.BadParameter(
                f"'{value}' is not JOINT=VALUE with a position in rad or m", ctx, parameter
            )
        if name in positions:
            raise click.BadParameter(f"joint '{name}' is given twice", ctx, parameter)
        positions[name] = position
    return positions


_OPTIONS = (
    click.option("--picture", metavar="FILE.png", help="Write a picture of the robot."),
    click.option(
        "--contact-sheet",
        metavar="FILE.png",
        help="Write a picture with every joint at both of its limits.",
    ),
    click.option(
        "--findings",
        is_flag=True,
        help="With --picture: write the findings of lint at the links that they concern.",
    ),
    click.option(
        "--size",
        metavar="WxH",
        callback=_parse_size,
        help="Size of the picture or of each cell [pixels].  [default: 1280x960]",
    ),
    click.option(
        "--camera",
        metavar="AZ,EL[,DIST]",
        callback=_parse_camera,
        help="Azimuth, elevation [degrees] and distance [m] of the camera: 0,0 is in front of the "
        "robot, 90,0 on its left; by default the robot fits the picture.  [default: -40,22]",
    ),
    click.option(
        "--pose",
        metavar="JOINT=VALUE",
        multiple=True,
        callback=_parse_pose,
        help="Position of a joint [rad or m]; mimic joints follow. Repeatable.  [default: 0]",
    ),
    click.option(
        "--show",
        type=click.Choice(["visual", "collision", "both"]),
        default="visual",
        show_default=True,
        help="Geometry to show; both draws collisions transparent.",
    ),
)

add_picture_options = make_decorator(_OPTIONS)


def check_pictures(picture: str | None, contact_sheet: str | None) -> None:
    """Refuse files that cannot be written, before the robot is read."""
    check_picture_name(picture)
    check_picture_name(contact_sheet, "--contact-sheet")


def write_pictures(
    console: Console,
    robot: Robot,
    *,
    picture: str | None,
    contact_sheet: str | None,
    size: tuple[int, int] | None = None,
    camera: tuple[float, ...] | None = None,
    pose: Mapping[str, float] | None = None,
    show: str = "visual",
    findings: bool = False,
) -> int:
    """Write the requested pictures; return the exit code: 1 if a part was not drawn.

    Meshes that cannot be loaded are reported and not drawn.

    Sizes are in pixels, the camera is azimuth and elevation [degrees], and optionally distance [m].

    Raises:
        ModelError: A joint position is not possible, there is nothing to draw, or no joint moves
            for a contact sheet.
        OutputError: A file cannot be written.
    """
    from ..drawing.picture import SIZE, draw
    from ..drawing.picture_cache import draw_or_read, read_size
    from ..drawing.shapes import read_robot_shapes
    from ..errors import ModelError
    from ..model.files import list_sources
    from ..model.kinematics import check_positions, compute_link_poses, explain_beyond_limits
    from ..output import check_targets

    check_pictures(picture, contact_sheet)
    check_targets((picture, contact_sheet), inputs=sorted(list_sources(robot)))
    positions = dict(pose or {})
    check_positions(robot, positions)
    for message in explain_beyond_limits(robot, positions).values():
        console.print_note(message)
    pixels = _limit_pixels(robot, size or SIZE, camera, is_sheet=picture is None)
    with Progress(console, "meshes") as progress:
        shapes = read_robot_shapes(robot, show=show, progress=progress, pixels=pixels)
    for problem in shapes.problems:
        console.print_error(problem)
    report_gltf_axes(console, robot)
    poses = compute_link_poses(robot, positions)
    if not len(shapes):
        what = "" if show == "both" else f"{show} "
        other = any(link.collisions if show == "visual" else link.visuals for link in robot.links)
        more = "; try --show both" if other and show != "both" else ""
        raise ModelError(f"the robot has no {what}geometry to draw{more}", at=robot.place)
    nowhere = [link for link in robot.links if link.name not in poses and not link.is_frame]
    for link in nowhere:
        console.print_error(
            ModelError(
                f"link '{link.name}' is not connected to the root link and is not drawn",
                at=link.place,
            )
        )
    seen_from = None if camera is None else _make_camera(camera)
    if picture is not None:
        if findings:
            data = _draw_checked(console, robot, shapes, poses, seen_from, size or SIZE)
        else:
            facts = [sorted(poses.items()), camera, size or SIZE]
            data = draw_or_read(
                shapes, facts, lambda: draw(shapes, poses, camera=seen_from, size=size or SIZE)
            )
        write_picture(data, picture, robot)
        width, height = read_size(data)
        console.print_note(f"wrote {picture}, {width} × {height} pixels")
    if contact_sheet is not None:
        _write_sheet(console, robot, shapes, contact_sheet, positions, seen_from, size)
    return 1 if shapes.problems or nowhere else 0


def _draw_checked(
    console: Console,
    robot: Robot,
    shapes: Shapes,
    poses: Mapping[str, Pose],
    camera: Camera | None,
    size: tuple[int, int],
) -> bytes:
    """Check a robot, and return a picture with its findings as a PNG file."""
    from ..api.lint import check
    from ..drawing.png_file import encode_png
    from ..viewer.findings_picture import draw_findings

    found = check(robot, config=console.config, grouped=True)
    return encode_png(draw_findings(robot, shapes, poses, found, camera=camera, size=size))


def _limit_pixels(
    robot: Robot, size: tuple[int, int], camera: tuple[float, ...] | None, *, is_sheet: bool
) -> int | None:
    """Return how many pixels the robot may cover; None for a camera at a given distance."""
    from ..drawing.contact_sheet import choose_layout, list_sweeps

    if camera is not None and len(camera) == 3:
        return None
    return max(choose_layout(len(list_sweeps(robot))).cell if is_sheet else size)


def _make_camera(camera: tuple[float, ...]) -> Camera:
    from ..drawing.camera import Camera

    distance = camera[2] if len(camera) == 3 else None
    return Camera(math.radians(camera[0]), math.radians(camera[1]), distance)


def _write_sheet(
    console: Console,
    robot: Robot,
    shapes: Shapes,
    target: str,
    positions: Mapping[str, float],
    camera: Camera | None,
    cell: tuple[int, int] | None,
) -> None:
    from ..drawing.contact_sheet import (
        choose_layout,
        draw_contact_sheet,
        list_shown_links,
        list_sweeps,
    )
    from ..drawing.picture_cache import draw_or_read, read_size
    from ..errors import ModelError

    sweeps = list_sweeps(robot, shown=list_shown_links(shapes))
    if not sweeps:
        what = "moves geometry" if list_sweeps(robot) else "is movable"
        raise ModelError(
            f"no joint of the robot {what}, so a contact sheet has no content; use --picture",
            at=robot.place,
        )
    layout = choose_layout(len(sweeps), cell)
    if layout.width * layout.height > _MAX_SHEET:
        raise click.UsageError(
            f"the contact sheet of {len(sweeps)} joints has {layout.width} × {layout.height} "
            f"pixels, more than {_MAX_SHEET:,}; choose a smaller --size"
        )

    def draw() -> Image:
        with Progress(console, "joints") as progress:
            return draw_contact_sheet(
                robot, shapes, positions=positions, camera=camera, cell=cell, progress=progress
            )

    view = None if camera is None else [camera.azimuth, camera.elevation, camera.distance]
    data = draw_or_read(shapes, [*_describe_joints(robot), positions, view, cell], draw)
    write_picture(data, target, robot)
    count = f"{len(sweeps)} joint{'s' if len(sweeps) > 1 else ''}"
    width, height = read_size(data)
    console.print_note(f"wrote {target}, {count}, {width} × {height} pixels")


def _describe_joints(robot: Robot) -> list[object]:
    """Describe the kinematics of a robot and its names, for the key of a picture."""
    from ..model.kinematics import get_limits
    from ..model.pose import make_pose

    return [
        robot.name,
        *(
            [
                joint.name, joint.type, joint.parent, joint.child, make_pose(joint.origin),
                joint.axis and joint.axis.xyz, get_limits(joint), joint.thread_pitch,
                joint.mimic and (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset),
            ]
            for joint in robot.joints
        ),
    ]  # fmt: skip
