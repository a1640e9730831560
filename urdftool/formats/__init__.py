"""Writers for the target formats (SDF, MJCF) and the steps that they share."""
