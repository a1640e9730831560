"""Comparison of an export with its source.

``compare`` reads the file back and compares two robots; ``sensors``, ``plugins`` and ``elements``
compare what the robot does not hold yet, by elements. ``world`` compares the world around the
model, ``loader`` runs Gazebo's own reader.
"""
