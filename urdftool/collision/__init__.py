"""Simpler shapes for contact: made from meshes, measured against them, written into robots.

One module an idea, each imported on its own (this package loads nothing by itself):

- ``settings``, ``piece``: what is wanted, and what comes of it;
- ``surface``, ``convex``, ``primitives``, ``decimate``, ``decompose``: a mesh made ready, and the
  ways to simplify it;
- ``distance``, ``touchable``, ``measure``: how far two surfaces are apart;
- ``choose``, ``compute``: the cheapest that is good enough, for one mesh;
- ``cache``, ``pool``, ``parallel``, ``cluster``: many meshes, several at a time, each once;
- ``links``, ``rewrite``, ``mesh_files``: a robot's links, its source, and the files beside it;
- ``check``, ``picture``: collisions that are there already, and what all of it looks like.
"""
