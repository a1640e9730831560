"""Readers, writers and proofs of the formats SDF, MJCF and USD, and the writer of URDF.

``registry`` lists the formats; ``detect`` recognizes a file; ``reading`` has the steps of readers,
``common`` those of writers; ``export`` writes and proves a result.
"""
