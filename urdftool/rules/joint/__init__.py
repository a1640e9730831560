"""What a joint can do."""
