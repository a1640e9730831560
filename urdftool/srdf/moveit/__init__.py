"""MoveIt configuration package of a robot, as MoveIt's Setup Assistant makes it."""
