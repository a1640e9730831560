"""What touches."""
