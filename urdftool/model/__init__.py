"""Robot model in the terms of the URDF specification."""
