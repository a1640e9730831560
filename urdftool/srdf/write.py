"""Text of an SRDF."""

from __future__ import annotations

from collections.abc import Iterator

from ..model.semantic import (
    DisabledPair,
    EndEffector,
    Group,
    GroupState,
    SemanticDescription,
    VirtualJoint,
)
from ..source.escape import escape_attribute

_INDENT = "  "


def format_srdf(content: SemanticDescription, comments: tuple[str, ...] = ()) -> str:
    """Format an SRDF."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>']
    lines += [format_comment(text) for text in comments]
    lines.append(f"<robot {_format_attributes(name=content.name)}>")
    lines += [_INDENT + line for line in list_lines(content)]
    return "\n".join([*lines, "</robot>", ""])


def format_comment(text: str) -> str:
    """Format an XML comment; two hyphens in a row are separated, since XML forbids them."""
    while "--" in text:
        text = text.replace("--", "- -")
    return f"<!-- {text.strip()} -->"


def format_pair(pair: DisabledPair) -> str:
    """Format a pair as one line, with its comment."""
    element = _format_empty(
        "disable_collisions", link1=pair.link1, link2=pair.link2, reason=pair.reason
    )
    return f"{element} {format_comment(pair.comment)}" if pair.comment else element


def format_position(value: float) -> str:
    """Format a joint position [rad, m] with at most nine significant digits."""
    return f"{value + 0.0:.9g}"


def list_lines(content: SemanticDescription) -> Iterator[str]:
    """Yield the lines of the elements in ``<robot>``, indented by two spaces for each level."""
    for group in content.groups:
        yield from _format_group(group)
    for state in content.states:
        yield from _format_state(state)
    yield from map(_format_end_effector, content.end_effectors)
    yield from map(_format_virtual_joint, content.virtual_joints)
    for joint in content.passive_joints:
        yield _format_empty("passive_joint", name=joint.name)
    yield from map(format_pair, content.disabled)


def _format_group(group: Group) -> Iterator[str]:
    yield f"<group {_format_attributes(name=group.name)}>"
    for tag, names in (("link", group.links), ("joint", group.joints)):
        for name in names:
            yield _INDENT + _format_empty(tag, name=name)
    for chain in group.chains:
        yield _INDENT + _format_empty("chain", base_link=chain.base, tip_link=chain.tip)
    for name in group.groups:
        yield _INDENT + _format_empty("group", name=name)
    yield "</group>"


def _format_state(state: GroupState) -> Iterator[str]:
    yield f"<group_state {_format_attributes(name=state.name, group=state.group)}>"
    for joint in state.joints:
        if joint.value is not None:
            value = format_position(joint.value)
            yield _INDENT + _format_empty("joint", name=joint.name, value=value)
    yield "</group_state>"


def _format_end_effector(part: EndEffector) -> str:
    more = {"parent_group": part.parent_group} if part.parent_group else {}
    names = {"name": part.name, "parent_link": part.parent_link, "group": part.group}
    return _format_empty("end_effector", **names, **more)


def _format_virtual_joint(part: VirtualJoint) -> str:
    return _format_empty(
        "virtual_joint",
        name=part.name,
        type=part.type,
        parent_frame=part.parent_frame,
        child_link=part.child_link,
    )


def _format_empty(tag: str, **attributes: str) -> str:
    return f"<{tag} {_format_attributes(**attributes)}/>"


def _format_attributes(**attributes: str) -> str:
    return " ".join(f'{name}="{escape_attribute(text)}"' for name, text in attributes.items())
