"""Comparison of an export with its source, without code of the exporter.

``source`` and ``reader`` create a ``Mechanism`` from the robot and from the exported file,
``dynamics`` computes kinematics and dynamics of both, ``compare`` runs the checks, and ``loader``
runs Gazebo's own reader.
"""
