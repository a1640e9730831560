"""What somebody might do to urdftool, or let it do to somebody else."""
