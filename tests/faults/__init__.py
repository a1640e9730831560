"""Kill, Ctrl-C and a full disk at each event of the file system."""
