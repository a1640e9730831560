"""Changes planted in an export, and whether ``--verify`` finds each in the row where it belongs."""
