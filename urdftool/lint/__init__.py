"""Execution of lint rules: settings, reports, suppression, baselines, cache and fixes."""
