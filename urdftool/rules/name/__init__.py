"""Names and conventions."""
