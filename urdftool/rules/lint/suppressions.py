"""The comments that silence rules; the engine that reads them reports these."""

from __future__ import annotations

from ..rule import ERROR, WARNING, Problem, rule

APPLIES_TO = ()


@rule(WARNING)
def unused_suppression() -> tuple[Problem, ...]:
    """A comment silences a rule that finds nothing there.

    The fault is mended, or the comment stands at the wrong line. Left behind, it hides the next
    fault of the same kind.
    """
    return ()


@rule(ERROR)
def unknown_rule() -> tuple[Problem, ...]:
    """A comment names a rule that does not exist.

    A misspelt rule in ``urdftool-ignore[…]`` silences nothing, and one that is not named at all
    would silence everything.
    """
    return ()
