"""OpenUSD, for Isaac Sim, Isaac Lab and Newton.

``write.py`` converts a robot to a stage with the schemas UsdPhysics, Newton and PhysX; ``read.py``
reads a stage; ``verify*.py`` compare the two. Only these modules import ``pxr``.
"""
