"""Every command on thousands of damaged and hostile robots: ``python -m tests.fuzz``."""
