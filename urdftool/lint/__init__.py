"""The machinery of the linter, not its opinions."""
