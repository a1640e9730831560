"""Export to SDF, the model format of Gazebo.

Modules in processing order: ``write`` (with the defects that prevent an export), ``plan`` (which
links stay bodies and which become frames), ``names``, then ``model`` with one module for each
element of the output. ``keywords``, ``sensor_types`` and ``colors`` are tables, also used for the
page of the mapping. ``verify`` reads the result back without using any of these.
"""
