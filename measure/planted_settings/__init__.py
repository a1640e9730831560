"""Changes of an SDF and an MJCF, which ``verify`` of their URDF and the file must name."""
