"""A page in the browser that shows a robot and moves its joints.

One module an idea, each imported on its own (this package loads nothing by itself):

- ``page``: what is on the page and what happens there; ``panels``: its texts, tables and choices;
- ``sliders``: which joint goes from where to where, and in which unit;
- ``body``: the robot in the scene; ``looks``: its surfaces as the page wants them, ``glb`` for
  those with an image;
- ``numbers``: links and joints in words; ``marks``: which link a finding is about;
- ``watch``: whether a file has changed;
- ``server``: one address, one port, and nothing of the network.
"""
