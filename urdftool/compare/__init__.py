"""What changed between two robots, as a reviewer means it.

One module an idea, each imported on its own (this package loads nothing by itself):

- ``differences``: ``compare``, the way in;
- ``change``: ``Change``, what it yields;
- ``links``, ``joints``, ``extensions``: the changes of one part;
- ``renames``: which link or joint is another under a new name;
- ``closeness``: when two numbers, poses or tensors are equal;
- ``revision``: a description as it was in git.
"""
