"""Which links may meet is found by a sweep: the same pairs as by looking at all of them."""

import random
from itertools import combinations

import pytest

import urdftool
from urdftool.rules.collision.convex_bodies import ConvexBodies

LINK = (
    '<link name="l{0}"><collision><origin xyz="{1} {2} {3}"/><geometry><sphere radius="{4}"/>'
    "</geometry></collision></link>\n"
)
JOINT = (
    '<joint name="j{0}" type="continuous"><parent link="l{1}"/><child link="l{0}"/>'
    '<axis xyz="0 0 1"/></joint>\n'
)


@pytest.mark.parametrize("spread", [(9, 1, 1), (1, 9, 1), (1, 1, 9), (3, 3, 3)])
def test_the_sweep_finds_the_pairs_that_are_near(write, spread):
    numbers = random.Random(7)
    links = [
        LINK.format(n, *(numbers.uniform(0, s) for s in spread), numbers.uniform(0.1, 0.5))
        for n in range(40)
    ]
    joints = [JOINT.format(n, numbers.randrange(n)) for n in range(1, 40)]
    path = write("r.urdf", f"<robot name='r'>{''.join(links + joints)}</robot>")
    known = ConvexBodies(urdftool.load(path))
    found, all_of_them = known.find_candidate_pairs(1000)
    assert all_of_them
    all_pairs = {
        frozenset(pair)
        for pair in combinations(known.bodies, 2)
        if frozenset(pair) not in known.neighbors and known.is_near(*pair)
    }
    assert len(found) > 10
    assert {frozenset(pair) for pair in found} == all_pairs
    assert len(found) == len(all_pairs)
