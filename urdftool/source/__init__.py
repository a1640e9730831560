"""Text, and where each piece of it came from."""
