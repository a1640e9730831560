"""Comparison of robots that were read from files of any format.

- ``compare``: ``compare_robots``, the comparison of two robots;
- ``several``: comparison of all pairs of several robots;
- ``rows``, ``difference``: compared properties, and the differences that were found;
- ``bodies``: rigid bodies that links connected by fixed joints form;
- ``names``: names of joints in one robot for those in the other;
- ``matching``: joints without a common name, matched by the structure of the tree;
- ``frames``, ``origins``: frames and origins of joints of one robot in the other;
- ``pair``: both robots, with the names of the parts of one in the other;
- ``joints``, ``inertia``, ``shapes``, ``dynamics``: comparison of each property.
"""
