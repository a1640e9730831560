"""The robot as a graph, and its output formats.

Modules, each imported on its own (the package itself imports nothing):

- ``figure``: ``Node``, ``Edge`` and ``Figure``, the drawn graph;
- ``walk``: links and joints in drawing order, also if they are not a tree;
- ``faults``: defects that keep a robot from being a tree;
- ``ros``, ``detailed``: conversion of a robot to a figure, in two styles;
- ``marks``: lint findings at the nodes they concern;
- ``fold``: rigid bodies as one node;
- ``dot``, ``mermaid``: conversion of a figure to text;
- ``draw``: rendering of DOT text as PDF, SVG and PNG.
"""
