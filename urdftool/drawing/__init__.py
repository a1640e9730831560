"""Pictures of robots, rendered on the CPU alone and reproducible byte for byte.

This package imports nothing by itself; its modules are:

- ``shapes``: ``read_robot_shapes``, the colored triangles of a robot, by link;
- ``camera``: ``Camera``, the viewpoint of a picture;
- ``picture``: ``draw``, from shapes at poses to pixels;
- ``png_file``: ``encode_png``, from pixels to a file;
- ``contact_sheet``: every joint at both limits;
- ``gif_file``: animations; ``text``: text on pictures;
- ``load_geometry``, ``detail``, ``normals``, ``materials``, ``texture``: appearance of surfaces;
- ``raster``, ``clip``, ``scene``, ``shading``, ``visibility``: rendering.
"""
