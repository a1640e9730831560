"""Formatting of findings and results as text, JSON and other formats."""
