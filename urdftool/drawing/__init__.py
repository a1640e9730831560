"""Pictures of robots, drawn on the processor alone, the same bytes each time.

One module an idea, each imported on its own (this package loads nothing by itself):

- ``shapes``: ``robot_shapes``, the triangles of a robot with their colours, link by link;
- ``camera``: ``Camera``, where a picture is taken from;
- ``picture``: ``draw``, shapes at poses to pixels; ``png_file``: ``png``, pixels to a file;
- ``contact_sheet``: every joint at both its limits;
- ``gif_file``: pictures one after the other; ``chart``: curves over time;
- ``gather``, ``normals``, ``materials``, ``texture``: how a surface looks;
- ``raster``, ``clip``, ``scene``, ``light``, ``ground``: how it is drawn.
"""
