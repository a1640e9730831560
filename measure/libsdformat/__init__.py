"""SDF files as libsdformat and as urdftool read them."""
