"""Findings and numbers, said aloud."""
