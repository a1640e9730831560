"""The commands, one module each: parse arguments, call a feature, print, return the exit code."""
