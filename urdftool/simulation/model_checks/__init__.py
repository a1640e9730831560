"""Defects of the description that decide whether a run can be trusted.

Rules find them (``lint.validate``, purpose ``simulate``). ``description`` decides which matter in
the bodies that the engine loaded, and gives them the kinds of verdicts.
"""
