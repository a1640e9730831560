"""The package around a description."""
