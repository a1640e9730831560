"""Checks of the description that decide whether a run can be trusted: mass, inertia and size.

Lint has rules for the same facts; ``lint_words`` reports them in the words of those rules.
"""
