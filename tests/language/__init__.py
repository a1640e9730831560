"""What keeps everything that a person reads in plain technical English."""
