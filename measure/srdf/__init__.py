"""Measurements of ``urdftool srdf``: proofs against samples, searches and other libraries."""
