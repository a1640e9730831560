"""One door per command: read the line, call the room, print, return the exit code."""
