"""Operations that make a robot of a robot, each with a proof.

Modules are imported separately (this package imports nothing):

- ``draft``: a plain URDF with changes that are not made yet; ``numbers``: the shortest texts;
- ``attach``, ``prefix``, ``merge_fixed``, ``reroot``, ``mirror``, ``positions`` (zero and sign),
  ``cut``, ``rounding``: an operation each, a function that changes a draft;
- ``references``: names in the description and in the files around it; ``around``: these files;
- ``finish``: the texts of an edited robot, and the comparison with the robot before.
"""
