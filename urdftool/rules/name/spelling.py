"""Check the spelling of names."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.elements import Collision, Joint, Link, Material, Robot
from ..fix import FixContext, Proposal, append_number
from ..mujoco import keeps_visuals
from ..renaming import get_part, rename_material, rename_part
from ..rule import ANY_FORMAT, ERROR, INFO, ROS, UNSAFE, WARNING, Problem, rule
from ..unexpanded import is_unexpanded
from ..words import fold

_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_SNAKE = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*")


@rule(
    ERROR,
    on=ROS,
    effects={
        "tf2": "rejects a frame that begins with a slash",
    },
    pedantic="names that begin with an expression of xacro, for which a launch file passes a value",
)
def invalid_frame_name(robot: Robot, *, together: float = 4) -> Iterator[Problem]:
    """A link's name begins with a slash or contains a space.

    Every link is a tf frame, and tf2 rejects such names. If the names of more than ``together``
    links begin with a slash, they are one finding, because usually an empty prefix is the cause.
    It is an info, and off by default, if an expression of xacro that is empty precedes the slash,
    because the launch file may pass a value.
    """
    slashed = [link for link in robot.links if link.name.startswith("/")]
    if len(slashed) > together:
        first = slashed[0]
        is_computed = all(map(_begins_with_expression, slashed))
        remedy = "pass the prefix" if is_computed else "remove the slash"
        yield Problem(
            first,
            f"names of {len(slashed)} links begin with a slash, which tf2 rejects (first "
            f"'{first.name}'); {remedy}, or write the empty prefix",
            at=first.locate_attribute("name"),
            severity=INFO if is_computed else None,
            pedantic=is_computed,
        )
    for link in robot.links:
        name = link.name
        inner = name.strip()
        if not inner or is_unexpanded(name) or (inner != name and inner in robot.tree.order):
            continue
        if name.startswith("/"):
            if len(slashed) > together:
                continue
            what, right = "begins with a slash", name.lstrip("/")
        elif len(inner.split()) > 1:
            what, right = "contains a space", "_".join(inner.split())
        else:
            continue
        is_computed = name.startswith("/") and _begins_with_expression(link)
        yield Problem(
            link,
            f"name of link '{name}' {what}, which tf2 rejects; write '{right}'",
            at=link.locate_attribute("name"),
            severity=INFO if is_computed else None,
            pedantic=is_computed,
            data={"write": right},
        )


def _begins_with_expression(link: Link) -> bool:
    """Tell whether the source of a link's name begins with ``${…}`` or ``$(…)``."""
    if link.xml is None:
        return False
    place = link.xml.place
    tag = place.file.data[place.start : place.end].partition(b">")[0]
    return re.search(rb"\bname\s*=\s*[\"']\s*\$[{(]", tag) is not None


@invalid_frame_name.fix(UNSAFE, renames=True)
def rename_frame(problem: Problem, context: FixContext) -> Proposal | None:
    """Rename one link; the names of many have a common cause."""
    name: str | None = problem.data.get("write")
    return None if name is None else rename_part(context, context.get_link(problem), name)


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, drake": "accept it",
    },
    default=False,
)
def not_portable_identifier(robot: Robot) -> Iterator[Problem]:
    """A name of a link or joint has other characters than letters, digits and underscores.

    Importers that require identifiers rename it, and references to it no longer match.
    """
    for part in _get_parts(robot):
        if part.name and not _IDENTIFIER.fullmatch(part.name) and not is_unexpanded(part.name):
            renamed = re.sub(r"\W", "_", part.name, flags=re.ASCII)
            renamed = f"_{renamed}" if renamed[0].isdigit() else renamed
            yield Problem(
                part,
                f"name of {part.tag} '{part.name}' is not an identifier; write '{renamed}'",
                at=part.locate_attribute("name"),
                data={"write": renamed},
            )


@not_portable_identifier.fix(UNSAFE, renames=True)
def write_identifier(problem: Problem, context: FixContext) -> Proposal | None:
    """Write underscores in place of other characters than letters and digits."""
    part = get_part(problem)
    return rename_part(context, part, problem.data["write"]) if part is not None else None


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, drake": "accept it",
    },
    default=False,
)
def name_style(robot: Robot) -> Iterator[Problem]:
    """A link's or joint's name is not in lower case with underscores.

    This is the convention of ROS; mixed styles lead to mistakes.
    """
    for part in _get_parts(robot):
        if part.name and not _SNAKE.fullmatch(part.name) and not is_unexpanded(part.name):
            yield Problem(
                part,
                f"name of {part.tag} '{part.name}' is not in lower case with underscores",
                at=part.locate_attribute("name"),
            )


