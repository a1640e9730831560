"""Defects of the description that affect the result of a run.

Rules find them (``lint.validate``, purpose ``simulate``). ``description`` decides which affect the
bodies that the engine loaded, and assigns verdict kinds.
"""
