"""Good robots, damaged in one way at a time: lint has to name what was damaged."""
