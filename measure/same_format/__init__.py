"""Elements and attributes of a format, added one at a time: does an export to it keep them?"""
