"""The languages a robot can leave in: one small function a concept, in the order of the output."""
