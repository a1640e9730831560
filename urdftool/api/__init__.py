"""The public functions that are no room's own: what the commands do, without a command line."""
