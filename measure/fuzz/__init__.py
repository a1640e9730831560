"""Every command on thousands of damaged and hostile robots: ``python -m measure.fuzz``."""
