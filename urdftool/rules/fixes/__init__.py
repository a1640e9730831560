"""What mends a finding: a function a rule, beside the rules so that looking stays fast.

Each is called as its rule is, takes the problem and what there is to know of the robot, and gives a
:class:`~.proposal.Proposal`, or None where this case of it is not mended.
"""
