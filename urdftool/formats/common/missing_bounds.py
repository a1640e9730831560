"""The warning about a revolute joint without bounds that turns freely, equal in every export."""

from __future__ import annotations

from ...model.elements import Joint


def explain_missing_bounds(joint: Joint) -> str:
    """Explain that a joint for which :attr:`Joint.turns_freely` holds has no bounds."""
    return (
        f"joint '{joint.name}' has an effort or velocity limit, but no lower and upper limit: it "
        "is exported as continuous; write the limits, or the type continuous"
    )
