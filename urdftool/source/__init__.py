"""Reading of descriptions: XML, xacro expansion, packages and locations in the source."""
