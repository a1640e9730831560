"""Links and joints as one tree."""
