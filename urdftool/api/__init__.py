"""Public functions that combine several packages: the commands without a command line."""
