"""``--group`` of ``urdftool srdf``, and what it reports of the groups."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..console import Console

if TYPE_CHECKING:
    from ..model.semantic import Group, SemanticDescription
    from ..srdf.groups import GivenGroup

F = TypeVar("F", bound=Callable[..., Any])


def add_group_option(function: F) -> F:
    """Add ``--group``, a tuple of groups that the user asks for."""
    return click.option(
        "--group",
        "given_groups",
        multiple=True,
        metavar="NAME=BASE:TIP",
        callback=_parse_groups,
        help="Planning group NAME of the chain from link BASE to link TIP, in place of found ones "
        "with the same joints. Repeatable.",
    )(function)


def _parse_groups(
    ctx: click.Context, parameter: click.Parameter, words: tuple[str, ...]
) -> tuple[GivenGroup, ...]:
    return tuple(map(_parse_group, words))


def _parse_group(word: str) -> GivenGroup:
    from ..srdf.groups import GivenGroup

    name, equals, links = word.partition("=")
    base, colon, tip = links.partition(":")
    parts = (name.strip(), base.strip(), tip.strip())
    if not equals or not colon or not all(parts):
        raise click.BadParameter(f"'{word}' is not NAME=BASE:TIP, such as arm=base_link:tool0")
    return GivenGroup(*parts)


def report_groups(console: Console, content: SemanticDescription) -> None:
    """Report the groups of an SRDF, whose names are guesses."""
    if not content.groups:
        console.print_message(
            "warning: no chain of joints was found, so the SRDF has no planning group; "
            "give one with --group NAME=BASE:TIP"
        )
        return
    console.print_note("planning groups (guesses; change them with --group NAME=BASE:TIP):")
    for group in content.groups:
        console.print_note(f"  {group.name}: {describe_group(group)}")


def describe_group(group: Group) -> str:
    """Describe a group: its chain, its links or its subgroups."""
    parts = [f"{chain.base} to {chain.tip}" for chain in group.chains]
    if group.links:
        more = f" and {len(group.links) - 3} more" if len(group.links) > 3 else ""
        parts.append(f"links {', '.join(group.links[:3])}{more}")
    if group.joints:
        parts.append(f"joints {', '.join(group.joints)}")
    if group.groups:
        parts.append(f"groups {', '.join(group.groups)}")
    return "; ".join(parts)