@name_style.fix(UNSAFE, renames=True)
def write_snake_case(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the name in lower case, with underscores between words."""
    part = get_part(problem)
    if part is None or not part.name.isascii():
        return None
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])|[^A-Za-z0-9]+", "_", part.name)
    return rename_part(context, part, re.sub("_+", "_", words).strip("_").lower())


@rule(
    INFO,
    effects={
        "urdfdom, gz, gazebo-classic, mujoco, pybullet, drake": "accept it",
    },
    formats=ANY_FORMAT,
    default=False,
)
def non_ascii_name(robot: Robot) -> Iterator[Problem]:
    """A name has non-ASCII characters.

    Names of topics and frames in ROS are ASCII, and some tools garble other characters.
    """
    materials = [*robot.materials, *(v.material for link in robot.links for v in link.visuals)]
    seen: set[str] = set()
    parts: list[Link | Joint | Material] = [*_get_parts(robot), *filter(None, materials)]
    for part in parts:
        if not part.name.isascii() and part.name not in seen:
            seen.add(part.name)
            yield Problem(
                part,
                f"name of {part.tag} '{part.name}' has non-ASCII characters",
                at=part.locate_attribute("name"),
            )


_LETTERS = str.maketrans({"ß": "ss", "æ": "ae", "ø": "o", "ł": "l", "đ": "d", "œ": "oe", "Ø": "O"})


@non_ascii_name.fix(UNSAFE, renames=True)
def write_ascii(problem: Problem, context: FixContext) -> Proposal | None:
    """Write the nearest ASCII letters; names in other scripts are not changed."""
    import unicodedata

    name = problem.name
    plain = "".join(
        letter
        for letter in unicodedata.normalize("NFKD", name.translate(_LETTERS))
        if not unicodedata.combining(letter)
    )
    if not plain.isascii():
        return None
    part = get_part(problem)
    if part is None:
        return rename_material(context.robot, name, plain)
    return rename_part(context, part, plain)


@rule(
    INFO,
    effects={
        "urdfdom, pybullet, drake": "treat them as two names",
    },
    default=False,
)
def confusable_names(robot: Robot) -> Iterator[Problem]:
    """Names of two links or two joints differ only in case, ``_`` or ``-``.

    Users confuse them, and so do file systems and importers.
    """
    for parts in (robot.link, robot.joint):
        seen: dict[str, str] = {}
        for name, part in parts.items():
            first = seen.setdefault(fold(name), name)
            if first != name:
                tag = part.tag
                yield Problem(
                    part,
                    f"{tag} '{name}' is easily confused with {tag} '{first}'; rename one",
                    at=part.locate_attribute("name"),
                )


@rule(
    WARNING,
    effects={
        "mujoco (kept shape)": "warns, and drops the second name",
        "drake": "warns, and renames it",
    },
    pedantic="visuals that MuJoCo discards",
)
def duplicate_geometry_name(robot: Robot, targets: frozenset[str]) -> Iterator[Problem]:
    """Two visuals or two collisions of a link have the same name.

    MuJoCo drops the second name, so a contact pair by that name has only one of them. MuJoCo
    requires unique names in the whole robot. It discards visuals of a URDF, unless ``<compiler>``
    keeps them.
    """
    seen: set[tuple[str, str, str]] = set()
    keeps = keeps_visuals(robot)
    for link, shape in robot.shapes:
        if not shape.name or is_unexpanded(shape.name):
            continue
        is_kept = keeps or isinstance(shape, Collision)
        in_robot = is_kept and "mujoco" in targets
        key = ("" if in_robot else link.name, shape.element.tag, shape.name)
        if key in seen:
            yield Problem(
                link,
                f"{shape.element.tag} name '{shape.name}' is used twice, again in link "
                f"'{link.name}'; write a unique name, or none",
                at=shape.locate_attribute("name"),
                severity=None if is_kept else INFO,
                pedantic=not is_kept,
                effects=("mujoco (kept shape)", "drake") if is_kept else ("drake",),
            )
        seen.add(key)


def _get_parts(robot: Robot) -> list[Link | Joint]:
    return [*robot.links, *robot.joints]


@duplicate_geometry_name.fix(UNSAFE)
def number_geometry_name(problem: Problem, context: FixContext) -> Proposal | None:
    """Append a number to the second name."""
    return append_number(problem, {shape.name for _, shape in context.robot.shapes})
