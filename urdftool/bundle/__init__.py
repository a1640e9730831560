"""Bundles: a robot with all its meshes, textures and licenses in one folder or zip file.

``collect`` finds the files of a robot, ``references`` what a mesh file refers to, ``layout``
assigns portable names, ``description`` rewrites the URDF, ``origin`` finds licenses and commits,
``ros_package`` adds the files of a ROS package, ``manifest`` describes the bundle, ``make``
combines these, ``output`` writes, and ``check`` verifies a bundle.
"""
