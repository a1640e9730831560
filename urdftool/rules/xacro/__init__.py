"""The source of xacro files, and their expansion."""
