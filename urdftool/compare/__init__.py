"""Comparison of robots that were read from files of any format.

Modules are imported separately (this package imports nothing). As mechanisms, for ``verify`` and
for the proof of an export:

- ``compare``: ``compare_robots``, the comparison of two robots; ``several``: all pairs of several;
- ``proof``: ``prove``, the comparison of an export with its source, with its declared losses;
- ``rows``, ``difference``: compared properties, and the differences that were found;
- ``check``: one row of the table of an export;
- ``bodies``: rigid bodies that links connected by fixed joints form;
- ``names``: names of joints in one robot for those in the other;
- ``correspondence``: files that declare how one robot was made of the other; ``conventions``: the
  first in those of the second; ``declared``: their comparison, in which nothing is a convention;
- ``matching``: joints without a common name, matched by the structure of the tree;
- ``frames``, ``origins``: frames and origins of joints of one robot in the other;
- ``pair``: both robots, with the names of the parts of one in the other;
- ``joints``, ``inertia``, ``shapes``, ``dynamics``: comparison of each property; ``worlds``: that
  of worlds, and of which rows they decide; ``unread``: which rows concern what was not read.

As descriptions, part by part, for ``diff``, whose differences are rows of the same table:

- ``differences``: ``compare``, which takes links and joints by their names, in their own frames;
- ``links``: what is written of a link;
- ``revision``: descriptions at a git revision.

Shared by both: ``settings``, ``mechanisms``, ``extensions`` and ``native``, which compare what
plain URDF lacks, and ``tolerance``, the equality of numbers, poses and tensors.
"""
