"""MoveIt's files beside a description."""
