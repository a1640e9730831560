"""SDF, the language of Gazebo.

In the order of the work: ``defects`` (what forbids an export), ``plan`` (which links stay bodies
and which become frames), ``names``, then ``model`` with one module for each element of the output.
``keywords``, ``sensor_types`` and ``colors`` are tables, which the page of the mapping comes from,
too. ``verify`` reads the result back without any of these.
"""
