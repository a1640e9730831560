"""SRDF for MoveIt and other planners: pairs of links that never touch, with proof, and groups."""
