"""Warnings about limits of joints that are equal in every export."""

from __future__ import annotations

from ...model.elements import Joint


def explain_missing_bounds(joint: Joint) -> str:
    """Explain that a joint for which :attr:`Joint.turns_freely` holds has no bounds."""
    return (
        f"joint '{joint.name}' has an effort or velocity limit, but no lower and upper limit: it "
        "is exported as continuous; write the limits, or the type continuous"
    )


def explain_default_bounds(joint: Joint, effect: str = "it cannot move") -> str:
    """Explain that a joint whose limit has no bounds cannot move; empty if that is not so."""
    limit = joint.limit
    if not joint.is_limited or joint.turns_freely or limit is None:
        return ""
    if limit.lower is not None or limit.upper is not None:
        return ""
    other = ", or the type continuous" if joint.type == "revolute" else ""
    return (
        f"joint '{joint.name}' has no lower and upper limit, which count as zero: {effect}; write "
        f"them{other}"
    )


def explain_negative_effort(joint: Joint) -> str:
    """Explain that the effort limit of a joint is negative."""
    assert joint.limit is not None
    assert joint.limit.effort is not None
    effort = joint.limit.effort
    return (
        f"effort limit {effort:g} of joint '{joint.name}' is negative: {-effort:g} is written, its "
        "absolute value, as MuJoCo's importer of URDF takes it"
    )
