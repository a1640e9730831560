"""The robot as a graph: what is drawn, and the languages it is drawn in.

One module an idea, each imported on its own (this package loads nothing by itself):

- ``figure``: ``Node``, ``Edge`` and ``Figure``, what is drawn;
- ``walk``: links and joints in the order they are drawn, also where they are no tree;
- ``faults``: what keeps a robot from being a tree;
- ``ros``, ``detailed``: a robot to a figure, in the two styles;
- ``marks``: the findings of lint, on the nodes they concern;
- ``fold``: rigid bodies as one node;
- ``dot``, ``mermaid``: a figure to text;
- ``draw``: DOT text to PDF, SVG and PNG.
"""
