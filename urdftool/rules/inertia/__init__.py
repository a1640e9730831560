"""Mass and inertia."""
