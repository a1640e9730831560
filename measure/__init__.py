"""Programs that measure urdftool; the pages of the documentation show what they print.

- ``benchmarks``: time, sizes and results of urdftool and of other tools on the same files;
- ``record``: what command lines print and write, before and after a change;
- ``verification``, ``planted``: differences in robots, which ``verify`` and exports must find;
- ``damage``: defects put into robots, which ``lint`` must find; ``precision``: findings, judged;
- ``fuzz``: damaged robots through every command.

``tests/measure/`` runs a short form of some.
"""
