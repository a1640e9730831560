"""Formatting of XML files: indentation, spaces in tags and ends of lines, on their bytes.

Modules are imported separately (this package imports nothing):

- ``tokens``: tags, comments and texts of a file;
- ``layout``: where lines begin, and how far they are indented;
- ``equality``: whether two texts are the same XML;
- ``run``: formatting of one file, with that check;
- ``discover``: the files below folders.
"""
